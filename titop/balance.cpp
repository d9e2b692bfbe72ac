#include "titop/balance.hpp"

#include <cmath>

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// one sweep over all states; false when none was scaled
bool sweep(MatrixXd& A, MatrixXd& B, MatrixXd& C, VectorXd& scale) {
  bool moved = false;
  for (Index i = 0; i < A.rows(); ++i) {
    const double diagonal = std::abs(A(i, i));
    const double column = A.col(i).cwiseAbs().sum() - diagonal + C.col(i).cwiseAbs().sum();
    const double row = A.row(i).cwiseAbs().sum() - diagonal + B.row(i).cwiseAbs().sum();
    if (!(column > 0.0) || !(row > 0.0)) continue;
    const double f = std::exp2(std::round(0.5 * std::log2(row / column)));  // column·f ≈ row/f
    if (!(column * f + row / f < 0.95 * (column + row))) continue;
    A.col(i) *= f;
    C.col(i) *= f;
    A.row(i) /= f;
    B.row(i) /= f;
    scale[i] *= f;
    moved = true;
  }
  return moved;
}

constexpr int sweeps = 100;

void normalise_columns(MatrixXd& B, MatrixXd& D) {
  for (Index j = 0; j < B.cols(); ++j)
    if (const double norm = std::hypot(B.col(j).norm(), D.col(j).norm()); norm > 0.0)
      B.col(j) /= norm, D.col(j) /= norm;
}

void normalise_channels(Normalised& n) {
  normalise_columns(n.B, n.D);
  MatrixXd Ct = n.C.transpose(), Dt = n.D.transpose();
  normalise_columns(Ct, Dt);
  n.C = Ct.transpose();
  n.D = Dt.transpose();
}

}  // namespace

Balanced balance(const StateSpace& ss) {
  check(ss);
  Balanced b{ss, VectorXd::Ones(ss.A.rows())};
  for (int k = 0; k < sweeps && sweep(b.ss.A, b.ss.B, b.ss.C, b.scale); ++k) {
  }
  return b;
}

Normalised normalise(const StateSpace& ss) {
  check(ss);
  Normalised n{ss.A, ss.B, ss.C, ss.D, 1.0, VectorXd::Ones(ss.A.rows()), 1.0};
  normalise_channels(n);
  for (int k = 0; k < sweeps && sweep(n.A, n.B, n.C, n.scale); ++k) {
  }
  const double size = n.A.size() > 0 ? n.A.norm() : 0.0;
  n.rate = size > 0.0 ? std::exp2(std::round(std::log2(size))) : 1.0;
  n.A /= n.rate;
  n.B /= n.rate;
  normalise_channels(n);
  n.size = std::sqrt(n.A.squaredNorm() + n.B.squaredNorm() + n.C.squaredNorm() + n.D.squaredNorm());
  return n;
}

}  // namespace tenon::titop
