// Scenes written in mm-t-s and in m-kg-s are the same systems: frequencies to 1e-12.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/build.hpp"
#include "assembly/second_order.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using namespace tenon::assembly;

namespace {

/// Numbers of a scene in one of two unit systems.
struct UnitSystem {
  const char* name;
  double length, mass;  // of one metre and one kilogram

  std::string l(double x) const { return number(x * length); }
  std::string area(double x) const { return number(x * length * length); }
  std::string l4(double x) const { return number(x * length * length * length * length); }
  std::string kg(double x) const { return number(x * mass); }
  std::string inertia(double x) const { return number(x * mass * length * length); }  // and N m
  std::string pressure(double x) const { return number(x * mass / length); }
  std::string density(double x) const { return number(x * mass / (length * length * length)); }
  static std::string number(double x) { return fmt::format("{:.15g}", x); }  // as people write: 279.4
};
constexpr UnitSystem metre{"SI", 1.0, 1.0};
constexpr UnitSystem millimetre{"{length: mm, mass: t, time: s}", 1e3, 1e-3};
constexpr UnitSystem undeclared{"SI", 1e3, 1e-3};  // consistent all the same: frequencies know nothing of it

std::string material(const UnitSystem& u, double E, double rho) {
  return fmt::format("{{E: {}, nu: 0.33, rho: {}}}", u.pressure(E), u.density(rho));
}

std::string beam(const UnitSystem& u, double length, const std::string& section, const std::string& options) {
  return fmt::format("{{from: [0, 0, 0], to: [{}, 0, 0], section: {}, material: alloy{}}}", u.l(length), section,
                     options);
}

// A cantilever with a tip mass, by finite elements and by both analytic models.
std::string cantilever(const UnitSystem& u, const std::string& options) {
  return fmt::format(
      "units: {}\nmaterials: {{alloy: {}}}\nbodies:\n  b: {{beam: {}}}\nmasses: {{m: {{at: b.C, mass: {}}}}}\n"
      "ground: [b.P]\n",
      u.name, material(u, 70e9, 2700.0),
      beam(u, 1.3, fmt::format("{{rectangle: [{}, {}], orientation: [0, 1, 0]}}", u.l(0.02), u.l(0.05)), options),
      u.kg(0.7));
}

// Spacecraft, sprung joint, boom, antenna: Fig. 4 of the TITOP paper.
std::string chain(const UnitSystem& u, const std::string& options) {
  return fmt::format(
      "units: {}\nmaterials: {{alloy: {}}}\nbodies:\n"
      "  craft: {{rigid: {{mass: {}, inertia: [{}, {}, {}]}}, ports: {{p: [{}, 0, 0]}}}}\n"
      "  boom: {{beam: {}}}\n"
      "  antenna: {{rigid: {{mass: {}, inertia: [{}, {}, {}], com: [{}, 0, 0]}}, ports: {{p: [0, 0, 0]}}}}\n"
      "joints:\n"
      "  drive: {{parent: craft.p, child: boom.P, revolute: z, angle: 25 deg, stiffness: {}, inertia: {}}}\n"
      "  tip: {{parent: boom.C, child: antenna.p, weld: true}}\n",
      u.name, material(u, 70e9, 2700.0), u.kg(120), u.inertia(30), u.inertia(25), u.inertia(40), u.l(0.6),
      beam(u, 3.0, fmt::format("{{tube: [{}, {}]}}", u.l(0.04), u.l(0.037)), options), u.kg(8), u.inertia(1),
      u.inertia(2), u.inertia(2.5), u.l(0.3), u.inertia(5000), u.inertia(0.2));
}

// The four-bar mechanism of the TITOP paper, section 4.
std::string four_bar(const UnitSystem& u, const std::string& model) {
  const auto link = [&](double length, double A, double I) {
    return beam(
        u, length,
        fmt::format("{{general: {{A: {}, Iy: {}, Iz: {}, J: {}}}, shear: euler-bernoulli, orientation: [0, 1, 0]}}",
                    u.area(A), u.l4(6 * I), u.l4(I), u.l4(I)),
        fmt::format(", plane: xy, model: {}", model));
  };
  constexpr double thin = 8.676056338028169e-12;
  return fmt::format(
      "units: {}\nmaterials: {{alloy: {}}}\nbodies:\n"
      "  frame: {{rigid: {{mass: {}, inertia: [{}, {}, {}]}}, ports: {{base: [0, 0, 0], a: [0, 0, 0], b: [{}, 0, "
      "0]}}}}\n"
      "  crank: {{beam: {}}}\n  coupler: {{beam: {}}}\n  follower: {{beam: {}}}\n"
      "joints:\n"
      "  drive: {{parent: frame.a, child: crank.P, revolute: z, angle: 40 deg}}\n"
      "  a: {{parent: crank.C, child: coupler.P, revolute: z, near: 20 deg}}\n"
      "  b: {{parent: coupler.C, child: follower.P, revolute: z, near: -120 deg}}\n"
      "  c: {{parent: follower.C, child: frame.b, revolute: z, near: 60 deg}}\n"
      "masses: {{m1: {{at: crank.C, mass: {}}}, m2: {{at: coupler.C, mass: {}}}}}\nground: [frame.base]\n",
      u.name, material(u, 7.1e10, 2714.0), u.kg(1), u.inertia(1), u.inertia(1), u.inertia(1), u.l(0.254),
      link(0.108, 1.0774e-4, 1.6157746478873239e-10), link(0.2794, 4.0645e-5, thin), link(0.2705, 4.0645e-5, thin),
      u.kg(0.042), u.kg(0.042));
}

struct Solved {
  SystemModes modes;
  double lowest;  // frequency of any body, clamped at its parent port
};
Solved solve(const std::string& text) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("scene.yaml", text));
  const Network network = build_network(scene, plan(scene));
  double lowest = INFINITY;
  for (const ReducedBody& body : network.bodies)
    if (body.n() > 0) lowest = std::min(lowest, body.omega[0]);
  return {modes(second_order(network)), lowest};
}

}  // namespace

// To 1e-12 where the scene declares its units: its lengths are then read as those of the other. Without, finite
// elements as far as their K holds digits: rounded at 12EI/h³, it moves the first mode of n elements by ε (n/βl)⁴,
// 7e-14 for 8 and 2e-11 for 32 (four such beams in the four-bar).
TEST(Units, MillimetresAndTonnesAreMetresAndKilograms) {
  struct Case {
    const char* name;
    double undeclared_limit;
    std::string (*text)(const UnitSystem&);
  };
  const Case all[] = {
      {"cantilever, quintic", 1e-12, [](const UnitSystem& u) { return cantilever(u, ", model: titop-polynomial"); }},
      {"cantilever, clamped-free modes", 1e-12,
       [](const UnitSystem& u) { return cantilever(u, ", model: titop-clamped-free, modes: 12"); }},
      {"chain, quintic", 1e-12, [](const UnitSystem& u) { return chain(u, ", model: titop-polynomial"); }},
      {"four-bar, quintic", 1e-12, [](const UnitSystem& u) { return four_bar(u, "titop-polynomial"); }},
      {"cantilever, 8 elements", 1e-12, [](const UnitSystem& u) { return cantilever(u, ", elements: 8"); }},
      {"chain, 8 elements", 1e-12, [](const UnitSystem& u) { return chain(u, ", elements: 8"); }},
      {"four-bar, 8 elements", 1e-12, [](const UnitSystem& u) { return four_bar(u, "fe, elements: 8"); }},
      {"cantilever, 32 elements", 1e-10, [](const UnitSystem& u) { return cantilever(u, ""); }},
      {"chain, 32 elements", 1e-10, [](const UnitSystem& u) { return chain(u, ""); }},
      {"four-bar, 32 elements", 1e-10, [](const UnitSystem& u) { return four_bar(u, "fe"); }}};
  for (const auto& [name, undeclared_limit, text] : all)
    for (const UnitSystem& other : {millimetre, undeclared}) {
      const double limit = std::string(other.name) == "SI" ? undeclared_limit : 1e-12;
      const auto [a, lowest] = solve(text(metre));
      const SystemModes b = solve(text(other)).modes;
      ASSERT_EQ(a.rigid, b.rigid) << name;
      ASSERT_EQ(a.omega.size(), b.omega.size()) << name;
      double worst = 0.0, low = 0.0;
      for (Eigen::Index i = a.rigid; i < a.omega.size(); ++i) {
        const double apart = std::abs(b.omega[i] / a.omega[i] - 1.0);
        worst = std::max(worst, apart);
        if (i < a.rigid + 5) low = worst;
        EXPECT_LT(apart, limit + 4.0 * 2.2e-16 * std::pow(a.omega[i] / lowest, 2)) << name << i;
      }
      fmt::print("{}, {}: first five frequencies {:.1e} apart, all {} {:.1e}\n", name,
                 std::string(other.name) == "SI" ? "undeclared" : "declared", low, a.omega.size() - a.rigid, worst);
      EXPECT_LT(low, limit) << name;
    }
}
