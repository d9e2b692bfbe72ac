#include "reduction/roots.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

using namespace tenon::reduction;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd orthonormal(Eigen::Index rows, Eigen::Index columns, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  const MatrixXd A = MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); });
  return Eigen::HouseholderQR<MatrixXd>(A).householderQ() * MatrixXd::Identity(rows, columns);
}

void expect_decomposes(const ThinSvd& svd, const MatrixXd& A, const VectorXd& sigma) {
  const double round_off = 1e-14 * std::max(sigma.maxCoeff(), 1e-300) * static_cast<double>(A.cols());
  const MatrixXd one = MatrixXd::Identity(A.cols(), A.cols());
  EXPECT_LT((svd.sigma - sigma).cwiseAbs().maxCoeff(), round_off);
  EXPECT_LT((svd.U * svd.sigma.asDiagonal() * svd.V.transpose() - A).cwiseAbs().maxCoeff(), round_off);
  EXPECT_LT((svd.U.transpose() * svd.U - one).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((svd.V.transpose() * svd.V - one).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace

// A = U σ Vᵀ put together from its factors, by both methods: small, square, tall, of deficient rank, zero.
TEST(ThinSvd, FindsTheFactorsItWasMadeOf) {
  std::mt19937 engine(3);
  for (const auto& [m, n] : {std::pair<Eigen::Index, Eigen::Index>{1, 1}, {3, 1}, {2, 2}, {7, 4}, {60, 60}, {260, 200}})
    for (const bool deficient : {false, true}) {
      VectorXd sigma = VectorXd::LinSpaced(n, static_cast<double>(n), 1.0);
      if (deficient) sigma.tail((n + 1) / 2).setZero();
      const MatrixXd A = orthonormal(m, n, engine) * sigma.asDiagonal() * orthonormal(n, n, engine).transpose();
      SCOPED_TRACE(testing::Message() << m << " by " << n << (deficient ? ", deficient" : ""));
      expect_decomposes(thin_svd(A), A, sigma);
      expect_decomposes(divide_and_conquer_svd(A), A, sigma);
    }
  EXPECT_EQ(thin_svd(MatrixXd(5, 0)).sigma.size(), 0);
}

TEST(MassRoot, KeepsLightRotationsBesideHeavyTranslations) {
  tenon::fem::Mat6 D = tenon::fem::Mat6::Zero();
  D.diagonal() << 1e12, 1e12, 1e12, 1e-6, 2e-6, 0.0;
  const tenon::fem::Mat6 S = mass_root(D, D.diagonal());
  const tenon::fem::Mat6 back = S.transpose() * S;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(back(i, i), D(i, i), 1e-14 * D(i, i));
}
