#include <gtest/gtest.h>

#include "fem/formats/matrices/op4.hpp"
#include "tests/unit/fem/formats/matrices/op4_files.hpp"
#include "tests/unit/fem/formats/nastran/reference_decks.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

/// 7×5: strings with gaps, a full column, a null column, one number; all exact in single precision.
Eigen::MatrixXd example() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(7, 5);
  A.col(0) << 0.0, 1.5, -2.25, 0.0, 0.0, 4.0, 0.0;
  A.col(1).setLinSpaced(1.0, 4.0);
  A(6, 3) = -1024.0;
  A.col(4) << 0.5, 0.0, 0.25, 0.0, 0.125, 0.0, 0.0625;
  return A;
}

Eigen::MatrixXd dense(const NamedMatrix& matrix) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(matrix.rows, matrix.columns);
  for (const auto& entry : matrix.entries) A(entry.row(), entry.col()) += entry.value();
  return A;
}

void expect_example(const std::vector<NamedMatrix>& read, const std::string& what) {
  ASSERT_EQ(read.size(), 2U) << what;
  EXPECT_EQ(read[0].name, "FIRST") << what;
  EXPECT_EQ(read[1].name, "KXX") << what;
  EXPECT_EQ(read[1].form, 2) << what;
  EXPECT_TRUE(dense(read[0]).isApprox(Eigen::MatrixXd::Identity(3, 3), 0.0)) << what;
  EXPECT_TRUE(dense(read[1]).isApprox(example(), 0.0)) << what << '\n' << dense(read[1]);
}

}  // namespace

TEST(Op4, BinaryOfEveryKind) {
  const Scratch folder;
  for (const Layout layout : {Layout::dense, Layout::sparse, Layout::big})
    for (const int type : {1, 2})
      for (const bool foreign : {false, true})
        for (const int word : {4, 8}) {
          const Op4Kind kind{layout, type, foreign, word};
          const auto file = folder.write(
              "a.op4", op4_binary("FIRST", Eigen::MatrixXd::Identity(3, 3), kind) + op4_binary("KXX", example(), kind));
          expect_example(read_op4(file), fmt::format("layout {} type {} foreign {} word {}", static_cast<int>(layout),
                                                     type, foreign, word));
        }
}

TEST(Op4, AsciiOfEveryKind) {
  const Scratch folder;
  for (const Layout layout : {Layout::dense, Layout::sparse, Layout::big})
    for (const int type : {1, 2})
      for (const char letter : {'E', 'D'}) {
        const Op4Kind kind{.layout = layout, .type = type};
        std::string text = op4_ascii("FIRST", Eigen::MatrixXd::Identity(3, 3), kind, letter) +
                           op4_ascii("KXX", example(), kind, letter);
        const std::string what = fmt::format("layout {} type {} {}", static_cast<int>(layout), type, letter);
        expect_example(read_op4(folder.write("a.op4", text)), what);
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
        expect_example(read_op4(folder.write("a.op4", text)), what + " with Windows line ends");
      }
}

/// Numbers that touch and exponents of three digits without a letter, as Fortran prints them; the format of five
/// numbers of 16 columns that a header without one means.
TEST(Op4, AsciiAsFortranPrintsIt) {
  const Scratch folder;
  const std::string text =
      "       2       2       1       2A       \n"
      "       1       1       2\n"
      "-1.234567890E+00-2.500000000-101\n"
      "       3       1       1\n"
      " 1.000000000E+00\n";
  const std::vector<NamedMatrix> read = read_op4(folder.write("a.op4", text));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(dense(read[0]), (Eigen::MatrixXd(2, 2) << -1.23456789, 0.0, -2.5e-101, 0.0).finished());
}

/// A null matrix may declare any size: it costs nothing.
TEST(Op4, DeclaredSizesCostNothing) {
  const Scratch folder;
  const std::string text =
      "2000000020000000       2       2NULL    1P,3E23.16\n20000001       1       1\n 1.0000000000000000E+00\n";
  const std::vector<NamedMatrix> read = read_op4(folder.write("null.op4", text));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].rows, 20000000);
  EXPECT_TRUE(read[0].entries.empty());
}

namespace {
using Op4OfNastran = NastranDecks;
}

TEST_F(Op4OfNastran, HoldsTheMatricesOfTheSuperelement) {
  const std::vector<NamedMatrix> read = read_op4(shared_deck("inboard.op4"));
  ASSERT_EQ(read.size(), 29U);
  EXPECT_EQ(read[0].name, "KXX");
  EXPECT_EQ(read[0].rows, 32);
  EXPECT_EQ(read[0].form, 6);
  EXPECT_EQ(read[1].name, "MXX");
  const Eigen::MatrixXd K = dense(read[0]), M = dense(read[1]);
  // Craig-Bampton: modes of unit mass behind the interface, their eigenvalues on the diagonal of K
  EXPECT_LT((M.bottomRightCorner(8, 8) - Eigen::MatrixXd::Identity(8, 8)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(K.topRightCorner(24, 8).cwiseAbs().maxCoeff(), 1e-5 * K.diagonal().maxCoeff());
}
