#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fem/error.hpp"
#include "reduction/body_file.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/shape_integrals.hpp"

using namespace tenon;
using namespace tenon::reduction;
using testing::HasSubstr;

namespace {

// a body whose numbers have awkward digits
ReducedBody awkward() {
  ReducedBody body = rigid_body("päne\"l", 3.7, Vec3(0.1, 1.0 / 3.0, -2e-17), 0.3 * Mat3::Identity(),
                                {{"root", Vec3(1e-300, 0.1, 0.2)}, {"tip", Vec3(4.0, -0.0, 1.0 / 7.0)}});
  body.omega = Eigen::Vector2d(std::numbers::pi, 5e-324);
  body.zeta = Eigen::Vector2d(0.1 + 0.2, 0.0);
  body.C = Eigen::Matrix2d{{1.0 / 3.0, 0.1}, {0.1, 1.0 / 7.0}};
  body.L = Eigen::MatrixXd::Constant(2, 6, 1.0 / 49.0);
  body.ports[0].Phi = Mat6X::Zero(6, 2);
  body.ports[1].Phi = Mat6X::Constant(6, 2, 1.0 + std::numeric_limits<double>::epsilon());
  body.node_positions = {Vec3(0.1, 0.2, 0.3)};
  body.node_shapes = Eigen::MatrixXd::Constant(6, 2, -1.7976931348623157e308);
  body.certificate = {"craig-bampton", "panel.msh", "fnv1a64:0", 5,   4,         30, 2, 2,
                      1.0 / 3.0,       1e-17,       2e-16,       0.7, {"a", "b"}};
  ShapeIntegrals integrals{
      Eigen::MatrixXd::Random(6, 2), Eigen::MatrixXd::Random(12, 2), Eigen::MatrixXd::Random(6, 2), {}};
  integrals.nodes = {Mat3::Random(),
                     Eigen::Matrix3Xd::Random(3, 2),
                     Eigen::Matrix3Xd::Random(3, 6),
                     Eigen::MatrixXd::Random(6, 2),
                     Eigen::MatrixXd::Random(6, 2),
                     Eigen::MatrixXd::Random(4, 2)};
  body.shape_integrals = std::make_shared<const ShapeIntegrals>(std::move(integrals));
  body.stiffening =
      std::make_shared<const GeometricStiffness>(GeometricStiffness{Eigen::MatrixXd::Random(25, 24), Mat6::Random()});
  return body;
}

class BodyFile : public testing::Test {
 protected:
  BodyFile() : path(std::filesystem::temp_directory_path() / ("tenon_" + std::to_string(getpid()) + ".body.json")) {}
  ~BodyFile() override { std::filesystem::remove(path); }

  std::string refusal(const std::string& text) {
    std::ofstream(path) << text;
    try {
      read_body(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  // the file of a good body with one value replaced
  std::string refusal(const std::string& pointer, const nlohmann::json& value) {
    write_body(path, awkward());
    nlohmann::json file = nlohmann::json::parse(std::ifstream(path));
    file[nlohmann::json::json_pointer(pointer)] = value;
    return refusal(file.dump());
  }

  std::filesystem::path path;
};

void expect_same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  for (Eigen::Index k = 0; k < a.size(); ++k)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.data()[k]), std::bit_cast<std::uint64_t>(b.data()[k])) << a.data()[k];
}

}  // namespace

TEST_F(BodyFile, EveryBitSurvives) {
  const ReducedBody out = awkward();
  write_body(path, out);
  const ReducedBody in = read_body(path);
  EXPECT_EQ(in.name, out.name);
  EXPECT_EQ(in.kind, out.kind);
  EXPECT_EQ(in.parent, out.parent);
  expect_same_bits(in.reference, out.reference);
  expect_same_bits(in.omega, out.omega);
  expect_same_bits(in.zeta, out.zeta);
  expect_same_bits(in.C, out.C);
  expect_same_bits(in.L, out.L);
  expect_same_bits(in.D, out.D);
  ASSERT_EQ(in.ports.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(in.ports[k].name, out.ports[k].name);
    expect_same_bits(in.ports[k].position, out.ports[k].position);
    expect_same_bits(in.ports[k].axes, out.ports[k].axes);
    expect_same_bits(in.ports[k].Phi, out.ports[k].Phi);
  }
  expect_same_bits(in.node_positions[0], out.node_positions[0]);
  expect_same_bits(in.node_shapes, out.node_shapes);
  ASSERT_TRUE(in.shape_integrals && in.stiffening);
  const ShapeIntegrals &a = *in.shape_integrals, &b = *out.shape_integrals;
  expect_same_bits(a.J1, b.J1);
  expect_same_bits(a.J2, b.J2);
  expect_same_bits(a.C1, b.C1);
  expect_same_bits(a.nodes.J, b.nodes.J);
  expect_same_bits(a.nodes.C0, b.nodes.C0);
  expect_same_bits(a.nodes.A, b.nodes.A);
  expect_same_bits(a.nodes.T, b.nodes.T);
  expect_same_bits(a.nodes.B, b.nodes.B);
  expect_same_bits(a.nodes.U, b.nodes.U);
  expect_same_bits(in.stiffening->K, out.stiffening->K);
  expect_same_bits(in.stiffening->spin, out.stiffening->spin);
  EXPECT_EQ(in.certificate.basis, out.certificate.basis);
  EXPECT_EQ(in.certificate.source_hash, out.certificate.source_hash);
  EXPECT_EQ(in.certificate.elements, out.certificate.elements);
  EXPECT_EQ(in.certificate.modes_counted, out.certificate.modes_counted);
  EXPECT_EQ(in.certificate.left_out, out.certificate.left_out);
  EXPECT_EQ(in.certificate.count_shift, out.certificate.count_shift);
  EXPECT_EQ(in.certificate.valid_below, out.certificate.valid_below);
}

TEST_F(BodyFile, RefusesWithASentence) {
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("{\n\"format\": 3,\n  oops}"), HasSubstr(":3:"));
  EXPECT_THAT(refusal("[1, 2]"), HasSubstr("'format' is missing"));
  EXPECT_THAT(refusal("/version", 99), HasSubstr("'version' is 99; this program reads versions 2 to 3"));
  EXPECT_THAT(refusal("/shape_integrals/J2", {{1.0, 2.0}}), HasSubstr("'shape_integrals.J2' has 1 rows where 12 are"));
  EXPECT_THAT(refusal("/geometric_stiffness/K/0", {1.0}),
              HasSubstr("'geometric_stiffness.K[0]' has 1 numbers where 24"));
  EXPECT_THAT(refusal("/format", "something"), HasSubstr("not 'tenon reduced body'"));
  EXPECT_THAT(refusal("/units/length", "mm"), HasSubstr("'units.length' is 'mm'"));
  EXPECT_THAT(refusal("/zeta", {0.1}), HasSubstr("'zeta' has 1 numbers where 2 are expected"));
  EXPECT_THAT(refusal("/L/1/3", nullptr), HasSubstr("'L[1][3]' is not a finite number"));
  EXPECT_THAT(refusal("/ports/1/Phi", {{1.0, 2.0}}), HasSubstr("'ports[1].Phi' has 1 rows where 6 are expected"));
  EXPECT_THAT(refusal("/kind", "loose"), HasSubstr("'kind' is 'loose'"));
  EXPECT_THAT(refusal("/parent", 5), HasSubstr("parent port"));
  EXPECT_THAT(refusal("/omega_rad_s/0", -3.0), HasSubstr("negative"));
  // finite numbers whose products are not: no eigenvalue of D − LᵀL, and no pass either
  EXPECT_THAT(refusal("/L/0", nlohmann::json::array({1e200, 1e200, 1e200, 1e200, 1e200, 1e200})),
              HasSubstr("its modes carry more mass than it has"));
  EXPECT_THAT(refusal("/D/0/0", "heavy"), HasSubstr("'D[0][0]' is not a finite number"));
  EXPECT_THAT(refusal("/certificate/left_out", 1), HasSubstr("'certificate.left_out' is not a list"));
}

TEST_F(BodyFile, AFileOfVersionTwoIsABodyWithoutLargeMotion) {
  write_body(path, awkward());
  nlohmann::json file = nlohmann::json::parse(std::ifstream(path));
  file["version"] = 2;
  file.erase("shape_integrals");
  file.erase("geometric_stiffness");
  std::ofstream(path) << file.dump();
  const ReducedBody body = read_body(path);
  expect_same_bits(body.L, awkward().L);
  EXPECT_FALSE(body.shape_integrals || body.stiffening);
}

TEST_F(BodyFile, ABodyWithoutLargeMotionReadsBackWithout) {
  ReducedBody body = awkward();
  body.shape_integrals.reset();
  body.stiffening.reset();
  write_body(path, body);
  const ReducedBody in = read_body(path);
  EXPECT_FALSE(in.shape_integrals || in.stiffening);
}

TEST_F(BodyFile, RefusesAMissingFileAndWritesNoBrokenOne) {
  EXPECT_THROW(read_body(path.string() + ".none"), InputError);
  ReducedBody bad = awkward();
  bad.omega[0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_body(path, bad), ModelError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(BodyFile, HashIsFnv1a) {
  // published test vectors of the 64-bit FNV-1a hash
  std::ofstream(path, std::ios::binary) << "";
  EXPECT_EQ(file_hash(path), "fnv1a64:cbf29ce484222325");
  std::ofstream(path, std::ios::binary) << "a";
  EXPECT_EQ(file_hash(path), "fnv1a64:af63dc4c8601ec8c");
  std::ofstream(path, std::ios::binary) << "foobar";
  EXPECT_EQ(file_hash(path), "fnv1a64:85944171f73967e8");
}
