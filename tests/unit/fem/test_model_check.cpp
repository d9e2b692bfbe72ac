#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "fem/checks/cells.hpp"
#include "fem/error.hpp"
#include "fem/model_check.hpp"
#include "fem/structure.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::HasSubstr;

namespace {

/// A plate of n×n quads on the unit square, steel; node and element numbers of the file begin at 1001 and 1.
Model plate(int n) {
  Model model;
  model.source = "plate";
  model.materials.push_back({"steel", 2.1e11, 2.1e11 / 2.6, 0.3, 7800.0});
  model.shell_sections.push_back({.name = "skin", .thickness = 0.01});
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      model.node_ids.push_back(1001 + static_cast<long>(model.nodes.size()));
      model.nodes.emplace_back(double(i) / n, double(j) / n, 0.0);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      model.elements.push_back(
          Quad4{.nodes = {a, a + 1, a + n + 2, a + n + 1}, .id = static_cast<long>(model.elements.size()) + 1});
    }
  return model;
}

Quad4& quad(Model& model, int k) { return std::get<Quad4>(model.elements[static_cast<std::size_t>(k)]); }

const Finding* found(const std::vector<Finding>& findings, const std::string& check) {
  for (const Finding& finding : findings)
    if (finding.check == check) return &finding;
  return nullptr;
}

/// One quad (or triangle) alone, in its own numbers: what its shape is said to be.
std::vector<Finding> shape(const std::vector<Vec3>& x) {
  Model model = plate(1);
  model.nodes = x;
  model.node_ids.resize(x.size());
  if (x.size() == 3) model.elements = {Tria3{.nodes = {0, 1, 2}, .id = 7}};
  if (x.size() == 4) model.elements = {Quad4{.nodes = {0, 1, 2, 3}, .id = 7}};
  return check_geometry(model);
}

}  // namespace

TEST(ModelCheck, ASoundPlateHasNotesOnly) {
  const std::vector<Finding> findings = check_model(plate(4));
  for (const Finding& finding : findings) EXPECT_EQ(finding.severity, Severity::note) << finding.what;
  ASSERT_TRUE(found(findings, "free_edges"));
  EXPECT_EQ(found(findings, "free_edges")->count, 16);
  ASSERT_TRUE(found(findings, "grounding"));
  EXPECT_LT(found(findings, "grounding")->value, 1e-12);
  EXPECT_LT(found(findings, "mass")->value, 1e-13);
}

TEST(ModelCheck, ASpringToGroundIsNamed) {
  Model model = plate(4);
  model.elements.push_back(Spring{.node_a = 7, .dof_a = 1, .k = 4e4, .id = 99});
  const Finding* grounding = nullptr;
  const std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(grounding = found(findings, "grounding"));
  EXPECT_EQ(grounding->severity, Severity::error);
  EXPECT_EQ(grounding->count, 1);
  // the force that holds it during a unit translation is k itself
  EXPECT_THAT(grounding->where.front(), HasSubstr("node 1008 uy (4e+04 per unit translation y)"));
}

TEST(ModelCheck, ASpringBetweenDistantNodesLoadsRotations) {
  Model model = plate(4);  // both ends along y, 1 m apart in x: k turned about z leaves the couple k·1
  model.elements.push_back(Spring{.node_a = 0, .dof_a = 1, .node_b = 4, .dof_b = 1, .k = 1e6, .id = 99});
  const std::vector<Finding> findings = check_model(model);
  ASSERT_EQ(found(findings, "grounding")->severity, Severity::error);
  EXPECT_THAT(found(findings, "grounding")->where.front(), HasSubstr("rotation z"));
  model.elements.back() = Spring{.node_a = 0, .dof_a = 0, .node_b = 4, .dof_b = 0, .k = 1e6, .id = 99};
  EXPECT_EQ(found(check_model(model), "grounding")->severity, Severity::note);  // along the line: no couple
}

TEST(ModelCheck, SingularDofsAreNamedByNodeAndDirection) {
  Model model = plate(2);
  model.elements.clear();
  model.elements.push_back(Spring{.node_a = 0, .dof_a = 0, .node_b = 1, .dof_b = 0, .k = 5.0, .id = 1});
  for (int node : {0, 1}) model.elements.push_back(PointMass{.node = node, .mass = 2.0, .id = 5 + node});
  const std::vector<Finding> findings = check_model(model);
  const Finding* singular = found(findings, "singular_dofs");
  ASSERT_TRUE(singular);
  EXPECT_EQ(singular->count, 4);  // uy and uz of both; rotations have no mass and are dropped
  EXPECT_THAT(singular->where, testing::Contains("node 1001 uy"));
  EXPECT_THAT(singular->where, testing::Contains("node 1002 uz"));
  EXPECT_EQ(singular->value, 0.0);
}

TEST(ModelCheck, ASkewSingularDirectionIsGivenByItsComponents) {
  Model model = plate(1);
  model.elements.clear();
  for (int node : {0, 1}) model.elements.push_back(PointMass{.node = node, .mass = 1.0, .id = node});
  // stiffness in x − y alone, through an equation for a spring's second end
  model.constraints.push_back({{{{2, 0}, 1.0}, {{0, 0}, -1.0}, {{0, 1}, 1.0}}, 3});
  model.elements.push_back(Spring{.node_a = 2, .dof_a = 0, .k = 1.0, .id = 9});
  model.elements.push_back(Spring{.node_a = 0, .dof_a = 2, .k = 1.0, .id = 10});
  const std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(found(findings, "singular_dofs"));
  EXPECT_THAT(found(findings, "singular_dofs")->where,
              testing::Contains(testing::MatchesRegex("node 1001 translation along .-?0.707, -?0.707, -?0.*")));
}

TEST(ModelCheck, PartsAreNamedWithTheirSizes) {
  Model model = plate(3);
  quad(model, 8).nodes = {16, 17, 18, 19};  // the last one on nodes of its own, at its old place
  for (int i : {10, 11, 15, 14}) {
    model.nodes.push_back(model.nodes[static_cast<std::size_t>(i)]);
    model.node_ids.push_back(2000 + i);
  }
  std::vector<Finding> findings = check_geometry(model);
  ASSERT_TRUE(found(findings, "parts"));
  EXPECT_EQ(found(findings, "parts")->severity, Severity::error);
  EXPECT_THAT(found(findings, "parts")->where, testing::ElementsAre("node 1001 (15 nodes)", "node 2010 (4 nodes)"));
  ASSERT_TRUE(found(findings, "coincident_nodes"));
  EXPECT_EQ(found(findings, "coincident_nodes")->count, 3);  // node 16 itself is free now
  EXPECT_EQ(found(findings, "free_nodes")->where, std::vector<std::string>{"node 1016"});
  ASSERT_TRUE(found(findings, "open_seams"));
  EXPECT_EQ(found(findings, "open_seams")->count, 2);
  model.rigid_links.push_back({10, {16}, all_six, Mat3::Identity(), 1});
  findings = check_geometry(model);
  EXPECT_FALSE(found(findings, "parts"));
  EXPECT_EQ(found(findings, "coincident_tied_nodes")->count, 1);
}

TEST(ModelCheck, DuplicatesWithAndWithoutTheSameProperties) {
  Model model = plate(2);
  Quad4 copy = quad(model, 1);
  copy.id = 50;
  std::rotate(copy.nodes.begin(), copy.nodes.begin() + 1, copy.nodes.end());
  model.elements.push_back(copy);
  std::vector<Finding> findings = check_geometry(model);
  ASSERT_TRUE(found(findings, "duplicate_elements"));
  EXPECT_EQ(found(findings, "duplicate_elements")->where, std::vector<std::string>{"elements 2 and 50"});
  std::get<Quad4>(model.elements.back()).section = 1;
  findings = check_geometry(model);
  EXPECT_FALSE(found(findings, "duplicate_elements"));
  EXPECT_TRUE(found(findings, "elements_on_same_nodes"));
}

// z = x y / 2 in warped quads, of which each is as large as its mean plane: half the product of its diagonals.
TEST(ModelCheck, WarpedQuadsKeepTheirMass) {
  Model model = plate(6);
  for (Vec3& x : model.nodes) x.z() = 0.5 * x.x() * x.y();
  double area = 0.0;
  for (const Element& element : model.elements) {
    const auto& n = std::get<Quad4>(element).nodes;
    const auto at = [&](std::size_t i) { return model.nodes[static_cast<std::size_t>(n[i])]; };
    area += 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
  }
  EXPECT_NEAR(geometric_mass_properties(model).mass, 7800.0 * 0.01 * area, 1e-12 * area * 78.0);
  for (const Finding& finding : check_model(model)) EXPECT_EQ(finding.severity, Severity::note) << finding.what;
}

TEST(ModelCheck, NormalsAndJunctions) {
  Model model = plate(2);
  std::reverse(quad(model, 3).nodes.begin(), quad(model, 3).nodes.end());
  const std::vector<Finding> turned = check_geometry(model);
  ASSERT_TRUE(found(turned, "normals"));
  EXPECT_EQ(found(turned, "normals")->count, 2);
  EXPECT_THAT(found(turned, "normals")->where, testing::Contains("elements 2 and 4"));
  model = plate(2);
  model.nodes.emplace_back(0.5, 0.5, 1.0);
  model.node_ids.push_back(9);
  model.elements.push_back(Tria3{.nodes = {4, 5, 9}, .id = 77});  // a fin on an inner edge
  EXPECT_EQ(found(check_geometry(model), "junctions")->count, 1);
}

TEST(ModelCheck, ShapesHaveTheFiguresOfTheirDefinitions) {
  // a parallelogram with 20°: skew and interior angles are 20° and 160°
  const double c = std::cos(M_PI / 9), s = std::sin(M_PI / 9);
  std::vector<Finding> f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1 + c, s, 0), Vec3(c, s, 0)});
  EXPECT_NEAR(found(f, "skew_quad")->value, 20.0, 1e-12);
  EXPECT_NEAR(found(f, "angle_min")->value, 20.0, 1e-12);
  EXPECT_NEAR(found(f, "angle_max")->value, 160.0, 1e-12);
  EXPECT_FALSE(found(f, "taper"));
  EXPECT_EQ(found(f, "angle_min")->where.front(), "element 7 (20°)");
  // the unit square with corners ±h off its plane: diagonals √2, warp h/√2
  f = shape({Vec3(0, 0, 0.1), Vec3(1, 0, -0.1), Vec3(1, 1, 0.1), Vec3(0, 1, -0.1)});
  EXPECT_NEAR(found(f, "warp")->value, 0.1 / std::sqrt(2.0), 1e-15);
  // a trapezoid with sides 1 and b: corner triangles h/2 and bh/2 of the area (1+b)h/2
  const double b = 0.2;
  f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5 + b / 2, 1, 0), Vec3(0.5 - b / 2, 1, 0)});
  EXPECT_NEAR(found(f, "taper")->value, 2.0 / (1.0 + b) - 1.0, 1e-15);
  EXPECT_FALSE(found(f, "jacobian"));  // b itself: above 0.1
  f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.52, 1, 0), Vec3(0.48, 1, 0)});
  EXPECT_NEAR(found(f, "jacobian")->value, 0.04, 1e-15);
  f = shape({Vec3(0, 0, 0), Vec3(20, 0, 0), Vec3(20, 1, 0), Vec3(0, 1, 0)});
  EXPECT_NEAR(found(f, "aspect")->value, 20.0, 1e-12);
  // triangles: equilateral is 1; one of base 1 and height h ≪ 1 is √3/2 / h
  EXPECT_FALSE(found(shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, std::sqrt(0.75), 0)}), "aspect"));
  f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.01, 0)});
  EXPECT_NEAR(found(f, "aspect")->value, std::sqrt(0.75) / 0.01, 1e-10);
  EXPECT_NEAR(found(f, "angle_max_triangle")->value, 180.0 - 2.0 * std::atan(0.02) * 180.0 / M_PI, 1e-10);
  EXPECT_NEAR(found(f, "skew_triangle")->value, std::atan(0.02) * 180.0 / M_PI, 1e-10);
}

TEST(ModelCheck, FaultyElementsAreErrorsAndStopTheMatrices) {
  std::vector<Finding> f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)});  // a bow tie
  EXPECT_TRUE(found(f, "no_area"));
  f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.2, 0.2, 0), Vec3(0, 1, 0)});  // an arrow head
  ASSERT_TRUE(found(f, "inverted"));
  EXPECT_LT(found(f, "inverted")->value, 0.0);
  f = shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)});
  EXPECT_EQ(found(f, "no_area")->where.front(), "element 7");
  // on either side of what the elements take
  EXPECT_TRUE(found(shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.5 - 1e-9, 0), Vec3(0, 1, 0)}), "inverted"));
  EXPECT_FALSE(found(shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.5 + 1e-6, 0), Vec3(0, 1, 0)}), "inverted"));
  EXPECT_TRUE(found(shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1e-10, 0)}), "no_area"));
  EXPECT_FALSE(found(shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 2e-10, 0)}), "no_area"));
  Model model = plate(2);
  std::swap(quad(model, 0).nodes[1], quad(model, 0).nodes[2]);
  const std::vector<Finding> findings = check_model(model);
  EXPECT_TRUE(has_error(findings));
  EXPECT_FALSE(found(findings, "mass"));
}

TEST(ModelCheck, MassLostToAScalarPointOrADirection) {
  Model model = plate(2);
  model.elements.push_back(PointMass{.node = 0, .mass = 3.0, .id = 8});
  model.constraints.push_back({{{{0, 0}, 1.0}}, 5});  // ux of node 1001 is held: its mass is missing in x
  const std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(found(findings, "mass_by_direction"));
  EXPECT_THAT(found(findings, "mass_by_direction")->what, HasSubstr(" in x, 81 in y, 81 in z"));
  ASSERT_TRUE(found(findings, "constraints_hold"));
  EXPECT_EQ(found(findings, "constraints_hold")->where.front(), "linear constraint 5 (node 1001 ux)");
  EXPECT_EQ(found(findings, "grounding")->severity, Severity::error);
}

TEST(ModelCheck, ConstraintsThatSayTheSameContradictOrNearlyRepeat) {
  Model model = plate(2);
  const auto equation = [](int a, double ca, int b, double cb, long id) {
    return LinearConstraint{{{{a, 0}, ca}, {{b, 0}, cb}}, id};
  };
  model.constraints = {equation(0, 1, 1, -1, 11), equation(1, 1, 0, -1, 12)};  // a cycle that repeats itself
  std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(found(findings, "redundant_constraints"));
  EXPECT_EQ(found(findings, "redundant_constraints")->where.front(), "node 1002 ux of linear constraint 12");
  EXPECT_FALSE(found(findings, "over_constrained"));

  model.constraints = {equation(0, 1, 1, -1, 11), equation(1, 1, 0, -2, 12)};  // a cycle that leaves nothing but zero
  findings = check_model(model);
  ASSERT_TRUE(found(findings, "over_constrained"));
  EXPECT_EQ(found(findings, "over_constrained")->where.front(), "node 1002 ux of linear constraint 12");

  model.constraints = {equation(0, 1, 1, -1, 11), equation(0, 1, 2, -1, 12)};  // dependent twice: both hold
  findings = check_model(model);
  ASSERT_TRUE(found(findings, "dependent_twice"));
  EXPECT_EQ(found(findings, "dependent_twice")->where.front(),
            "node 1001 ux of linear constraint 12, dependent already by linear constraint 11");
  EXPECT_FALSE(found(findings, "over_constrained"));

  model.constraints = {equation(0, 1, 1, -1, 11), equation(0, 1, 1, -1.0000003, 12)};
  findings = check_model(model);
  ASSERT_TRUE(found(findings, "constraints_ill_determined"));
  EXPECT_NEAR(found(findings, "constraints_ill_determined")->value, 3e-7, 1e-13);
  EXPECT_TRUE(has_error(findings));
}

TEST(ModelCheck, ADependentOfAHeldNodeIsNoContradiction) {
  Model model = plate(1);
  for (int d = 0; d < 6; ++d) model.supports.push_back({{0, d}});
  model.rigid_links.push_back({0, {1}, all_six, Mat3::Identity(), 4});
  EXPECT_TRUE(assemble(model).dofs.notes.empty());
}

TEST(ModelCheck, ARingOfRigidLinksIsRedundantByNameAndNode) {
  Model model = plate(1);
  for (int i = 0; i < 4; ++i) model.rigid_links.push_back({i, {(i + 1) % 4}, all_six, Mat3::Identity(), 20 + i});
  model.elements.push_back(PointMass{.node = 0, .mass = 1.0, .id = 6});
  const std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(found(findings, "redundant_constraints"));
  EXPECT_EQ(found(findings, "redundant_constraints")->count, 6);
  EXPECT_THAT(found(findings, "redundant_constraints")->where.front(), HasSubstr("node 1001 ux of rigid link 23"));
}

TEST(ModelCheck, TwoRigidLinksWithOneDependentAndALinkThatContradicts) {
  Model model = plate(2);
  model.rigid_links = {{0, {1}, all_six, Mat3::Identity(), 31}, {2, {1}, all_six, Mat3::Identity(), 32}};
  std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(found(findings, "dependent_twice"));
  EXPECT_EQ(found(findings, "dependent_twice")->count, 6);
  EXPECT_THAT(found(findings, "dependent_twice")->where,
              testing::Contains("node 1002 ux of rigid link 32, dependent already by rigid link 31"));
  EXPECT_FALSE(found(findings, "over_constrained"));

  model.rigid_links.resize(1);  // it turns node 1002 with 1001; the equation wants it to turn twice as far
  model.constraints = {{{{{1, 5}, 1.0}, {{0, 5}, -2.0}}, 33}};
  findings = check_model(model);
  ASSERT_TRUE(found(findings, "over_constrained"));
  EXPECT_EQ(found(findings, "over_constrained")->where.front(), "node 1001 rz of linear constraint 33");
}

TEST(ModelCheck, SupportsOnDependentDofsAreNamedWithTheirLink) {
  Model model = plate(2);
  model.rigid_links = {{0, {1, 2}, 0b000111, Mat3::Identity(), 31}};
  model.constraints = {{{{{5, 2}, 1.0}, {{4, 2}, -1.0}}, 33}};
  model.supports = {{{0, 0}}, {{1, 1}}, {{1, 4}}, {{5, 2}}};
  const std::vector<Finding> findings = check_model(model);
  const Finding* const held = found(findings, "held_dependents");
  ASSERT_TRUE(held);
  EXPECT_THAT(held->where,
              testing::ElementsAre("node 1002 uy of rigid link 31", "node 1006 uz of linear constraint 33"));
}

TEST(ModelCheck, InertiasOfNoBodyAreNamed) {
  Model model = plate(2);
  model.elements.emplace_back(
      PointMass{.node = 3, .mass = 2.0, .inertia = Vec3(1.0, 1.0, 2.01).asDiagonal(), .id = 70});
  EXPECT_FALSE(found(check_model(model), "impossible_inertia"));  // flat, to two digits
  model.elements.emplace_back(PointMass{.node = 4, .mass = 2.0, .inertia = Vec3(1.0, 5.0, 1.0).asDiagonal(), .id = 71});
  const std::vector<Finding> findings = check_model(model);
  ASSERT_TRUE(found(findings, "impossible_inertia"));
  EXPECT_THAT(found(findings, "impossible_inertia")->where,
              testing::ElementsAre("point mass 71 at node 1005 (1, 1, 5)"));
  EXPECT_NEAR(found(findings, "impossible_inertia")->value, 2.5, 1e-12);
}

TEST(ModelCheck, CoincidentPairsAreThoseOfAllAgainstAll) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, 9);
  std::vector<Vec3> x;
  for (int i = 0; i < 400; ++i) x.emplace_back(place(random), place(random), place(random));
  // as clusters: nodes less clusters = pairs
  std::vector<std::array<int, 3>> distinct;
  for (const Vec3& p : x) distinct.push_back({int(p.x()), int(p.y()), int(p.z())});
  std::sort(distinct.begin(), distinct.end());
  const auto last = std::unique(distinct.begin(), distinct.end());
  EXPECT_EQ(checks::coincident_pairs(x, 1e-9).size(), x.size() - static_cast<std::size_t>(last - distinct.begin()));
  EXPECT_EQ(checks::coincident_pairs(std::vector<Vec3>(100000, Vec3::Ones()), 1e-6).size(), 99999U);
}

// A quarter of a cylinder, R = 1, 16 cells around and 16 along 1 m, each of h² = π/2 / 256 and leaning by 45°: h²/(R t)
// is 0.6 for t = .01 and 60 for 1e-4.
TEST(ModelCheck, SkewShellsTooLargeForTheirCurvature) {
  const auto cylinder = [](double t, double lean, bool triangles) {
    Model model = plate(16);
    model.shell_sections[0].thickness = t;
    for (Vec3& x : model.nodes) {
      const double angle = 0.5 * std::numbers::pi * x.x();
      x = Vec3(std::cos(angle), x.y() + lean * angle, std::sin(angle));
    }
    if (!triangles) return model;
    std::vector<Element> halves;
    for (const Element& element : model.elements) {
      const auto& q = std::get<Quad4>(element);
      halves.push_back(Tria3{.nodes = {q.nodes[0], q.nodes[1], q.nodes[3]}, .id = q.id});
      halves.push_back(Tria3{.nodes = {q.nodes[1], q.nodes[2], q.nodes[3]}, .id = q.id + 256});
    }
    model.elements = halves;
    return model;
  };
  constexpr double angle = std::numbers::pi / 32.0;
  const double chord = 2.0 * std::sin(0.5 * angle);
  for (const bool triangles : {false, true}) {
    const std::vector<Finding> findings = check_geometry(cylinder(1e-4, triangles ? -1.0 : 1.0, triangles));
    const Finding* const finding = found(findings, "curvature");
    ASSERT_NE(finding, nullptr);
    EXPECT_EQ(finding->count, triangles ? 512 : 256);
    Model turned = cylinder(1e-4, triangles ? -1.0 : 1.0, triangles);  // their normals, of every other column
    for (std::size_t e = 0; e < turned.elements.size(); ++e) {
      const auto turn = [](auto& shell) {
        if constexpr (requires { shell.material_axis; }) std::reverse(shell.nodes.begin(), shell.nodes.end());
      };
      if (e / (triangles ? 2 : 1) % 2 == 1) std::visit(turn, turned.elements[e]);
    }
    const std::vector<Finding> in_both_senses = check_geometry(turned);
    ASSERT_NE(found(in_both_senses, "curvature"), nullptr);
    EXPECT_EQ(found(in_both_senses, "curvature")->count, finding->count);
    EXPECT_NEAR(found(in_both_senses, "curvature")->value, finding->value, 1e-9 * finding->value);
    const double apart = std::hypot(chord, triangles ? angle : angle - 1.0 / 16.0);  // the nearest that turn
    const double area = (triangles ? 0.5 : 1.0) * chord / 16.0;
    EXPECT_NEAR(finding->value, area * std::sin(angle) / apart / 1e-4, 0.02 * finding->value);  // normals: O(h²)
    EXPECT_EQ(found(check_geometry(cylinder(1e-2, triangles ? -1.0 : 1.0, triangles)), "curvature"), nullptr);
    EXPECT_EQ(found(check_geometry(cylinder(1e-4, 0.0, triangles)), "curvature"), nullptr) << "lines along and across";
  }
  Model leaning = plate(4);  // flat, however thin and skew
  leaning.shell_sections[0].thickness = 1e-9;
  for (Vec3& x : leaning.nodes) x.x() += x.y();
  EXPECT_EQ(found(check_geometry(leaning), "curvature"), nullptr);
}

TEST(ModelCheck, FortyThousandQuadsTakeLessThanASecond) {
  const Model model = plate(200);
  const auto seconds = [](const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::vector<Finding> geometry, matrices;
  const double geometric = seconds([&] { geometry = check_geometry(model); });
  const Structure structure = assemble(model);
  const double matrix = seconds([&] { matrices = check_matrices(model, structure); });
  RecordProperty("geometry_ms", static_cast<int>(1e3 * geometric));
  RecordProperty("matrices_ms", static_cast<int>(1e3 * matrix));
  EXPECT_EQ(found(geometry, "free_edges")->count, 800);
  EXPECT_FALSE(has_error(geometry) || has_error(matrices));
#if defined(__SANITIZE_ADDRESS__)
  constexpr double limit = 20.0;  // a build that checks every access
#else
  constexpr double limit = 1.0;
#endif
  EXPECT_LT(geometric, limit);
  EXPECT_LT(matrix, limit);
}
