#pragma once

#include <cctype>
#include <cmath>

#include "reduction/reduce.hpp"
#include "tests/reference/values.hpp"
#include "tests/unit/reduction/beams.hpp"

/// A beam that bends in one plane only, and Rayleigh-Ritz on its reduced body in coordinates (uy_P, rz_P, η).
namespace tenon::tests {

inline constexpr int uy = 1, rz = 5;

/// Every dof but uy and rz is held, so that shapes and modes count as in the plane.
inline void bend_in_one_plane(fem::Model& model) {
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node)
    for (const int d : {0, 2, 3, 4}) model.supports.push_back({{node, d}});
}

inline Eigen::MatrixXd plane(const Eigen::MatrixXd& A, bool rows_too) {
  std::vector<int> keep{uy, rz};
  for (int k = 6; k < A.cols(); ++k) keep.push_back(k);
  return rows_too ? Eigen::MatrixXd(A(keep, keep)) : Eigen::MatrixXd(A(Eigen::all, keep));
}

/// Frequencies of K x = ω² M x, M > 0 and small, ascending; those of rigid motions come out about 0.
inline Eigen::VectorXd frequencies_of(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  const double s = K.diagonal().cwiseQuotient(M.diagonal()).maxCoeff() * 1e-8;
  const Eigen::VectorXd lambda =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K + s * M, M, Eigen::EigenvaluesOnly).eigenvalues();
  return (lambda.array() - s).cwiseMax(0.0).sqrt();
}

/// Columns of `space` (all of the body's when it has none) that leave the ends as `ends` says, "CF": P clamped, C free.
inline Eigen::VectorXd with_ends(const reduction::ReducedBody& body, const std::string& ends,
                                 const Eigen::MatrixXd& space = {}) {
  const FreeBody f = free_body(body);
  Eigen::MatrixXd M = plane(f.M, true), K = plane(f.K, true), G(0, M.cols());
  for (std::size_t end = 0; end < 2; ++end)
    for (const int d : {uy, rz})
      if (ends[end] == 'C' || ends[end] == (d == uy ? 'P' : 'S')) {
        G.conservativeResize(G.rows() + 1, Eigen::NoChange);
        G.bottomRows(1) = plane(port_rows(body, static_cast<int>(end)), false).row(d);
      }
  if (space.size() > 0) {
    M = space.transpose() * M * space;
    K = space.transpose() * K * space;
    G = G * space;
  }
  const Eigen::VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();  // columns of unit mass
  M = (scale.asDiagonal() * M * scale.asDiagonal()).eval();
  K = (scale.asDiagonal() * K * scale.asDiagonal()).eval();
  G *= scale.asDiagonal();
  if (G.rows() == 0) return frequencies_of(K, M);
  G.rowwise().normalize();
  const Eigen::MatrixXd Q = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(G.transpose()).householderQ();
  const Eigen::MatrixXd N = Q.rightCols(G.cols() - G.rows());
  return frequencies_of(N.transpose() * K * N, N.transpose() * M * N);
}

/// Rigid motions, static responses of C and the lowest `modes` free-free modes, as columns over (uy_P, rz_P, η): exact
/// when the body's basis holds them.
inline Eigen::MatrixXd free_free_static(const reduction::ReducedBody& body, int modes) {
  const FreeBody f = free_body(body);
  const Eigen::MatrixXd M = plane(f.M, true), K = plane(f.K, true);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> free(K, M);
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(M.rows(), 4 + modes);
  T.topLeftCorner(2, 2).setIdentity();
  const Eigen::VectorXd flexibility = body.omega.cwiseAbs2().cwiseInverse();
  T.block(2, 2, body.n(), 1) = flexibility.asDiagonal() * body.ports[1].Phi.row(uy).transpose();
  T.block(2, 3, body.n(), 1) = flexibility.asDiagonal() * body.ports[1].Phi.row(rz).transpose();
  T.rightCols(modes) = free.eigenvectors().middleCols(2, modes);
  return T;
}

/// The closed form's entry for two ends, in either order.
inline reference::EndConditions end_conditions(const std::string& ends) {
  const char a = static_cast<char>(std::tolower(ends[0])), b = static_cast<char>(std::tolower(ends[1]));
  for (const auto& e : reference::euler_bernoulli_roots)
    if ((e.left == a && e.right == b) || (e.left == b && e.right == a)) return e;
  throw std::runtime_error("no such ends");
}

inline std::vector<std::string> all_ends() {
  std::vector<std::string> all;
  for (const char a : {'C', 'F', 'P', 'S'})
    for (const char b : {'C', 'F', 'P', 'S'}) all.push_back({a, b});
  return all;
}

}  // namespace tenon::tests
