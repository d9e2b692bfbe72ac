#include <fmt/format.h>

#include <numbers>
#include <optional>

#include "assembly/build.hpp"
#include "assembly/reactions.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "interfaces/cli/assemble.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "reduction/matrix_rows.hpp"

namespace tenon::cli {
namespace {

/// At the frequency asked for; nothing when none was.
std::optional<assembly::Reactions> reactions_of(const AssembleOptions& options, const assembly::Network& network,
                                                const assembly::SecondOrderSystem& system) {
  if (!options.reactions_hz) return std::nullopt;
  if (network.inputs.empty())
    throw InputError({options.scene.string()}, "the scene names no inputs, so its joints have nothing to transmit",
                     "Add `inputs: {push: {at: body.port, force: x}}`");
  return assembly::reactions(network, system, 2.0 * std::numbers::pi * *options.reactions_hz);
}

Json to_json(const assembly::Reactions& r, double frequency_hz, const std::vector<titop::Channel>& inputs) {
  Json object{{"frequency_hz", frequency_hz}, {"rows", Json::array()}};
  for (std::size_t i = 0; i < r.names.size(); ++i) {
    Json row{{"name", r.names[i]}, {"unit", r.units[i]}, {"determinate", bool(r.determinate[i])}};
    for (std::size_t u = 0; u < inputs.size(); ++u) {
      const std::complex<double> value = r.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(u));
      row["per_unit_input"][inputs[u].name] = {value.real(), value.imag()};
    }
    object["rows"].push_back(std::move(row));
  }
  return object;
}

/// Signed where in phase, else magnitude and phase; 0 for round-off beside the largest of its kind.
std::string phasor(std::complex<double> value, double largest) {
  if (std::abs(value) <= 1e-12 * largest) return "0";
  if (std::abs(value.imag()) <= 1e-9 * std::abs(value)) return fmt::format("{:.5g}", value.real());
  return fmt::format("{:.4g} ∠ {:.0f}°", std::abs(value), std::arg(value) * 180.0 / std::numbers::pi);
}

void print_people(const assembly::Reactions& r, double frequency_hz, const std::vector<titop::Channel>& inputs) {
  constexpr std::size_t most = 3;  // columns of a page
  const std::size_t shown = std::min(most, inputs.size());
  std::vector<std::string> heads{"<reaction", "<unit"};
  for (std::size_t u = 0; u < shown; ++u) heads.push_back(inputs[u].name);
  Table table(heads);
  bool free = false;
  for (std::size_t i = 0; i < r.names.size(); ++i) {
    std::vector<std::string> row{(r.determinate[i] ? "" : "* ") + r.names[i], r.units[i]};
    free = free || !r.determinate[i];
    for (std::size_t u = 0; u < shown; ++u)
      row.push_back(phasor(r.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(u)),
                           r.value.col(static_cast<Eigen::Index>(u)).cwiseAbs().maxCoeff()));
    table.row(std::move(row));
  }
  print(fmt::format("\n  On the joint's child, or by the ground on the body, at {:.6g} Hz, per unit of", frequency_hz));
  print(table);
  if (free)
    print(
        wrapped("* indeterminate: closure rows are redundant, equilibrium allows others; this is the one of least "
                "norm."));
  if (shown < inputs.size()) print(wrapped(fmt::format("{} more inputs: --json", inputs.size() - shown)));
}

Json summary(const AssembleOptions& options, const assembly::SecondOrderSystem& system,
             const assembly::SystemModes& modes, const titop::StateSpace& ss) {
  Json object{{"source", options.scene.string()}, {"states", ss.order()},
              {"coordinates", system.M.rows()},   {"constraint_rows", system.G.rows()},
              {"constraint_rank", system.rank},   {"redundant_rows", system.redundant},
              {"rigid_modes", modes.rigid},       {"frequencies_hz", Json::array()},
              {"damping_ratios", Json::array()},  {"inputs", channels(ss.inputs)},
              {"outputs", channels(ss.outputs)}};
  for (Eigen::Index k = 0; k < modes.omega.size(); ++k) {
    object["frequencies_hz"].push_back(hertz(modes.omega[k]));
    object["damping_ratios"].push_back(modes.zeta[k]);
  }
  return object;
}

void print_people(const AssembleOptions& options, const assembly::SecondOrderSystem& system,
                  const assembly::SystemModes& modes, const titop::StateSpace& ss) {
  print(fmt::format("{}: {} coordinates, {} states, {} rigid modes", options.scene.string(), system.M.rows(),
                    ss.order(), modes.rigid));
  print(fmt::format("  joint and ground rows: {}, of rank {}{}", system.G.rows(), system.rank,
                    system.redundant > 0 ? fmt::format(", {} say nothing new", system.redundant) : std::string()));
  if (modes.omega.size() > modes.rigid)
    print(fmt::format("  flexible modes from {:.6g} Hz to {:.6g} Hz", hertz(modes.omega[modes.rigid]),
                      hertz(modes.omega[modes.omega.size() - 1])));
  print_channels("input", ss.inputs);
  print_channels("output", ss.outputs);
}

}  // namespace

int run(const AssembleOptions& options) {
  if (options.linearise) return run_linearised(options);
  const assembly::Scene scene = assembly::read_scene(options.scene);
  assembly::Network network;
  {
    ProgressBar bar;
    network = assembly::build_network(scene, assembly::plan(scene), bar.callback());
  }
  const assembly::SecondOrderSystem system = assembly::second_order(network);
  const assembly::SystemModes modes = assembly::modes(system);
  const titop::StateSpace ss = assembly::state_space(network, system);
  const std::optional<assembly::Reactions> reactions = reactions_of(options, network, system);
  Json object = summary(options, system, modes, ss);
  if (reactions) object["reactions"] = to_json(*reactions, *options.reactions_hz, ss.inputs);
  if (!options.output.empty()) write_system(options.output, object, ss);
  if (options.json) {
    print(object);
    return done;
  }
  print_people(options, system, modes, ss);
  if (reactions) print_people(*reactions, *options.reactions_hz, ss.inputs);
  if (!options.output.empty()) print(fmt::format("\nWritten: {}", options.output.string()));
  return done;
}

Json channels(const std::vector<titop::Channel>& list) {
  Json names = Json::array();
  for (const titop::Channel& channel : list) names.push_back({{"name", channel.name}, {"unit", channel.unit}});
  return names;
}

void write_system(const std::filesystem::path& path, Json object, const titop::StateSpace& ss) {
  object["format"] = "tenon linear system";
  object["version"] = 1;
  object["units"] = "SI";
  for (const auto& [name, matrix] :
       {std::pair("A", &ss.A), std::pair("B", &ss.B), std::pair("C", &ss.C), std::pair("D", &ss.D)})
    object[name] = reduction::matrix_rows<Json>(*matrix);
  fem::AtomicFile file(path);
  file.stream() << object.dump() << '\n';
  file.commit();
}

void print_channels(const char* title, const std::vector<titop::Channel>& list) {
  Table table({std::string("<") + title, "<unit"});
  for (const titop::Channel& channel : list) table.row({channel.name, channel.unit});
  print("");
  print(table);
}

}  // namespace tenon::cli
