#include "titop/bending_basis.hpp"

#include "reduction/eq1.hpp"
#include "titop/clamped_free.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// q = [ṽ″(0), ṽ(1), ṽ′(1), ṽ″(1)], eq (14); rows of (15) as coefficients of ξ², ξ³, ξ⁴, ξ⁵
Eigen::Matrix4d quintic_coefficients() {
  Eigen::Matrix4d c;
  c << 0.5, -1.5, 1.5, -0.5,  //
      0, 10, -15, 6,          //
      0, -4, 7, -3,           //
      0, 0.5, -1, 0.5;
  return c;
}

}  // namespace

BendingBasis quintic_basis(const Eigen::VectorXd& xi) {
  reduction::RelativeForm q;
  q.M_zz.resize(4, 4);  // M_ff of (16)
  q.M_zz << 6, 181, -52, 5, 181, 21720, -3732, 281, -52, -3732, 832, -69, 5, 281, -69, 6;
  q.M_zz /= 55440.0;
  q.K_zz.resize(4, 4);  // (17)
  q.K_zz << 6, -30, 8, 1, -30, 1200, -600, 30, 8, -600, 384, -22, 1, 30, -22, 6;
  q.K_zz /= 70.0;
  q.M_zP = MatrixXd::Zero(4, 6);  // M_rf of (16), in the directions v_P and α_P
  q.M_zP.col(1) << 462, 27720, -5544, 462;
  q.M_zP.col(5) << 198, 19800, -3432, 264;
  q.M_zP /= 55440.0;
  reduction::ModalForm modal = reduction::modal_form(q);
  for (Index j = 0; j < 4; ++j)
    if (modal.V(1, j) < 0.0) {  // ṽ(1) > 0
      modal.V.col(j) *= -1.0;
      modal.L.row(j) *= -1.0;
    }

  BendingBasis basis{modal.omega, MatrixXd(4, 2), modal.V.middleRows<2>(1), MatrixXd(2 * xi.size(), 4)};
  basis.L << modal.L.col(1), modal.L.col(5);
  const MatrixXd coefficients = quintic_coefficients().transpose() * modal.V;  // powers of ξ × modes
  for (Index k = 0; k < xi.size(); ++k) {
    const double x = xi[k], x2 = x * x, x3 = x2 * x, x4 = x2 * x2;
    basis.shapes.row(2 * k) = Eigen::RowVector4d(x2, x3, x4, x4 * x) * coefficients;
    basis.shapes.row(2 * k + 1) = Eigen::RowVector4d(2 * x, 3 * x2, 4 * x3, 5 * x4) * coefficients;
  }
  return basis;
}

BendingBasis clamped_free_basis(int n, const Eigen::VectorXd& xi) {
  BendingBasis basis{Eigen::VectorXd(n), MatrixXd(n, 2), MatrixXd(2, n), MatrixXd(2 * xi.size(), n)};
  for (int j = 0; j < n; ++j) {
    const ClampedFreeMode mode = clamped_free_mode(j + 1);
    basis.omega[j] = mode.beta * mode.beta;
    basis.L.row(j) << mode.mean(), mode.moment();
    basis.Phi.col(j) << mode.tip(), mode.tip_slope();
    for (Index k = 0; k < xi.size(); ++k) basis.shapes.col(j).segment<2>(2 * k) << mode.value(xi[k]), mode.slope(xi[k]);
  }
  return basis;
}

}  // namespace tenon::titop
