#include "titop/equilibrate.hpp"

#include <cmath>

namespace tenon::titop {

namespace {

// 1/√(largest entry); one for a zero vector
template <typename Vector>
double scale_of(const Vector& v) {
  const double largest = v.size() ? v.cwiseAbs().maxCoeff() : 0.0;
  return largest > 0.0 && std::isfinite(largest) ? 1.0 / std::sqrt(largest) : 1.0;
}

}  // namespace

Equilibrated equilibrate(const Eigen::MatrixXd& A) {
  Equilibrated e{A, Eigen::VectorXd::Ones(A.rows()), Eigen::VectorXd::Ones(A.cols())};
  constexpr int sweeps = 20;  // the maxima approach one as 2^-sweeps in their exponents
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    Eigen::VectorXd r(A.rows()), c(A.cols());
    for (Eigen::Index i = 0; i < A.rows(); ++i) r[i] = scale_of(e.A.row(i));
    for (Eigen::Index j = 0; j < A.cols(); ++j) c[j] = scale_of(e.A.col(j));
    e.A = r.asDiagonal() * e.A * c.asDiagonal();
    e.rows.array() *= r.array();
    e.cols.array() *= c.array();
  }
  return e;
}

}  // namespace tenon::titop
