// Eqs (12), (23) and (24) of the TITOP paper entry for entry, with its misprints corrected, and what does not depend on
// units and slenderness.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tests/analytic/titop/beams.hpp"
#include "titop/constrain.hpp"

using namespace tenon;
using namespace tenon::titop;
using Eigen::MatrixXd;

namespace {

const BeamProperties rod{.length = 0.7, .E = 7.1e10, .rho = 2710.0, .A = 1.0774e-4, .Iz = 1.3e-9};
const std::vector<int> planar{0, 1, 5, 6, 7, 11};  // u, v, α at C and at P

// (A, B, C, D) of G_f in the states [q; q̇] of (14), eqs (12), (16), (17); inputs [F_C, T_C, v̈_P, α̈_P].
StateSpace bending_model() {
  const double l = rod.length, m = rod.rho * rod.A * l, EI = rod.E * rod.Iz;
  const double l2 = l * l, l3 = l2 * l, l4 = l3 * l;
  Eigen::Matrix<double, 6, 6> M;
  M << 55440, 27720 * l, 462 * l2, 27720, -5544 * l, 462 * l2,           //
      27720 * l, 18480 * l2, 198 * l3, 19800 * l, -3432 * l2, 264 * l3,  //
      462 * l2, 198 * l3, 6 * l4, 181 * l2, -52 * l3, 5 * l4,            //
      27720, 19800 * l, 181 * l2, 21720, -3732 * l, 281 * l2,            //
      -5544 * l, -3432 * l2, -52 * l3, -3732 * l, 832 * l2, -69 * l3,    //
      462 * l2, 264 * l3, 5 * l4, 281 * l2, -69 * l3, 6 * l4;
  M *= m / 55440;
  Eigen::Matrix4d K;
  K << 6 * l4, -30 * l2, 8 * l3, l4, -30 * l2, 1200, -600 * l, 30 * l2, 8 * l3, -600 * l, 384 * l2, -22 * l3, l4,
      30 * l2, -22 * l3, 6 * l4;
  K *= EI / (70 * l3);
  Eigen::Matrix2d tau;
  tau << 1, l, 0, 1;
  MatrixXd Phi = MatrixXd::Zero(2, 4);
  Phi(0, 1) = Phi(1, 2) = 1;
  const MatrixXd M_rr = M.topLeftCorner(2, 2), M_rf = M.bottomLeftCorner(4, 2);
  const MatrixXd W = M.bottomRightCorner(4, 4).inverse();
  StateSpace ss;
  ss.A = MatrixXd::Zero(8, 8);
  ss.A.topRightCorner(4, 4).setIdentity();
  ss.A.bottomLeftCorner(4, 4) = -W * K;
  ss.B = MatrixXd::Zero(8, 4);
  ss.B.bottomRows(4) << W * Phi.transpose(), -W * M_rf;
  ss.C = MatrixXd::Zero(4, 8);
  ss.C.leftCols(4) << -Phi * W * K, M_rf.transpose() * W * K;
  const MatrixXd coupling = tau - Phi * W * M_rf;
  ss.D.resize(4, 4);
  ss.D << Phi * W * Phi.transpose(), coupling, coupling.transpose(), M_rf.transpose() * W * M_rf - M_rr;
  return ss;
}

// Eq (23) with 3ES/(2l) in the row of F_P.
StateSpace traction_model() {
  const double l = rod.length, m = rod.rho * rod.A * l, ES = rod.E * rod.A;
  StateSpace ss;
  ss.A.resize(2, 2);
  ss.A << 0, 1, -3 * rod.E / (rod.rho * l * l), 0;
  ss.B.resize(2, 2);
  ss.B << 0, 0, 3 / m, -1.5;
  ss.C.resize(2, 2);
  ss.C << -3 * rod.E / (rod.rho * l * l), 0, 3 * ES / (2 * l), 0;
  ss.D.resize(2, 2);
  ss.D << 3 / m, -0.5, -0.5, -m / 4;
  return ss;
}

// diag(S⁻¹) scaling makes entries of every unit comparable: |a − b| against the sizes of row and column.
void expect_same(const MatrixXd& a, const MatrixXd& b, const char* what) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      const double size = std::min(b.row(i).cwiseAbs().maxCoeff(), b.col(j).cwiseAbs().maxCoeff());
      EXPECT_NEAR(a(i, j), b(i, j), 1e-10 * size) << what << "(" << i << ", " << j << ")";
    }
}

}  // namespace

TEST(PlanarBeam, IsEquation24EntryForEntry) {
  const reduction::ReducedBody beam = beam_body("beam", rod, {.bend_xz = false, .torsion = false});
  const StateSpace G = subsystem(port_model(beam).ss, planar, planar);
  ASSERT_EQ(G.order(), 10);

  const StateSpace f = bending_model(), t = traction_model();
  MatrixXd T = MatrixXd::Zero(6, 6);  // rows e5, e1, e2, e6, e3, e4
  const int ones[] = {4, 0, 1, 5, 2, 3};
  for (int i = 0; i < 6; ++i) T(i, ones[i]) = 1.0;
  MatrixXd D = MatrixXd::Zero(6, 6), B = MatrixXd::Zero(10, 6), C = MatrixXd::Zero(6, 10), A = MatrixXd::Zero(10, 10);
  D.topLeftCorner(4, 4) = f.D;
  D.bottomRightCorner(2, 2) = t.D;
  // states [q; δ_u; q̇; δ̇_u]
  A.topRightCorner(5, 5).setIdentity();
  A.block(5, 0, 4, 4) = f.A.bottomLeftCorner(4, 4);
  A(9, 4) = t.A(1, 0);
  B.block(5, 0, 4, 4) = f.B.bottomRows(4);
  B.block(9, 4, 1, 2) = t.B.row(1);
  C.block(0, 0, 4, 4) = f.C.leftCols(4);
  C.block(4, 4, 2, 1) = t.C.col(0);
  D = T * D * T.transpose();
  B = B * T.transpose();
  C = T * C;

  // q = V η: V from −A, scaled and signed by the first row of B that both have, F_C^y or F_C^x
  const Eigen::EigenSolver<MatrixXd> eigen(MatrixXd(-A.block(5, 0, 5, 5)));
  std::vector<int> order{0, 1, 2, 3, 4};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return eigen.eigenvalues()[a].real() < eigen.eigenvalues()[b].real(); });
  MatrixXd V(5, 5);
  for (int j = 0; j < 5; ++j) {
    const Eigen::VectorXd v = eigen.eigenvectors().col(order[static_cast<std::size_t>(j)]).real();
    const double C_v = C.row(1).head(5) * v, C_u = C.row(0).head(5) * v;
    const bool axial = std::abs(v[4]) > 0.5;
    V.col(j) = v * (axial ? G.C(0, j) / C_u : G.C(1, j) / C_v);
  }
  MatrixXd S = MatrixXd::Zero(10, 10);
  S.topLeftCorner(5, 5) = V;
  S.bottomRightCorner(5, 5) = V;
  expect_same(G.D, D, "D");
  expect_same(S * G.A * S.inverse(), A, "A");
  expect_same(S * G.B, B, "B");
  expect_same(G.C * S.inverse(), C, "C");
}

TEST(PlanarBeam, DirectionsWithoutModesAreExactZeros) {
  const reduction::ReducedBody beam = beam_body("beam", rod, {.bend_xz = false, .torsion = false});
  for (const int i : {2, 3, 4}) {
    EXPECT_TRUE(beam.L.col(i).isZero(0.0));
    EXPECT_TRUE(beam.ports[1].Phi.row(i).isZero(0.0));
  }
  const MatrixXd D = port_model(beam).ss.D;
  for (const int i : {2, 3, 4}) EXPECT_EQ(D(i, i), 0.0);
}

// l/h from 10 to 10⁶: frequencies over √(EI/(ρAl⁴)) and √(E/ρ)/l stay, also after release and fixing of both ends.
TEST(PlanarBeam, ScaledFrequenciesDoNotDependOnSlenderness) {
  const auto scaled = [](double slenderness, bool free) {
    const double h = 1.0 / slenderness;
    BeamProperties b{.length = 1.0, .E = 2e11, .rho = 7800.0, .A = h * h, .Iz = h * h * h * h / 12.0};
    const auto beam = beam_body("beam", b, {.bend_xz = false, .traction = false, .torsion = false});
    const double unit = std::sqrt(b.E * b.Iz / (b.rho * b.A));
    return Eigen::VectorXd(
        constrained_modes(
            beam, boundary(beam, {free ? End::free : End::clamped, free ? End::free : End::clamped}, Scope::bending))
            .omega /
        unit);
  };
  for (const bool free : {false, true}) {
    const Eigen::VectorXd first = scaled(10.0, free);
    for (const double slenderness : {1e2, 1e3, 1e4, 1e5, 1e6})
      EXPECT_LT((scaled(slenderness, free) - first).cwiseQuotient(first).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(PlanarBeam, BendingAndTractionKeepApartAtAnySlenderness) {
  for (const double slenderness : {1e1, 1e3, 1e6}) {
    const double h = 1.0 / slenderness;
    const BeamProperties b{.length = 1.0, .E = 2e11, .rho = 7800.0, .A = h * h, .Iz = h * h * h * h / 12.0};
    const auto beam = beam_body("beam", b, {.bend_xz = false, .torsion = false});
    const auto modes = constrained_modes(beam, boundary(beam, {End::free, End::free}, Scope::planar));
    EXPECT_EQ(modes.rigid.cols(), 3);
    ASSERT_EQ(modes.omega.size(), 5);
    // free-free rod, linear shape: u = 1 − 2x/l, ω² = 12 E/(ρl²)
    const double rod_mode = std::sqrt(12.0 * b.E / b.rho), unit = std::sqrt(b.E * b.Iz / (b.rho * b.A));
    double nearest = 1e300;
    for (const double omega : modes.omega) nearest = std::min(nearest, std::abs(omega / rod_mode - 1.0));
    EXPECT_LT(nearest, 1e-10);
    EXPECT_NEAR(modes.omega[0] / unit, 22.564, 0.5e-3);  // Table 3
  }
}

// millimetre, tonne, second against metre, kilogram, second
TEST(PlanarBeam, UnitsDoNotMatter) {
  BeamProperties si{.length = 0.7,
                    .E = 7.1e10,
                    .G = 2.7e10,
                    .rho = 2710.0,
                    .A = 1.1e-4,
                    .Iy = 2e-9,
                    .Iz = 1.3e-9,
                    .J = 1e-9,
                    .Ip = 3.3e-9};
  BeamProperties mm = si;
  mm.length *= 1e3, mm.E *= 1e-6, mm.G *= 1e-6, mm.rho *= 1e-12, mm.A *= 1e6;
  for (double* I : {&mm.Iy, &mm.Iz, &mm.J, &mm.Ip}) *I *= 1e12;
  const auto a = beam_body("a", si), b = beam_body("b", mm);
  const std::vector<std::vector<End>> pairs{{End::clamped, End::free},
                                            {End::free, End::clamped},
                                            {End::free, End::free},
                                            {End::pinned, End::sliding},
                                            {End::clamped, End::clamped}};
  for (const auto& ends : pairs) {
    const Eigen::VectorXd x = constrained_modes(a, boundary(a, ends)).omega,
                          y = constrained_modes(b, boundary(b, ends)).omega;
    ASSERT_EQ(x.size(), y.size());
    EXPECT_LT((x - y).cwiseQuotient(x).cwiseAbs().maxCoeff(), 1e-12);
  }
}
