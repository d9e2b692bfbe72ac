#include "interfaces/report/mode_pictures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <numbers>
#include <set>

#include "assembly/build.hpp"
#include "fem/matrix_part.hpp"

namespace tenon::report {
namespace {

using fem::CellType;

/// Cells of a model's elements, their nodes counted from `first`.
class Cells {
 public:
  explicit Cells(fem::Mesh& mesh) : mesh_(mesh) {}

  void add(CellType type, std::initializer_list<int> nodes, int first) {
    for (fem::CellBlock& block : mesh_.cells)
      if (block.type == type) return append(block, nodes, first);
    mesh_.cells.push_back({type, {}, {}});
    append(mesh_.cells.back(), nodes, first);
  }
  void add(const fem::Model& model, int first) {
    for (const fem::Element& element : model.elements) {
      if (const auto* beam = std::get_if<fem::Beam>(&element))
        add(CellType::line, {beam->nodes[0], beam->nodes[1]}, first);
      if (const auto* rod = std::get_if<fem::Rod>(&element)) add(CellType::line, {rod->nodes[0], rod->nodes[1]}, first);
      if (const auto* bush = std::get_if<fem::Bush>(&element); bush && bush->node_b >= 0)
        add(CellType::line, {bush->node_a, bush->node_b}, first);
      if (const auto* quad = std::get_if<fem::Quad4>(&element))
        add(CellType::quad, {quad->nodes[0], quad->nodes[1], quad->nodes[2], quad->nodes[3]}, first);
      if (const auto* tria = std::get_if<fem::Tria3>(&element))
        add(CellType::triangle, {tria->nodes[0], tria->nodes[1], tria->nodes[2]}, first);
    }
    std::set<int> points;  // matrices have no cells: their nodes are shown
    for (const auto& part : model.matrix_parts)
      for (const fem::Dof& dof : part->dofs)
        if (fem::position(model, dof.node); points.insert(dof.node).second) add(CellType::vertex, {dof.node}, first);
  }

 private:
  static void append(fem::CellBlock& block, std::initializer_list<int> nodes, int first) {
    for (const int node : nodes) block.nodes.push_back(first + node);
  }
  fem::Mesh& mesh_;
};

/// Adds one array a mode from translations of all points (3N×modes).
void add_modes(ModePictures& pictures, const Eigen::MatrixXd& translations, const Eigen::VectorXd& omega) {
  Eigen::AlignedBox3d box;
  for (const fem::Vec3& point : pictures.mesh.points) box.extend(point);
  const double size = box.isEmpty() ? 1.0 : box.diagonal().norm();
  for (Eigen::Index j = 0; j < translations.cols(); ++j) {
    const Eigen::MatrixXd u = translations.col(j).reshaped(3, translations.rows() / 3).transpose();
    const double largest = u.rowwise().norm().maxCoeff();
    pictures.modes.push_back({fmt::format("mode {:02}, {:.5g} Hz", j + 1, omega[j] / (2.0 * std::numbers::pi)),
                              largest > 0.0 ? Eigen::MatrixXd(u * (0.1 * size / largest)) : u});
  }
}

}  // namespace

ModePictures mode_pictures(const assembly::Scene& scene, const assembly::Network& network,
                           const assembly::SecondOrderSystem& system, const assembly::SystemModes& modes, int count) {
  const Eigen::Index shown = std::min<Eigen::Index>(count, modes.shapes.cols());
  const auto bodies = assembly::node_motions(network, system, modes.shapes.leftCols(shown));
  ModePictures pictures;
  Cells cells(pictures.mesh);
  Eigen::Index rows = 0;
  for (const assembly::BodyShapes& body : bodies) rows += body.translations.rows();
  Eigen::MatrixXd translations(rows, shown);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const int first = static_cast<int>(pictures.mesh.points.size());
    translations.middleRows(3 * first, bodies[b].translations.rows()) = bodies[b].translations;
    pictures.mesh.points.insert(pictures.mesh.points.end(), bodies[b].nodes.begin(), bodies[b].nodes.end());
    if (bodies[b].skeleton) {
      for (int k = 1; k < static_cast<int>(bodies[b].nodes.size()); ++k) cells.add(CellType::line, {0, k}, first);
    } else if (scene.bodies[b].has_model()) {
      cells.add(assembly::build_model(scene.bodies[b]), first);
    } else {
      for (int k = 0; k < static_cast<int>(bodies[b].nodes.size()); ++k) cells.add(CellType::vertex, {k}, first);
    }
  }
  add_modes(pictures, translations, modes.omega.head(shown));
  return pictures;
}

ModePictures mode_pictures(const fem::Model& model, const Eigen::MatrixXd& shapes, const Eigen::VectorXd& omega) {
  ModePictures pictures;
  pictures.mesh.points = model.nodes;
  Cells(pictures.mesh).add(model, 0);
  const auto nodes = static_cast<Eigen::Index>(model.nodes.size());
  Eigen::MatrixXd translations(3 * nodes, shapes.cols());
  for (Eigen::Index k = 0; k < nodes; ++k) translations.middleRows<3>(3 * k) = shapes.middleRows<3>(6 * k);
  add_modes(pictures, translations, omega);
  return pictures;
}

}  // namespace tenon::report
