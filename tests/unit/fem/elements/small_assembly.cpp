#include "tests/unit/fem/elements/small_assembly.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace tenon::fem::testing {

void SmallAssembly::add(std::span<const int> element_nodes, const ElementMatrices& e) {
  for (Eigen::Index i = 0; i < e.K.rows(); ++i)
    for (Eigen::Index j = 0; j < e.K.cols(); ++j) {
      const int row = 6 * element_nodes[static_cast<std::size_t>(i / 6)] + static_cast<int>(i % 6);
      const int column = 6 * element_nodes[static_cast<std::size_t>(j / 6)] + static_cast<int>(j % 6);
      K.emplace_back(row, column, e.K(i, j));
      M.emplace_back(row, column, e.M(i, j));
    }
}

System restrict_to(const SmallAssembly& a, const std::function<bool(const Vec3&, int)>& free) {
  System s;
  int n = 0;
  for (const Vec3& x : a.nodes)
    for (int d = 0; d < 6; ++d) s.index.push_back(free(x, d) ? n++ : -1);
  const auto reduce = [&s, n](const std::vector<Eigen::Triplet<double>>& full) {
    std::vector<Eigen::Triplet<double>> kept;
    for (const auto& t : full) {
      const int i = s.index[static_cast<std::size_t>(t.row())], j = s.index[static_cast<std::size_t>(t.col())];
      if (i >= 0 && j >= 0) kept.emplace_back(i, j, t.value());
    }
    Sparse A(n, n);
    A.setFromTriplets(kept.begin(), kept.end());
    return A;
  };
  s.K = reduce(a.K);
  s.M = reduce(a.M);
  return s;
}

Eigen::VectorXd lowest(const System& s, int count, double shift) {
  Eigen::SimplicialLDLT<Sparse> factor(s.K - shift * s.M);
  const Eigen::Index width = std::min<Eigen::Index>(count + 8, s.K.rows());
  std::srand(1);
  Eigen::MatrixXd X = Eigen::MatrixXd::Random(s.K.rows(), width);
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(width);
  for (int it = 0; it < 200; ++it) {
    X = factor.solve(s.M * X).eval();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small(X.transpose() * (s.K * X),
                                                                          X.transpose() * (s.M * X));
    X = (X * small.eigenvectors()).eval();
    const double change = (small.eigenvalues() - lambda).head(count).cwiseAbs().maxCoeff();
    lambda = small.eigenvalues();
    if (it > 4 && change < 1e-12 * std::abs(lambda[count - 1])) break;
  }
  return lambda.head(count);
}

Eigen::MatrixXd rigid_motions(std::span<const Vec3> nodes) {
  Eigen::MatrixXd R(6 * static_cast<Eigen::Index>(nodes.size()), 6);
  for (std::size_t i = 0; i < nodes.size(); ++i) R.middleRows<6>(6 * static_cast<Eigen::Index>(i)) = tau(nodes[i]);
  return R;
}

int zero_modes(const Eigen::MatrixXd& K, double h, double tolerance) {
  Eigen::VectorXd scale(K.rows());
  for (Eigen::Index i = 0; i < K.rows(); ++i) scale[i] = i % 6 < 3 ? 1.0 : 1.0 / h;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * K * scale.asDiagonal();
  const Eigen::VectorXd lambda =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  return static_cast<int>((lambda.array().abs() < tolerance * lambda.maxCoeff()).count());
}

}  // namespace tenon::fem::testing
