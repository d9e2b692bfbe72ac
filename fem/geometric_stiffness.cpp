#include <fmt/format.h>

#include "fem/elements/beam.hpp"
#include "fem/elements/general_beam.hpp"
#include "fem/elements/rod.hpp"
#include "fem/elements/shell.hpp"
#include "fem/error.hpp"
#include "fem/shell_directors.hpp"
#include "fem/structure.hpp"

namespace tenon::fem {

namespace {

struct GeometricStiffnessOf {
  const Model& model;
  const Eigen::VectorXd& u;  // of the element's nodes
  std::span<const Vec3> directors;
  ElementMatrices::Matrix& out;

  const Material& material(int i) const { return model.materials[static_cast<std::size_t>(i)]; }
  const ShellSection& shell(int i) const { return model.shell_sections[static_cast<std::size_t>(i)]; }

  void operator()(const Beam& e) const {
    const SectionLine line(model, e);
    line.plain() ? beam_geometric_stiffness(e, line.section(0), material(e.material), model.nodes, u, out)
                 : general_beam_geometric_stiffness(e, line, material(e.material), model.nodes, u, out);
  }
  void operator()(const Quad4& e) const {
    quad4_geometric_stiffness(e, shell(e.section), material(e.material), model.nodes, u, out, directors);
  }
  void operator()(const Tria3& e) const {
    tria3_geometric_stiffness(e, shell(e.section), material(e.material), model.nodes, u, out, directors);
  }
  void operator()(const PointMass&) const {}  // bear no stress; have no nodes here
  void operator()(const Spring&) const {}
  void operator()(const Bush&) const {}
  void operator()(const Rod& e) const {
    rod_geometric_stiffness(e, model.beam_sections[static_cast<std::size_t>(e.section)], material(e.material),
                            model.nodes, u, out);
  }
};

struct NodesOf {
  std::span<const int> operator()(const PointMass&) const { return {}; }
  std::span<const int> operator()(const Spring&) const { return {}; }
  std::span<const int> operator()(const Bush&) const { return {}; }
  template <typename Element>
  std::span<const int> operator()(const Element& e) const {
    return e.nodes;
  }
};

}  // namespace

SparseMatrix geometric_stiffness(const Model& model, const Structure& structure,
                                 const Eigen::Ref<const Eigen::VectorXd>& u) {
  const DofMap& map = structure.dofs;
  if (u.size() != structure.n() || map.n_nodes() != static_cast<int>(model.nodes.size()))
    throw ModelError(fmt::format("{} displacements of {} nodes for a structure of {} dofs and {} nodes", u.size(),
                                 model.nodes.size(), structure.n(), map.n_nodes()),
                     "Give the model that the structure was assembled from");
  if (!model.matrix_parts.empty())
    throw ModelError(fmt::format("{}: matrices alone do not tell the stress in the body", model.source),
                     "Geometric stiffness needs the mesh; leave out what large motion needs (--linear)");
  const Eigen::VectorXd full = map.expand(u);
  const std::vector<Vec3> directors = shell_directors(model);
  std::vector<Eigen::Triplet<double>> entries;
  ElementMatrices::Matrix K;
  Eigen::VectorXd u_e;
  for (const Element& element : model.elements) {
    const std::span<const int> nodes = std::visit(NodesOf{}, element);
    if (nodes.empty()) continue;
    u_e.resize(6 * static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      u_e.segment<6>(6 * static_cast<Eigen::Index>(k)) = full.segment<6>(6 * nodes[k]);
    std::visit(GeometricStiffnessOf{model, u_e, directors, K}, element);
    // T_eᵀ K_e T_e, term by term
    const auto terms = [&](Eigen::Index i) {
      const auto dof = static_cast<std::size_t>(6 * nodes[static_cast<std::size_t>(i / 6)] + static_cast<int>(i % 6));
      return std::span(map.terms).subspan(static_cast<std::size_t>(map.start[dof]),
                                          static_cast<std::size_t>(map.start[dof + 1] - map.start[dof]));
    };
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      for (Eigen::Index i = 0; i < K.rows(); ++i) {
        if (K(i, j) == 0.0) continue;
        for (const DofMap::Term& a : terms(i))
          for (const DofMap::Term& b : terms(j))
            if (a.free >= b.free) entries.emplace_back(a.free, b.free, a.coefficient * b.coefficient * K(i, j));
      }
  }
  SparseMatrix K_sigma(structure.n(), structure.n());
  K_sigma.setFromTriplets(entries.begin(), entries.end());
  return K_sigma;
}

}  // namespace tenon::fem
