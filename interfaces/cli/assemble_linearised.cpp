#include <fmt/format.h>

#include <algorithm>

#include "assembly/build.hpp"
#include "assembly/linearised.hpp"
#include "interfaces/cli/assemble.hpp"
#include "reduction/matrix_rows.hpp"

namespace tenon::cli {
namespace {

/// Gravity or rates: then shape integrals and stiffening count.
bool moves(const assembly::SceneSimulation& section) {
  const auto turns = [](const assembly::InitialMotion& i) { return i.rate != 0.0 || !i.turning.isZero(0.0); };
  return !section.gravity.isZero(0.0) || std::any_of(section.initial.begin(), section.initial.end(), turns);
}

/// Joints that turn at a rate, and the torque that keeps it.
Json spins(const assembly::Network& network, const assembly::Simulation& simulation,
           const assembly::SteadyMotion& about) {
  Json list = Json::array();
  const assembly::Multibody& system = simulation.bodies.system;
  for (std::size_t j = 0; j < network.joints.size(); ++j) {
    const int k = simulation.bodies.hinge[j];
    if (k < 0 || network.joints[j].kind != assembly::JointKind::revolute) continue;
    const auto body = static_cast<std::size_t>(k);
    const Eigen::Index at = system.v_offset[body] + system.bodies[body].modes();
    if (about.state.v[at] == 0.0) continue;
    list.push_back(
        {{"joint", network.joints[j].name}, {"rate_rad_s", about.state.v[at]}, {"torque_n_m", about.held[at]}});
  }
  return list;
}

Json summary(const AssembleOptions& options, const assembly::LinearisedNetwork& l,
             const assembly::LinearisedModes& modes, Json spun) {
  Json object{{"source", options.scene.string()},
              {"states", l.ss.order()},
              {"coordinates", l.T.cols()},
              {"constraint_rows", l.J.rows()},
              {"constraint_rank", l.rank},
              {"redundant_rows", l.J.rows() - l.rank},
              {"rigid_modes", l.free},
              {"frequencies_hz", Json::array()},
              {"damping_ratios", Json::array()},
              {"inputs", channels(l.ss.inputs)},
              {"outputs", channels(l.ss.outputs)},
              {"spins", std::move(spun)},
              {"joints_moved_rad", l.about.turned},
              {"poles_rad_s", Json::array()},
              {"growth_1_s", modes.growth}};
  for (Eigen::Index k = 0; k < modes.omega.size(); ++k) {
    object["frequencies_hz"].push_back(hertz(modes.omega[k]));
    object["damping_ratios"].push_back(modes.zeta[k]);
  }
  for (const std::complex<double> pole : modes.poles) object["poles_rad_s"].push_back({pole.real(), pole.imag()});
  return object;
}

Json second_order(const assembly::LinearisedNetwork& l) {
  Json object{{"coordinates", l.coordinates}};
  for (const auto& [name, matrix] :
       {std::pair("M", &l.M), std::pair("C", &l.C), std::pair("K", &l.K), std::pair("B", &l.B), std::pair("J", &l.J)})
    object[name] = reduction::matrix_rows<Json>(*matrix);
  return object;
}

void print_people(const AssembleOptions& options, const assembly::LinearisedNetwork& l,
                  const assembly::LinearisedModes& modes, const Json& spun) {
  print(fmt::format("{}: the recursive model about {}, {} coordinates, {} states", options.scene.string(),
                    l.about.frequency == 0.0      ? "rest"
                    : l.about.state.v.isZero(0.0) ? "its equilibrium"
                                                  : "a steady spin",
                    l.T.cols(), l.ss.order()));
  if (l.J.rows() > 0) print(fmt::format("  rows that close loops: {}, of rank {}", l.J.rows(), l.rank));
  for (const Json& spin : spun)
    print(fmt::format("  {} turns at {:.6g} rad/s, held by {:.6g} N m", spin["joint"].get<std::string>(),
                      spin["rate_rad_s"].get<double>(), spin["torque_n_m"].get<double>()));
  if (l.about.turned > 1e-12)
    print(fmt::format("  on the way to the equilibrium a joint turned by {:.3g} rad", l.about.turned));
  Table table({"mode", "frequency [Hz]", "damping"});
  for (Eigen::Index k = l.free; k < modes.omega.size(); ++k)
    table.row({fmt::format("{}", k + 1), fmt::format("{:.6g}", hertz(modes.omega[k])),
               fmt::format("{:.4f}", std::abs(modes.zeta[k]) < 5e-5 ? 0.0 : modes.zeta[k])});
  if (l.free > 0) print(fmt::format("  {} motions that nothing holds", l.free));
  if (modes.omega.size() > l.free) print(table);
  if (modes.growth > 0.0)
    print(wrapped(fmt::format("Unstable: a disturbance grows by the factor e in {:.3g} s.", 1.0 / modes.growth), 0));
  print_channels("input", l.ss.inputs);
  print_channels("output", l.ss.outputs);
}

}  // namespace

int run_linearised(const AssembleOptions& options) {
  const assembly::Scene scene = assembly::read_scene(options.scene);
  const assembly::SceneSimulation section = assembly::read_simulation(scene);
  const assembly::Plan plan = moves(section) ? assembly::plan_motion(scene, section) : assembly::plan(scene);
  assembly::Network network;
  {
    ProgressBar bar;
    network = assembly::build_network(scene, plan, bar.callback());
  }
  const assembly::Simulation simulation = assembly::make_simulation(network, section);
  const assembly::LinearisedNetwork linear = assembly::linearised(network, simulation);
  const assembly::LinearisedModes modes = assembly::modes(linear);
  const Json spun = spins(network, simulation, linear.about);
  Json object = summary(options, linear, modes, spun);
  if (!options.output.empty()) {
    Json file = object;
    file["second_order"] = second_order(linear);
    write_system(options.output, std::move(file), linear.ss);
  }
  if (options.json) {
    print(object);
    return done;
  }
  print_people(options, linear, modes, spun);
  if (!options.output.empty()) print(fmt::format("\nWritten: {}", options.output.string()));
  return done;
}

}  // namespace tenon::cli
