#include "fem/singular_directions.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

namespace tenon::fem {
namespace {

using Rows = std::array<int, 3>;  ///< of a node's translations or rotations; −1: none

/// Directions that are no rows are as stiff as the others together.
Mat3 block_of(const SparseMatrix& K, const Rows& rows) {
  Mat3 block = Mat3::Zero();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b <= a; ++b)
      if (const int i = rows[static_cast<std::size_t>(a)], j = rows[static_cast<std::size_t>(b)]; i >= 0 && j >= 0)
        block(a, b) = block(b, a) = K.coeff(std::max(i, j), std::min(i, j));
  const double trace = block.trace();
  for (int a = 0; a < 3; ++a)
    if (rows[static_cast<std::size_t>(a)] < 0) block(a, a) = trace > 0.0 ? trace : 1.0;
  return block;
}

/// The axis that a direction is, −1 for none.
int axis_of(const Vec3& v) {
  Eigen::Index axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return std::abs(v(axis)) > 1.0 - 1e-6 ? static_cast<int>(axis) : -1;
}

}  // namespace

std::vector<SingularDirection> singular_directions(const Structure& s, double limit) {
  std::vector<SingularDirection> found;
  for (int i = 0; i < s.n();) {
    const int node = s.dofs.free[static_cast<std::size_t>(i)].node;
    std::array<Rows, 2> halves{Rows{-1, -1, -1}, Rows{-1, -1, -1}};
    for (; i < s.n() && s.dofs.free[static_cast<std::size_t>(i)].node == node; ++i) {
      const int d = s.dofs.free[static_cast<std::size_t>(i)].direction;
      halves[static_cast<std::size_t>(d / 3)][static_cast<std::size_t>(d % 3)] = i;
    }
    for (const bool rotation : {false, true}) {
      const Rows& rows = halves[rotation ? 1 : 0];
      if (std::ranges::max(rows) < 0) continue;
      const Mat3 block = block_of(s.K, rows);
      double trace = 0.0;
      for (int a = 0; a < 3; ++a)
        if (rows[static_cast<std::size_t>(a)] >= 0) trace += block(a, a);
      const Eigen::SelfAdjointEigenSolver<Mat3> eigen(block);
      for (int k = 0; k < 3; ++k)
        if (const double ratio = eigen.eigenvalues()(k) / (trace > 0.0 ? trace : 1.0); ratio < limit)
          found.push_back({node, rotation, eigen.eigenvectors().col(k), ratio});
    }
  }
  return found;
}

std::string name(const Structure& s, const SingularDirection& d) {
  const long id = s.node_ids[static_cast<std::size_t>(d.node)];
  const auto port = std::ranges::find(s.ports, d.node, &Port::node);
  const std::string where =
      id < 0 && port != s.ports.end() ? fmt::format("port {}", port->name) : fmt::format("node {}", id);
  if (const int axis = axis_of(d.direction); axis >= 0)
    return fmt::format("{} {}{}", where, d.rotation ? 'r' : 'u', "xyz"[axis]);
  const Vec3& v = d.direction;
  return fmt::format("{} {} along ({:.3g}, {:.3g}, {:.3g})", where, d.rotation ? "rotation" : "translation", v(0), v(1),
                     v(2));
}

std::vector<std::string> hold_singular_directions(Model& model, const Structure& s, double limit) {
  std::vector<std::string> held;
  for (const SingularDirection& d : singular_directions(s, limit)) {
    if (std::ranges::find(model.ports, d.node, &Port::node) != model.ports.end()) continue;
    const int first = d.rotation ? 3 : 0;
    if (const int axis = axis_of(d.direction); axis >= 0) {
      model.supports.push_back({{d.node, first + axis}});
    } else {
      LinearConstraint row{{}, model.node_ids[static_cast<std::size_t>(d.node)]};
      for (int k = 0; k < 3; ++k)
        if (std::abs(d.direction[k]) > 1e-12) row.terms.push_back({{d.node, first + k}, d.direction[k]});
      model.constraints.push_back(std::move(row));
    }
    held.push_back(name(s, d));
  }
  return held;
}

}  // namespace tenon::fem
