#include "fem/formats/matrices/superelement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/refusal.hpp"
#include "tests/unit/fem/formats/matrices/op4_files.hpp"
#include "tests/unit/fem/formats/nastran/reference_decks.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

constexpr double stiffness = 8.0, mass = 2.0, coupling = 0.5, lambda = 9.0;

/// A spring of 13 rows, in basic directions: two nodes joined in all six directions, the second one heavy and coupled
/// to one mode in uy.
struct Part {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(13, 13), M = K;
  Part() {
    for (int d = 0; d < 6; ++d) {
      const double k = stiffness + d;
      K(d, d) = K(6 + d, 6 + d) = k;
      K(d, 6 + d) = K(6 + d, d) = -k;
      M(6 + d, 6 + d) = mass + d;
    }
    K(12, 12) = lambda;
    M(12, 12) = 1.0;
    M(7, 12) = M(12, 7) = coupling;
  }
};

/// Columns: the axes of CORD2R 5, a turn of 30° about z.
Mat3 skew_axes() { return Eigen::AngleAxisd(std::numbers::pi / 6.0, Vec3::UnitZ()).toRotationMatrix(); }

/// The matrices with the rows of the second node in its displacement frame: K_local = Tᵀ K T, u_basic = T u_local.
Eigen::MatrixXd in_frame(const Eigen::MatrixXd& A, const Mat3& axes) {
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  T.block<3, 3>(6, 6) = T.block<3, 3>(9, 9) = axes;
  return T.transpose() * A * T;
}

const std::string frames =
    "CORD2R*                5               0 0.000000000E+00 0.000000000E+00\n"
    "*        0.000000000E+00 0.000000000E+00 0.000000000E+00 0.100000000E+01\n"
    "*       .866025403784439.5              0.000000000E+00\n"
    "CORD2R,6,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n";

/// The main bulk data of the assembly: own numbers 4, 9, 101 are 1004, 1002, 2101 there.
std::string description(const std::string& frame = "5", const std::string& more = "") {
  return "SEBULK,7,EXTOP4,,MANUAL,,,7\n" + frames +
         "SECONCT        7       0              NO\n"
         "               4    1004       9    1002     101    2101\n"
         "GRID,1004,,1.,2.,3.,0\nGRID,1002,,1.,2.,5.," +
         frame + "\nSPOINT,2101\n" + more;
}

struct Files {
  Scratch folder;
  std::string asm_file;
  Files(const std::string& text, const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, const std::string& more = "")
      : asm_file(folder.write("part.asm", text).string()) {
    folder.write("part.op4",
                 op4_binary("KXX", K, {.layout = Layout::big}) + op4_binary("MXX", M, {.layout = Layout::big}) + more);
  }
  MatrixData read() const { return read_nastran_superelement(asm_file); }
  std::string refused() const {
    return tenon::tests::refusal([&] { read(); });
  }
};

Eigen::MatrixXd dense(const SparseMatrix& lower) {
  return Eigen::MatrixXd(Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>());
}

std::string rows_of(const MatrixData& data) {
  std::string text;
  for (const MatrixRow& row : data.rows)
    text += row.scalar ? fmt::format("q{} ", row.node) : fmt::format("{}.{} ", row.node, row.direction + 1);
  return text;
}

}  // namespace

TEST(Superelement, RowsAreNumberedAsInTheAssemblyAndTurnedToTheBasicFrame) {
  const Part part;
  const Files files(description(), in_frame(part.K, skew_axes()), in_frame(part.M, skew_axes()));
  const MatrixData data = files.read();
  EXPECT_EQ(rows_of(data),
            "1004.1 1004.2 1004.3 1004.4 1004.5 1004.6 1002.1 1002.2 1002.3 1002.4 1002.5 1002.6 q2101 ");
  EXPECT_LT((dense(data.K) - part.K).cwiseAbs().maxCoeff(), 1e-14 * part.K.maxCoeff());
  EXPECT_LT((dense(data.M) - part.M).cwiseAbs().maxCoeff(), 1e-14 * part.M.maxCoeff());
  EXPECT_EQ(data.positions.at(1002), Vec3(1.0, 2.0, 5.0));
  EXPECT_THAT(data.sets.at("boundary"), ElementsAre(1004, 1002));
  EXPECT_THAT(data.losses, IsEmpty());
  EXPECT_EQ(data.source, files.asm_file);
}

/// A frame that only renames the axes (x → y → z → x) permutes the rows.
TEST(Superelement, RenamedAxesNeedNotBeComplete) {
  const Part part;
  Mat3 renamed;
  renamed << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;   // CORD2R 6: x' = y, y' = z, z' = x
  const std::vector<int> kept{0, 1, 2, 3, 4, 5, 6, 7, 12};  // of node 9 the components 1 and 2
  const auto pick = [&](const Eigen::MatrixXd& A) { return Eigen::MatrixXd(in_frame(A, renamed)(kept, kept)); };
  const std::string punch = "BEGIN SUPER        7\nEXTRN,4,123456,9,12,101,0\nGRID,4\nGRID,9\nSPOINT,101\n";
  const Files files(description("6"), pick(part.K), pick(part.M));
  files.folder.write("part.pch", punch);
  const MatrixData data = files.read();
  EXPECT_EQ(rows_of(data), "1004.1 1004.2 1004.3 1004.4 1004.5 1004.6 1002.2 1002.3 q2101 ");
  EXPECT_EQ(dense(data.K)(6, 6), stiffness + 1.0);  // uy
  EXPECT_EQ(dense(data.K)(7, 2), -(stiffness + 2.0));
  EXPECT_EQ(dense(data.M)(6, 8), coupling);

  const Files askew(description("5"), pick(part.K), pick(part.M));
  askew.folder.write("part.pch", punch);
  EXPECT_THAT(askew.refused(), HasSubstr("node 1002 has some but not all translations"));
}

TEST(Superelement, ThePunchFileAloneUsesItsOwnNumbers) {
  const Part part;
  const Scratch folder;
  folder.write("part.op4", op4_ascii("KXX", part.K) + op4_ascii("MXX", part.M));
  const auto file =
      folder.write("part.pch",
                   "$ punched\nBEGIN SUPER        7\nEXTRN          4  123456       9  123456     101    THRU"
                   "     101       0\nGRID,4,,1.,2.,3.\nGRID,9\nSPOINT,101,THRU,101\nASET,4,123456\n"
                   "QSET1,,101\n");
  const MatrixData data = read_nastran_superelement(file.string());
  EXPECT_EQ(rows_of(data), "4.1 4.2 4.3 4.4 4.5 4.6 9.1 9.2 9.3 9.4 9.5 9.6 q101 ");
  EXPECT_EQ(dense(data.K), part.K);
  EXPECT_EQ(data.positions.at(4), Vec3(1.0, 2.0, 3.0));
}

TEST(Superelement, PermanentSupportsAreLosses) {
  const Part part;
  std::string text = description("0");
  text.replace(text.find("3.,0\n"), 4, "3.,0,12");
  const std::vector<Loss> losses = Files(text, part.K, part.M).read().losses;
  ASSERT_EQ(losses.size(), 1U);
  EXPECT_EQ(losses[0].name, "GRID PS");
}

TEST(Superelement, DampingAndRecoveryAreLosses) {
  const Part part;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  const Files files(description("0", "DTI,TUG1,0,1\n"), part.K, part.M,
                    op4_binary("BXX1", one) + op4_binary("K4XX1", one) + op4_binary("MUG1", one) +
                        op4_binary("PX1", Eigen::MatrixXd::Zero(1, 1)));
  std::string names;
  for (const Loss& loss : files.read().losses) names += loss.name + ": " + loss.note + "\n";
  EXPECT_THAT(names, AllOf(HasSubstr("BXX1: viscous"), HasSubstr("K4XX1: structural"), HasSubstr("MUG1: loads and out"),
                           HasSubstr("DTI: "), ::testing::Not(HasSubstr("PX1"))));
}

TEST(Superelement, WhatDoesNotBelongTogetherIsRefused) {
  const Part part;
  Eigen::MatrixXd unsymmetric = part.K;
  unsymmetric(3, 9) = -11.001;
  EXPECT_THAT(Files(description(), unsymmetric, part.M).refused(),
              AllOf(HasSubstr("KXX is not symmetric"), HasSubstr("node 1002 rx and node 1004 rx")));
  const Eigen::MatrixXd smaller = part.K.topLeftCorner(12, 12);
  EXPECT_THAT(Files(description(), smaller, smaller).refused(), HasSubstr("gives 13 rows, but KXX of"));
  EXPECT_THAT(Files(description(), part.K, smaller).refused(), HasSubstr("KXX is 13×13 and MXX is 12×12"));
  EXPECT_THAT(Files(description("0", "CELAS2,1,5.,1004,1\n"), part.K, part.M).refused(),
              HasSubstr("CELAS2 (1 found, first at "));
  EXPECT_THAT(Files(description("8"), part.K, part.M).refused(),
              HasSubstr("coordinate system 8, which is not defined"));
  EXPECT_THAT(Files("GRID,4\nSECONCT,7,0\n,4,4,5,5\n", smaller, smaller).refused(),
              HasSubstr("point 5 of the interface is neither a GRID nor an SPOINT"));
  EXPECT_THAT(Files("GRID,4\nSECONCT,7,8\n,4,4\n", smaller, smaller).refused(), HasSubstr("two superelements"));
  EXPECT_THAT(Files("GRID,4\nGRID,9\nEXTRN,9,123456,4,123456\n", smaller, smaller).refused(),
              HasSubstr("EXTRN names 4 behind 9"));
  EXPECT_THAT(Files("GRID,4\nSPOINT,100,THRU,2000000000\n", smaller, smaller).refused(),
              HasSubstr("SPOINT names 100 to 2000000000, but the matrices have 12 rows only"));
  EXPECT_THAT(Files("GRID,4\nSPOINT,10,THRU,20\nSPOINT,30,THRU,40\n", smaller, smaller).refused(),
              HasSubstr("SPOINT names 30 to 40"));
  EXPECT_THAT(Files("GRID,4\nGRID,9\nSECONCT,7,0\n,4,4,5,4\n", smaller, smaller).refused(),
              HasSubstr("point 4 stands twice in the interface"));
  EXPECT_THAT(Files("SPOINT,9\nEXTRN,9223372036854775807,0\n", smaller, smaller).refused(),
              HasSubstr("point 9223372036854775807 of the interface is neither"));
  EXPECT_THAT(Files("GRID,4\nSPOINT,9\nEXTRN,4,123456,9,THRU,2000000000,0\n", smaller, smaller).refused(),
              HasSubstr("more points than the 12 rows"));

  const Files unnamed(description(), part.K, part.M);
  unnamed.folder.write("part.op4", op4_binary("KGG", part.K));
  EXPECT_THAT(unnamed.refused(), HasSubstr("found no matrix KXX; the file has KGG"));
  const std::string huge =
      "2000000020000000       2       2KXX     1P,3E23.16\n20000001       1       1\n 1.0000000000000000E+00\n"
      "2000000020000000       2       2MXX     1P,3E23.16\n20000001       1       1\n 1.0000000000000000E+00\n";
  unnamed.folder.write("part.op4", huge);
  EXPECT_THAT(unnamed.refused(), HasSubstr("20000000 rows, more than the grids and entries"));
  std::filesystem::remove(unnamed.folder.file("part.op4"));
  EXPECT_THAT(unnamed.refused(), AllOf(HasSubstr("part.asm"), HasSubstr("there is no part.op4 beside it")));
}

namespace {
using SuperelementOfNastran = NastranDecks;
}

TEST_F(SuperelementOfNastran, BothDescriptionsSayTheSame) {
  for (const char* part : {"inboard", "outboard"}) {
    const MatrixData main = read_nastran_superelement(shared_deck(part + std::string(".asm")).string());
    const MatrixData own = read_nastran_superelement(shared_deck(part + std::string(".pch")).string());
    EXPECT_EQ(rows_of(main), rows_of(own));
    EXPECT_EQ(dense(main.K), dense(own.K));
    EXPECT_THAT(main.sets.at("boundary"), ElementsAre(3, 11, 19, 27));
    // no force in a rigid motion: K_bb R = 0, to the seven digits in which the frame's axes are written
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(main.K.rows(), 6);
    for (std::size_t i = 0; i < main.rows.size(); ++i)
      if (!main.rows[i].scalar)
        R.row(static_cast<Eigen::Index>(i)) = tau(main.positions.at(main.rows[i].node)).row(main.rows[i].direction);
    const Eigen::MatrixXd K = dense(main.K);
    EXPECT_LT((K * R).cwiseAbs().maxCoeff(), 1e-9 * (K.cwiseAbs() * R.cwiseAbs()).maxCoeff()) << part;
  }
}
