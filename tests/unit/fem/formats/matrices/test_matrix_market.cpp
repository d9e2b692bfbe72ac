#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "fem/formats/matrices/labels.hpp"
#include "fem/formats/matrices/make_model.hpp"
#include "fem/formats/matrices/matrix_market.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using tenon::fem::testing::Scratch;
using tenon::tests::refusal;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

const std::string symmetric = "%%MatrixMarket matrix coordinate real symmetric\n";
const std::string general = "%%MatrixMarket matrix coordinate real general\n";
const std::vector<MatrixRow> three{{1, 0, false}, {1, 1, false}, {7, 0, true}};

Eigen::MatrixXd read(const std::string& text, const std::vector<MatrixRow>& rows = three) {
  const Scratch scratch;
  const SparseMatrix lower = read_matrix_market(scratch.write("k.mtx", text), rows);
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  return Eigen::MatrixXd(whole);
}
std::string fault(const std::string& text) {
  return refusal([&] { read(text); });
}
MatrixData labels(const std::string& text) {
  const Scratch scratch;
  return read_matrix_labels(scratch.write("rows.txt", text));
}
std::string label_fault(const std::string& text) {
  return refusal([&] { labels(text); });
}

}  // namespace

TEST(MatrixMarket, ReadsEitherTriangleBothAndIntegers) {
  Eigen::Matrix3d expected;
  expected << 4, -1, 0, -1, 5.5, 2e-3, 0, 2e-3, 6;
  EXPECT_EQ(read(symmetric + "% made by hand\n\n3 3 5\n1 1 4\n2 1 -1\n2 2 5.5\n3 2 2e-3\n3 3 6\n"), expected);
  EXPECT_EQ(read(symmetric + "3 3 5\r\n1 1 +4\r\n1 2 -1\r\n2 2 5.5\r\n2 3 2e-3\r\n3 3 6\r\n"), expected);
  EXPECT_EQ(read(general + "3 3 7\n1 1 4\n2 1 -1\n1 2 -1\n2 2 5.5\n3 2 2e-3\n2 3 2e-3\n3 3 6\n"), expected);
  EXPECT_EQ(read("%%MatrixMarket Matrix Coordinate Integer General\n3 3 2\n1 1 4\n3 3 6\n")(2, 2), 6.0);
}

TEST(MatrixMarket, RefusesOtherKindsByName) {
  const std::string body = "3 3 1\n1 1 4\n";
  EXPECT_THAT(fault("%%MatrixMarket matrix array real general\n" + body),
              HasSubstr("k.mtx:1:23: the format is 'array'"));
  EXPECT_THAT(fault("%%MatrixMarket matrix coordinate pattern general\n" + body), HasSubstr("a pattern has no values"));
  EXPECT_THAT(fault("%%MatrixMarket matrix coordinate complex symmetric\n" + body), HasSubstr("field is 'complex'"));
  EXPECT_THAT(fault("%%MatrixMarket matrix coordinate real skew-symmetric\n" + body),
              HasSubstr("symmetry is 'skew-symmetric'"));
  EXPECT_THAT(fault("%%MatrixMarket vector coordinate real general\n" + body), HasSubstr("the object is 'vector'"));
  EXPECT_THAT(fault("1 1 4\n"), HasSubstr("does not begin with %%MatrixMarket"));
  EXPECT_THAT(fault(""), HasSubstr("the file is empty"));
}

TEST(MatrixMarket, NamesThePlaceOfAFault) {
  EXPECT_THAT(fault(symmetric + "3 4 1\n1 1 4\n"), HasSubstr("k.mtx:2:3: 3×4 is not square"));
  EXPECT_THAT(fault(symmetric + "4 4 1\n1 1 4\n"), HasSubstr("the matrix has 4 rows and the label file 3"));
  EXPECT_THAT(fault(symmetric + "2000000000 2000000000 1\n1 1 4\n"), HasSubstr("the label file 3"));
  EXPECT_THAT(fault(symmetric + "3 3 4000000000000000000\n1 1 4\n"),
              HasSubstr("the file ends after 1 of 4000000000000000000 entries"));
  EXPECT_THAT(fault(symmetric + "3 3 -1\n"), HasSubstr("found '-1', expected the number of entries"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 1 4\n2 2 1\n"), HasSubstr("k.mtx:4:1: there is more after the 1 entries"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n0 1 4\n"), HasSubstr("k.mtx:3:1: found '0', expected a row"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 4 4\n"), HasSubstr("k.mtx:3:3: found '4', expected a column"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 1 nan\n"), HasSubstr("k.mtx:3:5: found 'nan', expected a value"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 1 1e400\n"), HasSubstr("expected a value (a finite number)"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 1 4 5\n"), HasSubstr("k.mtx:3:7: found '5', expected the end of the line"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 1\n"), HasSubstr("found the end of the line, expected a value"));
  EXPECT_THAT(fault(symmetric + "3 3 1\n1 1 1.2"), HasSubstr("the last line has no line end"));
  EXPECT_THAT(fault(symmetric), HasSubstr("expected the line of sizes"));
  EXPECT_THAT(fault("%%MatrixMarket matrix coordinate integer symmetric\n3 3 1\n1 1 1.5\n"), HasSubstr("`real`"));
}

TEST(MatrixMarket, RefusesRepeatedEntriesAndNamesTheWorstAsymmetry) {
  EXPECT_THAT(fault(symmetric + "3 3 2\n2 1 4\n1 2 4\n"), HasSubstr("k.mtx:4:1: the entry (2, 1) is given twice"));
  EXPECT_THAT(fault(general + "3 3 3\n2 1 4\n1 2 4\n2 1 4\n"), HasSubstr("is given twice"));
  EXPECT_THAT(fault(symmetric + "3 3 2\n1 1 4\n1 1 4\n"), HasSubstr("is given twice"));
  EXPECT_THAT(fault(general + "3 3 5\n1 1 9\n2 1 1.001\n1 2 1\n3 2 5\n2 3 4\n"),
              HasSubstr("k.mtx:6:1: the matrix is not symmetric: 5 and 4 couple scalar point 7 and node 1 uy"));
  EXPECT_THAT(fault(general + "3 3 1\n2 1 1\n"), HasSubstr("the matrix is not symmetric: 1 and 0"));
  EXPECT_EQ(fault(general + "3 3 3\n1 1 1\n2 1 0.3\n1 2 0.30000000000000004\n"), "");  // round-off is not a fault
}

TEST(MatrixLabels, SayDofsPlacesAndSets) {
  const MatrixData data = labels(
      "# rows\n45 ux 1 2 3  # with its place\n45 2\n45 rz 1 2 3\nscalar\n46 6\nscalar 900\n"
      "scalar\nset root 45 46\nset root 46\n");
  ASSERT_EQ(data.rows.size(), 7U);
  EXPECT_EQ(data.rows[1].direction, 1);
  EXPECT_EQ(data.rows[2].direction, 5);
  EXPECT_TRUE(data.rows[3].scalar);
  EXPECT_EQ(data.rows[3].node, 901);
  EXPECT_EQ(data.rows[5].node, 900);
  EXPECT_EQ(data.rows[6].node, 902);
  EXPECT_EQ(data.positions.at(45), Vec3(1, 2, 3));
  EXPECT_FALSE(data.positions.contains(46));
  EXPECT_THAT(data.sets.at("root"), ElementsAre(45, 46, 46));
}

TEST(MatrixLabels, NameThePlaceOfAFault) {
  EXPECT_THAT(label_fault("scaler\n"),
              AllOf(HasSubstr("rows.txt:1:1: found 'scaler'"), HasSubstr("Did you mean 'scalar'?")));
  EXPECT_THAT(label_fault("0 ux\n"), HasSubstr("found '0', expected a node number"));
  EXPECT_THAT(label_fault("1 u\n"), HasSubstr("rows.txt:1:3: found the direction 'u'"));
  EXPECT_THAT(label_fault("1 7\n"), HasSubstr("found the direction '7'"));
  EXPECT_THAT(label_fault("1\n"), HasSubstr("found the end of the line, expected a direction"));
  EXPECT_THAT(label_fault("1 ux 0 0\n"), HasSubstr("expected a coordinate"));
  EXPECT_THAT(label_fault("1 ux 0 0 0 0\n"), HasSubstr("rows.txt:1:12: found '0', expected the end of the line"));
  EXPECT_THAT(label_fault("1 ux\n1 1\n"), HasSubstr("rows.txt:2:1: node 1 ux has a row already"));
  EXPECT_THAT(label_fault("1 ux 0 0 0\n1 uy 0 0 1\n"), HasSubstr("node 1 stands at (0, 0, 1) here and at (0, 0, 0)"));
  EXPECT_THAT(label_fault("1 ux\nset a 2\n"), HasSubstr("rows.txt:2:7: a set names node 2, which has no row"));
  EXPECT_THAT(label_fault("1 ux\nset a\n"), HasSubstr("expected a node number"));
  EXPECT_THAT(label_fault("5 ux\nscalar 5\n"), HasSubstr("the number 5 is taken already"));
  EXPECT_THAT(label_fault("# nothing\n"), HasSubstr("labels no row"));
}

TEST(MakeModel, RefusesMatricesThatNoBodyHas) {
  const auto data = [](double k11, double k21, double k22) {
    MatrixData d;
    d.source = "d";
    d.rows = {{1, 0}, {2, 0}};
    d.K.resize(2, 2);
    d.M.resize(2, 2);
    d.K.insert(0, 0) = k11;
    d.K.insert(1, 0) = k21;
    d.K.insert(1, 1) = k22;
    return d;
  };
  const auto said = [&](MatrixData d) { return refusal([&] { make_model(std::move(d)); }); };
  EXPECT_EQ(said(data(1, -1, 1)), "");
  EXPECT_THAT(said(data(-1, 0, 1)), HasSubstr("d: K has -1 on the diagonal at node 1 ux"));
  EXPECT_THAT(said(data(0, 1, 1)), HasSubstr("K couples node 2 ux and node 1 ux"));
  EXPECT_THAT(said(data(NAN, 0, 1)), HasSubstr("K holds nan at node 1 ux"));
  MatrixData twice = data(1, 0, 1);
  twice.rows[1] = {1, 0, true};
  EXPECT_THAT(said(twice), HasSubstr("two rows of the matrices belong to the scalar dof 1"));
  MatrixData wide = data(1, 0, 1);
  wide.rows.pop_back();
  EXPECT_THAT(said(wide), HasSubstr("for 1 labelled rows"));
}

// SDLD02 of the VPCS guide: 8 masses of 10 kg between 9 springs of 1e5 N/m, ω_j = 2 √(k/m) sin(jπ/18).
TEST(MakeModel, GivesTheChainItsFrequencies) {
  const Scratch scratch;
  std::string K = symmetric + "8 8 15\n", M = symmetric + "8 8 8\n", rows;
  for (int i = 1; i <= 8; ++i) {
    K += std::to_string(i) + " " + std::to_string(i) + " 2e5\n";
    if (i > 1) K += std::to_string(i) + " " + std::to_string(i - 1) + " -1e5\n";
    M += std::to_string(i) + " " + std::to_string(i) + " 10\n";
    rows += std::to_string(i) + " ux\n";
  }
  const MatrixModel chain = make_model(
      read_market_matrices(scratch.write("k.mtx", K), scratch.write("m.mtx", M), scratch.write("rows.txt", rows)));
  const Structure s = assemble(chain.model);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(s.K), Eigen::MatrixXd(s.M)};
  for (int j = 1; j <= 8; ++j)
    EXPECT_NEAR(std::sqrt(eigen.eigenvalues()[j - 1]) / (200.0 * std::sin(j * std::numbers::pi / 18.0)), 1.0, 1e-12);
}
