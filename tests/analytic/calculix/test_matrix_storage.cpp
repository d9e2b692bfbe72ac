// The matrices of a solid part that CalculiX stores against the frequencies that it finds itself.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "fem/error.hpp"
#include "fem/formats/matrices/calculix.hpp"
#include "tests/analytic/calculix/block.hpp"
#include "tests/analytic/calculix/ccx.hpp"
#include "tests/support/oracle.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using fem::testing::Scratch;

/// The tolerance asked for is 1e-8 of the frequencies. The files carry 14 digits; CalculiX prints seven of each
/// frequency, so the comparison takes the doubles of its .eig file.
TEST(MatrixStorage, GivesCalculixsOwnFrequencies) {
  TENON_SKIP_WITHOUT(calculix::installed(), "CalculiX (calculix-ccx)");
  const Scratch folder;
  const calculix::Block block;
  folder.write("part.inp", block.deck("SOLVER=MATRIXSTORAGE"));
  folder.write("own.inp", block.deck("STORAGE=YES"));
  ASSERT_TRUE(calculix::run(folder.file(""), "part")) << fem::testing::contents(folder.file("part.log"));
  ASSERT_TRUE(calculix::run(folder.file(""), "own")) << fem::testing::contents(folder.file("own.log"));
  const std::vector<double> own = calculix::stored_eigenvalues(fem::testing::contents(folder.file("own.eig")));
  ASSERT_EQ(own.size(), 10U) << "the .eig file is not laid out as in CalculiX 2.20";

  const fem::MatrixData data = fem::read_calculix_matrices(folder.file("part").string(), block.positions);
  ASSERT_EQ(data.rows.size(), 228U);  // 89 nodes, 13 of them held
  EXPECT_EQ(data.positions.size(), 76U);
  // M is singular (reduced integration), so M φ = μ K φ with λ = 1/μ
  const auto whole = [](const fem::SparseMatrix& lower) {
    return Eigen::MatrixXd(Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>());
  };
  const Eigen::VectorXd mu =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(whole(data.M), whole(data.K), Eigen::EigenvaluesOnly)
          .eigenvalues();
  double worst = 0.0;
  for (int i = 0; i < 10; ++i)
    worst = std::max(worst, std::abs(std::sqrt(1.0 / mu(mu.size() - 1 - i) / own[static_cast<std::size_t>(i)]) - 1.0));
  RecordProperty("worst_error", fmt::format("{:.2e}", worst));
  EXPECT_LT(worst, 1e-8);

  // all of the mass: 7.8e-9 t/mm³ × 12 mm³, less what the held nodes carry
  Eigen::VectorXd x = Eigen::VectorXd::Zero(mu.size());
  for (std::size_t i = 0; i < data.rows.size(); ++i)
    if (data.rows[i].direction == 0) x(static_cast<Eigen::Index>(i)) = data.positions.at(data.rows[i].node).z() / 6.0;
  // u = z/6 is in the space of the elements: ∫ρ u² dV = m/3, exactly integrated
  EXPECT_NEAR(x.dot(whole(data.M) * x), 7.8e-9 * 12.0 / 3.0, 1e-10 * 7.8e-9);
}

/// CalculiX makes solids of beams and labels their rows by the nodes of the beam.
TEST(MatrixStorage, OfBeamsIsRefused) {
  TENON_SKIP_WITHOUT(calculix::installed(), "CalculiX (calculix-ccx)");
  const Scratch folder;
  folder.write("beam.inp",
               "*NODE, NSET=NALL\n1,0.,0.,0.\n2,.5,0.,0.\n3,1.,0.,0.\n*ELEMENT, TYPE=B32R, ELSET=EALL\n1,1,2,3\n"
               "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000.,.3\n*DENSITY\n7.8E-9\n"
               "*BEAM SECTION, ELSET=EALL, MATERIAL=STEEL, SECTION=RECT\n.1,.2\n0.,0.,1.\n*BOUNDARY\n1,1,6\n"
               "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n3\n*END STEP\n");
  ASSERT_TRUE(calculix::run(folder.file(""), "beam")) << fem::testing::contents(folder.file("beam.log"));
  try {
    fem::read_calculix_matrices(folder.file("beam").string());
    FAIL() << "read without an error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("stands twice: CalculiX expands beams and shells to solids"));
  }
}
