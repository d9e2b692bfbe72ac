// The truss with two booms again, now through the reduced matrices that NX Nastran wrote of its two parts.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "fem/formats/matrices/superelement.hpp"
#include "fem/formats/nastran.hpp"
#include "reduction/reduce.hpp"
#include "tests/analytic/nastran_cb/joined_matrices.hpp"
#include "tests/unit/fem/formats/nastran/reference_decks.hpp"

using namespace tenon;

namespace {

class NastranSuperelements : public fem::NastranDecks {
 protected:
  static fem::MatrixData part(const std::string& name) {
    return fem::read_nastran_superelement(fem::shared_deck(name + ".asm").string());
  }
};

/// Eigenvalues [rad²/s²] that Nastran printed for the assembly of the two superelements.
std::vector<double> printed_for_assembly() {
  std::vector<double> values;
  std::ifstream file(fem::shared_deck("eigenvalues.csv"));
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("assemble,", 0) != 0) continue;
    std::istringstream row(line);
    std::string field;
    for (int i = 0; i < 3; ++i) std::getline(row, field, ',');
    values.push_back(std::stod(field));
  }
  return values;
}

constexpr int n_boundary = 24;

/// Receptance of the interface, u_b = H f_b: the leading 24×24 block of (K − ω²M)⁻¹.
Eigen::MatrixXd receptance(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, double omega) {
  const Eigen::MatrixXd Z = K - omega * omega * M;
  return Z.fullPivLu().inverse().topLeftCorner(n_boundary, n_boundary);
}

/// The same of a reduced body: H = B (diag(0, ω_j²) − ω² [D Lᵀ; L 1])⁻¹ Bᵀ, B = [τ_i Phi_i] of its ports. Eqs (1), (2).
Eigen::MatrixXd receptance(const reduction::ReducedBody& body, double omega) {
  const int n = body.n();
  Eigen::MatrixXd M(6 + n, 6 + n), K = Eigen::MatrixXd::Zero(6 + n, 6 + n), B(n_boundary, 6 + n);
  M << body.D, body.L.transpose(), body.L, Eigen::MatrixXd::Identity(n, n);
  K.diagonal().tail(n) = body.omega.cwiseAbs2();
  int row = 0;
  for (const char* port : {"3", "11", "19", "27"}) {
    const int i = reduction::port_index(body, port);
    B.middleRows(row, 6) << reduction::tau(body, i), body.ports[static_cast<std::size_t>(i)].Phi;
    row += 6;
  }
  return B * (K - omega * omega * M).fullPivLu().solve(Eigen::MatrixXd(B.transpose()));
}

/// ‖S(A − B)S‖ / ‖SBS‖, S = √diag K of the interface, so that lengths and angles compare.
double distance(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& K) {
  const Eigen::VectorXd S = K.diagonal().head(n_boundary).cwiseSqrt();
  return (S.asDiagonal() * (A - B) * S.asDiagonal()).norm() / (S.asDiagonal() * B * S.asDiagonal()).norm();
}

/// Craig-Bampton with the static responses to rigid inertia: Nastran's residual vectors are these (RESVEC).
reduction::ReducedBody our_body(const std::string& name, reduction::ReduceOptions options) {
  fem::NastranDeck deck = fem::read_nastran(fem::shared_deck(name + ".dat"));
  for (const int node : deck.boundary_nodes)
    deck.model.ports.push_back({fmt::format("{}", deck.model.node_ids[static_cast<std::size_t>(node)]), node});
  options.basis = reduction::Basis::craig_bampton_inertia_relief;
  return reduction::reduce(fem::assemble(deck.model), "3", options);
}

constexpr double hertz = 2.0 * std::numbers::pi;

}  // namespace

/// Nastran printed seven digits of the eigenvalues; 1e-5 of the frequencies is asked for.
TEST_F(NastranSuperelements, JoinedHaveTheFrequenciesOfNastransAssembly) {
  const tests::Joined joined = tests::join({part("outboard"), part("inboard")});
  const std::vector<double> nastran = printed_for_assembly();
  ASSERT_EQ(nastran.size(), 54U);
  ASSERT_EQ(joined.K.rows(), 54);
  const Eigen::VectorXd lambda =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(joined.K, joined.M, Eigen::EigenvaluesOnly)
          .eigenvalues();
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(lambda(i)), 1e-5) << "rigid mode " << i + 1;
  double worst = 0.0;
  for (int i = 6; i < 54; ++i)
    worst = std::max(worst, std::abs(std::sqrt(lambda(i) / nastran[static_cast<std::size_t>(i)]) - 1.0));
  RecordProperty("worst_error", fmt::format("{:.2e}", worst));
  EXPECT_LT(worst, 1e-6);
}

/// Our reduction of the decks, cut at 50 Hz as theirs, answers at the interface as Nastran's matrices do, up to the cut
/// and off the resonances: 22 generalised coordinates hold the 16 modes and six residual vectors.
TEST_F(NastranSuperelements, OurReductionOfTheOutboardPartAnswersAsNastrans) {
  const reduction::ReducedBody body = our_body("outboard", {.band = 50.0 * hertz});
  const fem::MatrixData data = part("outboard");
  EXPECT_EQ(6 + body.n(), data.K.rows());
  const Eigen::MatrixXd K = tests::whole(data.K), M = tests::whole(data.M);
  double worst = 0.0;
  for (const double f : {0.1, 0.7, 1.3, 3.0, 5.5, 9.0, 17.0, 31.0, 49.0})
    worst = std::max(worst, distance(receptance(body, f * hertz), receptance(K, M, f * hertz), K));
  RecordProperty("worst_error", fmt::format("{:.2e}", worst));
  EXPECT_LT(worst, 1e-4);
}

/// The deck of the inboard part has eight generalised coordinates, room for its three modes and five of the six
/// residual vectors. So the two agree below the first mode that is missing by much (70 Hz) only, here up to 35 Hz;
/// nearer to it Nastran's matrices are further from the part with all of its modes than ours are.
TEST_F(NastranSuperelements, OurReductionOfTheInboardPartHasOneShapeMoreThanNastrans) {
  const reduction::ReducedBody body = our_body("inboard", {.band = 50.0 * hertz});
  const reduction::ReducedBody all = our_body("inboard", {.all_modes = true});
  const fem::MatrixData data = part("inboard");
  EXPECT_EQ(6 + body.n(), data.K.rows() + 1);
  const Eigen::MatrixXd K = tests::whole(data.K), M = tests::whole(data.M);
  double worst = 0.0;
  for (const double f : {0.1, 0.7, 1.3, 3.0, 5.5, 9.0, 17.0, 31.0, 35.0})
    worst = std::max(worst, distance(receptance(body, f * hertz), receptance(K, M, f * hertz), K));
  RecordProperty("worst_error", fmt::format("{:.2e}", worst));
  EXPECT_LT(worst, 1e-4);
  for (const double f : {40.0, 45.0, 49.0}) {
    const Eigen::MatrixXd exact = receptance(all, f * hertz);
    const double ours = distance(receptance(body, f * hertz), exact, K),
                 theirs = distance(receptance(K, M, f * hertz), exact, K);
    RecordProperty(fmt::format("from_all_modes_at_{:g}_Hz", f), fmt::format("{:.2e}, Nastran {:.2e}", ours, theirs));
    EXPECT_LT(ours, theirs) << f << " Hz";
  }
}
