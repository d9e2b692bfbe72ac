#include "fem/formats/matrices/make_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "fem/error.hpp"
#include "fem/formats/matrices/digits.hpp"
#include "fem/matrix_part.hpp"

namespace tenon::fem {
namespace {

/// K and M of a body are positive semi-definite, so no diagonal is negative, nor anything beside a zero one.
void require_sound(const Model& model, const MatrixPart& part, const SparseMatrix& A, const char* symbol) {
  const auto label = [&](Eigen::Index i) { return name(model, part.dofs[static_cast<std::size_t>(i)]); };
  const Eigen::VectorXd diagonal = A.diagonal();
  for (int j = 0; j < A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(A, j); it; ++it) {
      if (!std::isfinite(it.value()))
        throw ModelError(
            fmt::format("{}: {} holds {} at {}, {}", model.source, symbol, it.value(), label(it.row()), label(j)),
            "Every entry must be a finite number");
      if (it.row() != j && it.value() != 0.0 && (diagonal(it.row()) == 0.0 || diagonal(j) == 0.0))
        throw ModelError(fmt::format("{}: {} couples {} and {}, one of which has nothing on the diagonal", model.source,
                                     symbol, label(it.row()), label(j)),
                         "A stiffness or mass matrix is positive semi-definite: check which matrix this is");
    }
  for (Eigen::Index i = 0; i < diagonal.size(); ++i)
    if (diagonal(i) < 0.0)
      throw ModelError(fmt::format("{}: {} has {} on the diagonal at {}", model.source, symbol, diagonal(i), label(i)),
                       "A stiffness or mass matrix has no negative diagonal: check which matrix this is");
}

}  // namespace

MatrixModel make_model(MatrixData data) {
  MatrixModel result;
  Model& model = result.model;
  model.source = data.source;
  model.losses = std::move(data.losses);
  auto part = std::make_shared<MatrixPart>();
  std::unordered_map<long, int> node_of;
  std::vector<char> scalar;
  for (const MatrixRow& row : data.rows) {
    const auto [at, made] = node_of.try_emplace(row.node, static_cast<int>(model.nodes.size()));
    if (made) {
      const auto place = data.positions.find(row.node);
      model.node_ids.push_back(row.node);
      scalar.push_back(row.scalar ? 1 : 0);
      if (row.scalar) {
        model.scalar_points.push_back(at->second);
        model.nodes.push_back(Vec3::Zero());
      } else {
        model.nodes.push_back(place != data.positions.end() ? place->second
                                                            : Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
      }
    } else if (row.scalar || scalar[static_cast<std::size_t>(at->second)] != 0) {
      throw ModelError(fmt::format("{}: two rows of the matrices belong to {} {}", data.source,
                                   row.scalar ? "the scalar dof" : "what is also a scalar dof,", row.node),
                       "Number scalar dofs apart from each other and from the nodes");
    }
    part->dofs.push_back({at->second, row.scalar ? 0 : row.direction});
  }
  part->K = std::move(data.K);
  part->M = std::move(data.M);
  model.matrix_parts.push_back(part);
  require_consistent_parts(model);
  require_sound(model, *part, part->K, "K");
  require_sound(model, *part, part->M, "M");
  part->rounding = rounding_of(model, *part);

  result.mesh.source = data.source;
  result.mesh.format = "matrices";
  result.mesh.points = model.nodes;
  result.mesh.point_ids = model.node_ids;
  for (const auto& [set, nodes] : data.sets) {
    std::vector<int>& points = result.mesh.point_sets[set];
    for (const long node : nodes)
      if (const auto found = node_of.find(node); found != node_of.end()) points.push_back(found->second);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
  return result;
}

}  // namespace tenon::fem
