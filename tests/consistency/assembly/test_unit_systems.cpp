// One spacecraft wing of shells, beams, masses and a sprung hinge, written in SI, mm-t-s, inch-lbf and inch-lbf-lbm, as
// mesh with scene and as Nastran deck (with WTMASS too): the same physical results to 1e-12.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/build.hpp"
#include "assembly/second_order.hpp"
#include "tests/support/temporary_folder.hpp"
#include "titop/port_model.hpp"

using namespace tenon;
using namespace tenon::assembly;

namespace {

constexpr double inch = 0.0254, pound = 0.45359237, pound_force = pound * 9.80665;

/// How a person would write the numbers of the wing: units of a metre, a kilogram and a newton.
struct UnitSystem {
  const char* name;
  double length, mass, force;
  double wtmass = 1.0;  ///< of a deck whose masses are not force · time² / length

  static std::string number(double x) { return fmt::format("{:.17g}", x); }
  std::string l(double x, int power = 1) const { return number(x * std::pow(length, power)); }
  std::string kg(double x) const { return number(x * mass); }
  std::string inertia(double x) const { return number(x * mass * length * length); }
  std::string torque(double x) const { return number(x * force * length); }
  std::string pressure(double x) const { return number(x * force / (length * length)); }
  std::string density(double x) const { return number(x * mass / std::pow(length, 3)); }
};
constexpr UnitSystem si{"SI", 1.0, 1.0, 1.0}, millimetre{"mm-t-s", 1e3, 1e-3, 1.0},
    inch_lbf{"inch-lbf", 1.0 / inch, inch / pound_force, 1.0 / pound_force},
    inch_lbf_lbm{"inch-lbf-lbm", 1.0 / inch, 1.0 / pound, 1.0 / pound_force},
    inch_wtmass{"inch-lbf", 1.0 / inch, 1.0 / pound, 1.0 / pound_force, pound*inch / pound_force};

constexpr int along = 3, across = 2, boom = 2;
constexpr double a = 1.2, b = 0.6, reach = 0.6;
/// Stout on purpose: rounded numbers move the lowest frequencies by ε times (length of all over thickness)² and the
/// fourth power of the elements a wavelength, which a thin wing on a fine mesh brings to 1e-10 whatever its units.
constexpr double thickness = 0.05, side_y = 0.08, side_z = 0.1;
int grid(int i, int j) { return 1 + j * (along + 1) + i; }
constexpr int first_of_boom = 1 + (along + 1) * (across + 1);

/// Node number and place [m] of all nodes: a plate a × b, and a boom in its middle line.
std::vector<std::pair<int, fem::Vec3>> nodes() {
  std::vector<std::pair<int, fem::Vec3>> list;
  for (int j = 0; j <= across; ++j)
    for (int i = 0; i <= along; ++i) list.push_back({grid(i, j), {a * i / along, b * j / across, 0.0}});
  for (int k = 0; k < boom; ++k)
    list.push_back({first_of_boom + k, {a + reach * (k + 1) / boom, b / 2, 0.1 * (k + 1)}});
  return list;
}
int boom_node(int k) { return k == 0 ? grid(along, across / 2) : first_of_boom + k - 1; }

std::string mesh(const UnitSystem& u) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n0 3 \"root\"\n1 2 \"boom\"\n2 1 \"skin\"\n"
      "$EndPhysicalNames\n$Nodes\n";
  text += fmt::format("{}\n", nodes().size());
  for (const auto& [id, x] : nodes()) text += fmt::format("{} {} {} {}\n", id, u.l(x.x()), u.l(x.y()), u.l(x.z()));
  text += fmt::format("$EndNodes\n$Elements\n{}\n", along * across + boom + across + 1);
  int element = 0;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < along; ++i)
      text += fmt::format("{} 3 2 1 1 {} {} {} {}\n", ++element, grid(i, j), grid(i + 1, j), grid(i + 1, j + 1),
                          grid(i, j + 1));
  for (int k = 0; k < boom; ++k) text += fmt::format("{} 1 2 2 2 {} {}\n", ++element, boom_node(k), boom_node(k + 1));
  for (int j = 0; j <= across; ++j) text += fmt::format("{} 15 2 3 3 {}\n", ++element, grid(0, j));
  return text + "$EndElements\n";
}

std::string deck(const UnitSystem& u) {
  std::string text = fmt::format("BEGIN BULK\nPARAM,COUPMASS,1\nPARAM,WTMASS,{}\n", UnitSystem::number(u.wtmass));
  for (const auto& [id, x] : nodes())
    text += fmt::format("GRID,{},,{},{},{}\n", id, u.l(x.x()), u.l(x.y()), u.l(x.z()));
  text +=
      fmt::format("MAT1,1,{},,.3,{}\nPSHELL,1,1,{},1,,1\nPBAR,2,1,{},{},{},{}\n,,,,,,,,\n,.8,.8\n", u.pressure(70e9),
                  u.density(2700.0), u.l(thickness), u.l(8e-3, 2), u.l(4.267e-6, 4), u.l(6.667e-6, 4), u.l(9e-6, 4));
  int element = 0;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < along; ++i)
      text += fmt::format("CQUAD4,{},1,{},{},{},{}\n", ++element, grid(i, j), grid(i + 1, j), grid(i + 1, j + 1),
                          grid(i, j + 1));
  for (int k = 0; k < boom; ++k)
    text += fmt::format("CBAR,{},2,{},{},0.,1.,0.\n", ++element, boom_node(k), boom_node(k + 1));
  text += fmt::format("RBE2,{},{},123456,{},{}\n", ++element, grid(0, 1), grid(0, 0), grid(0, 2));
  return text + fmt::format("CONM2,{},{},,{},{},0.,{}\n,{},,{},,,{}\nENDDATA\n", ++element, boom_node(boom), u.kg(0.7),
                            u.l(0.01), u.l(0.02), u.inertia(2e-3), u.inertia(3e-3), u.inertia(4e-3));
}

/// The hinge has a spring and a motor's inertia; the deck brings its own lump, the mesh gets one from the scene.
std::string scene(const UnitSystem& u, bool from_deck) {
  const std::string wing =
      from_deck ? std::string("fe: wing.bdf")
                : fmt::format(
                      "fe: wing.msh\n    material: {{E: {}, nu: 0.3, rho: {}}}\n    sections: {{skin: {{shell: "
                      "{}}}, boom: {{rectangle: [{}, {}], orientation: [0, 1, 0]}}}}\n    masses: {{lump: "
                      "{{node: {}, mass: {}, inertia: [{}, {}, {}], offset: [{}, 0, {}]}}}}",
                      u.pressure(70e9), u.density(2700.0), u.l(thickness), u.l(side_y), u.l(side_z), boom_node(boom),
                      u.kg(0.7), u.inertia(2e-3), u.inertia(3e-3), u.inertia(4e-3), u.l(0.01), u.l(0.02));
  return fmt::format(
      "units: {}\nbodies:\n  hub:\n    rigid: {{mass: {}, inertia: [{}, {}, {}], com: [0, 0, {}]}}\n"
      "    ports: {{east: [{}, 0, 0]}}\n  wing:\n    {}\n    ports: {{root: {{{}}}, tip: {{node: {}}}}}\n"
      "    damping: 0.01\n    reduction: {{modes: 6}}\njoints:\n"
      "  drive: {{parent: hub.east, child: wing.root, revolute: y, stiffness: {}, inertia: {}}}\n",
      u.name, u.kg(30), u.inertia(4), u.inertia(5), u.inertia(6), u.l(0.2), u.l(0.4), wing,
      from_deck ? fmt::format("node: {}", grid(0, 1)) : std::string("set: root"), boom_node(boom), u.torque(50),
      u.inertia(0.02));
}

struct Results {
  Eigen::VectorXd omega;
  int rigid = 0;
  double lowest = 0.0;  ///< of the clamped wing [rad/s]
  fem::Mat6 D;
  reduction::EffectiveMass effective;
  Eigen::MatrixXcd port;  ///< response of the wing's port model at 8 Hz
};

/// @param in_scene  where the deck has units of its own
Results solve(const UnitSystem& u, bool from_deck, const UnitSystem* in_scene = nullptr) {
  const TemporaryFolder folder;
  folder.write("wing.msh", mesh(u));
  folder.write("wing.bdf", deck(u));
  const Scene read = read_scene(folder.write("scene.yaml", scene(in_scene ? *in_scene : u, from_deck)));
  const Network network = build_network(read, plan(read));
  const SystemModes found = modes(second_order(network));
  const titop::PortModel model = titop::port_model(network.bodies[1]);
  return {found.omega,
          found.rigid,
          network.bodies[1].omega(0),
          network.bodies[1].D,
          reduction::effective_mass(network.bodies[1]),
          titop::response(model.ss, 2.0 * M_PI * 8.0)};
}

/// Largest difference of two matrices, each entry over the root of the largest of its row times that of its column:
/// entries of different dimensions are not added up.
template <class M>
double apart(const M& x, const M& y) {
  const Eigen::VectorXd row = x.cwiseAbs().rowwise().maxCoeff();
  const Eigen::RowVectorXd column = x.cwiseAbs().colwise().maxCoeff();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index j = 0; j < x.cols(); ++j)
      if (const double size = std::sqrt(row(i) * column(j)); size > 0.0)
        worst = std::max(worst, std::abs(x(i, j) - y(i, j)) / size);
  return worst;
}

class UnitSystems : public testing::TestWithParam<UnitSystem> {};

void compare(const Results& x, const Results& y) {
  constexpr double limit = 1e-12;
  ASSERT_EQ(x.rigid, y.rigid);
  ASSERT_EQ(x.omega.size(), y.omega.size());
  // Reduced modes near the cut stand on what is left of the body beside the modes below: ε (ω/ω₁)² of it.
  double frequency = 0.0;
  for (Eigen::Index k = x.rigid; k < x.omega.size(); ++k) {
    const double gap = std::abs(y.omega(k) / x.omega(k) - 1.0);
    EXPECT_LT(gap, limit + 4.0 * 2.2e-16 * std::pow(x.omega(k) / x.lowest, 2)) << k;
    if (k < x.rigid + 6) frequency = std::max(frequency, gap);
  }
  const double D = apart(x.D, y.D),
               effective = ((x.effective.per_mode - y.effective.per_mode) * x.D.diagonal().cwiseInverse().asDiagonal())
                               .cwiseAbs()
                               .maxCoeff(),
               port = apart(x.port, y.port);
  fmt::print("frequencies {:.1e}, D {:.1e}, effective masses {:.1e}, port model {:.1e} apart\n", frequency, D,
             effective, port);
  EXPECT_LT(frequency, limit);
  EXPECT_LT(D, limit);
  EXPECT_LT(effective, 4.0 * limit);  // squares of modes: ε ω² over their distance, not ε
  EXPECT_LT(port, limit);
}

}  // namespace

TEST_P(UnitSystems, AMeshGivesTheSameResults) { compare(solve(si, false), solve(GetParam(), false)); }
TEST_P(UnitSystems, ADeckGivesTheSameResults) { compare(solve(si, true), solve(GetParam(), true)); }

INSTANTIATE_TEST_SUITE_P(, UnitSystems, testing::Values(millimetre, inch_lbf, inch_lbf_lbm));

TEST(Wing, ADeckWithWtmassGivesTheSameResults) { compare(solve(si, true), solve(inch_wtmass, true, &inch_lbf)); }

TEST(Wing, TheWingWeighsWhatItsVolumesDo) {
  // skin, boom (its length from node to node) and lump [kg]
  const double length = std::hypot(reach, 0.1 * boom);
  const double mass = 2700.0 * (a * b * thickness + side_y * side_z * length) + 0.7;
  for (const UnitSystem& u : {si, millimetre, inch_lbf, inch_lbf_lbm})
    EXPECT_NEAR(solve(u, false).D(0, 0) / mass, 1.0, 1e-12) << u.name;
}

TEST(Wing, WtmassInUnitsWithAForceOfTheirOwnIsRefused) {
  UnitSystem twice = inch_wtmass;
  twice.name = "inch-lbf-lbm";
  try {
    solve(twice, true);
    FAIL() << "masses were converted twice";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("PARAM WTMASS"), std::string::npos) << error.what();
  }
}
