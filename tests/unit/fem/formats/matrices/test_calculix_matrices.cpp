#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/formats/matrices/calculix.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

struct Job {
  std::string sti =
      "1 1  4.0000000000000e+00\n1 2 -1.5000000000000e+00\n2 2  3.0000000000000e+00\n3 3  2.0000000000000e+00\n";
  std::string mas = "1 1  1.0000000000000e+00\n2 2  1.0000000000000e+00\n3 3  0.0000000000000e+00\n";
  std::string dof = "7.1\n7.3\n10.2\n";

  MatrixData read() const {
    const Scratch folder;
    folder.write("job.sti", sti);
    folder.write("job.mas", mas);
    folder.write("job.dof", dof);
    return read_calculix_matrices(folder.file("job.sti").string(), {{7, {1.0, 2.0, 3.0}}, {8, Vec3::Zero()}});
  }
  std::string refused() const {
    return tenon::tests::refusal([&] { read(); });
  }
};

}  // namespace

TEST(CalculixMatrices, AreReadWithTheirLabels) {
  const MatrixData data = Job().read();
  ASSERT_EQ(data.rows.size(), 3U);
  EXPECT_EQ(data.rows[1].node, 7);
  EXPECT_EQ(data.rows[1].direction, 2);
  EXPECT_EQ(data.rows[2].node, 10);  // 10.2 as text: not node 10.2
  EXPECT_EQ(data.rows[2].direction, 1);
  EXPECT_EQ(Eigen::MatrixXd(data.K), (Mat3() << 4.0, 0.0, 0.0, -1.5, 3.0, 0.0, 0.0, 0.0, 2.0).finished());
  EXPECT_EQ(Eigen::MatrixXd(data.M), (Mat3() << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0).finished());
  ASSERT_EQ(data.positions.size(), 1U);
  EXPECT_EQ(data.positions.at(7), Vec3(1.0, 2.0, 3.0));
}

TEST(CalculixMatrices, FilesThatAreCutOffAreRefused) {
  Job job;
  job.sti.resize(job.sti.size() - 5);  // 2.00000000: still a number
  EXPECT_THAT(job.refused(), AllOf(HasSubstr("job.sti"), HasSubstr("the last line has no line end")));
  job = {};
  job.mas.resize(job.mas.rfind("3 3"));
  EXPECT_THAT(job.refused(), AllOf(HasSubstr("job.mas"), HasSubstr("diagonal entry of row 3 (node 10 uy) is missing")));
  job = {};
  job.dof = "7.1\n7.3\n";
  EXPECT_THAT(job.refused(), HasSubstr("job.sti:4:1: found row 3, but the .dof file labels 2 rows"));
  job.dof = "";
  EXPECT_THAT(job.refused(), HasSubstr("job.dof: the file is empty"));
}

TEST(CalculixMatrices, FaultsAreNamedByLineAndColumn) {
  Job job;
  job.dof = "7.1\n7.3\n7.3\n";
  EXPECT_THAT(job.refused(),
              AllOf(HasSubstr("job.dof:3:1: the label 7.3 stands twice"), HasSubstr("beams and shells")));
  job.dof = "7.1\n7.3\n10.0\n";
  EXPECT_THAT(job.refused(), HasSubstr("the label '10.0': only the directions 1 to 3"));
  for (const char* label : {"10", "10.", ".2", "-1.2", "1.x", "1.22", "x"}) {
    job.dof = std::string("7.1\n7.3\n") + label + "\n";
    EXPECT_THAT(job.refused(), HasSubstr("expected a label node.direction")) << label;
  }
  job = {};
  job.sti.replace(0, 3, "1 x");
  EXPECT_THAT(job.refused(), HasSubstr("job.sti:1:3: found 'x', expected column"));
  job = {};
  job.sti.replace(job.sti.find("-1.5"), 4, "+nan");
  EXPECT_THAT(job.refused(), HasSubstr("job.sti:2:5: found '+nan"));
  job = {};
  job.sti += "1 2 1.0\n";
  EXPECT_THAT(job.refused(), HasSubstr("(node 7 ux, node 7 uz) of the stiffness matrix stands twice"));
  job = {};
  job.sti += "2 1 1.0\n";
  EXPECT_THAT(job.refused(), HasSubstr("not symmetric"));
  job = {};
  job.sti += "3 3\n";
  EXPECT_THAT(job.refused(), HasSubstr("job.sti:5:4: found the end of the line"));
  job = {};
  job.sti += "3 3 1. 4\n";
  EXPECT_THAT(job.refused(), HasSubstr("job.sti:5:8: found '4', expected the end of the line"));
}
