#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::shift_inertia;
using fem::shift_wrench;

namespace {

// R(p) += 𝓐 φ R^rr(k) φ* 𝓐*
void add_to_parent(const BodySweep& child, BodySweep& parent) {
  const Mat6 Gamma = child.X.inertia(child.P_rr);
  parent.P_rr += shift_inertia(Gamma, child.to_node);
  for (Index j = 0; j < child.Pi_t.cols(); ++j) {
    const Vec6 W = Gamma * child.Pi_t.col(j);
    for (Index i = 0; i < child.Pi_t.cols(); ++i) parent.L11(i, j) += child.Pi_t.col(i).dot(W);
    parent.L21.col(j).head<6>() += shift_wrench(W, child.to_node);
  }
}

// 𝓗(k) [x_f; x_r] into rows first... of a column of the mass matrix
template <class Column>
void project(const BodySweep& s, const BodySweep::Vector& x_f, const Vec6& x_r, Index first, Column&& column) {
  const Index n = s.L11.cols();
  for (Index i = 0; i < n; ++i) column[first + i] = x_f[i] - (s.Pi_F.cols() > 0 ? s.Pi_F.col(i).dot(x_r) : 0.0);
  for (Index j = 0; j < s.H_F.cols(); ++j) column[first + n + j] = s.H_F.col(j).dot(x_r);
}

}  // namespace

void composite_mass_matrix(const Multibody& system, Sweeps& sweeps, MatrixXd& mass) {
  mass.setZero(system.nv, system.nv);
  for (BodySweep& s : sweeps.bodies) {
    const Index n = s.L11.cols();
    s.L11.topRows(n) = s.M.topLeftCorner(n, n);
    s.L21.topRows<6>() = s.M.bottomLeftCorner(6, n);
    s.P_rr = s.M.bottomRightCorner<6, 6>();
  }
  for (int k = static_cast<int>(system.bodies.size()) - 1; k >= 0; --k) {  // tip to base
    const auto b = static_cast<std::size_t>(k);
    BodySweep& s = sweeps.bodies[b];
    const Index n = s.L11.cols(), first = system.v_offset[b], r = s.H_F.cols();
    for (Index c = 0; c < n + r; ++c) {  // X = R(k) 𝓗*(k), column by column
      Vec6 x_r = Vec6::Zero();
      if (c < n) {
        s.z_f.head(n) = s.L11.col(c).head(n);
        x_r = s.L21.col(c).head<6>();
        if (s.Pi_F.cols() > 0) {
          for (Index i = 0; i < n; ++i) s.z_f[i] -= s.L21.col(i).head<6>().dot(s.Pi_F.col(c));
          x_r.noalias() -= s.P_rr * s.Pi_F.col(c);
        }
      } else {
        for (Index i = 0; i < n; ++i) s.z_f[i] = s.L21.col(i).head<6>().dot(s.H_F.col(c - n));
        x_r.noalias() = s.P_rr * s.H_F.col(c - n);
      }
      auto column = mass.col(first + c);
      project(s, s.z_f, x_r, first, column);
      const BodySweep* child = &s;
      for (int j = system.bodies[b].parent; j >= 0; j = system.bodies[static_cast<std::size_t>(j)].parent) {
        BodySweep& ancestor = sweeps.bodies[static_cast<std::size_t>(j)];
        const Vec6 at_node = child->X.wrench(x_r);  // X(j) = 𝓐(j) φ(t_j, child) X^r(child)
        x_r = shift_wrench(at_node, child->to_node);
        if (child->Pi_t.cols() == 0) ancestor.z_f.setZero();
        for (Index i = 0; i < child->Pi_t.cols(); ++i) ancestor.z_f[i] = child->Pi_t.col(i).dot(at_node);
        project(ancestor, ancestor.z_f, x_r, system.v_offset[static_cast<std::size_t>(j)], column);
        child = &ancestor;
      }
    }
    for (Index j = 0; j < r; ++j) mass(first + n + j, first + n + j) += system.bodies[b].inertia[j];
    if (system.bodies[b].parent >= 0)
      add_to_parent(s, sweeps.bodies[static_cast<std::size_t>(system.bodies[b].parent)]);
  }
  mass.triangularView<Eigen::StrictlyLower>() = mass.transpose();
}

}  // namespace tenon::assembly
