#include <fmt/format.h>

#include <memory>

#include "assembly/build.hpp"
#include "assembly/second_order.hpp"
#include "fem/formats/atomic_file.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

struct Options {
  std::filesystem::path scene, output;
  bool json = false;
};

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json channels(const std::vector<titop::Channel>& list) {
  Json names = Json::array();
  for (const titop::Channel& channel : list) names.push_back({{"name", channel.name}, {"unit", channel.unit}});
  return names;
}

Json summary(const Options& options, const assembly::SecondOrderSystem& system, const assembly::SystemModes& modes,
             const titop::StateSpace& ss) {
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

/// The state space for other programs: A, B, C, D row by row, SI, named channels.
void write_system(const std::filesystem::path& path, Json object, const titop::StateSpace& ss) {
  object["format"] = "tenon linear system";
  object["version"] = 1;
  object["units"] = "SI";
  for (const auto& [name, matrix] :
       {std::pair("A", &ss.A), std::pair("B", &ss.B), std::pair("C", &ss.C), std::pair("D", &ss.D)})
    object[name] = rows_of(*matrix);
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

void print_people(const Options& options, const assembly::SecondOrderSystem& system, const assembly::SystemModes& modes,
                  const titop::StateSpace& ss) {
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

int run(const Options& options) {
  const assembly::Scene scene = assembly::read_scene(options.scene);
  assembly::Network network;
  {
    ProgressBar bar;
    network = assembly::build_network(scene, assembly::plan(scene), bar.callback());
  }
  const assembly::SecondOrderSystem system = assembly::second_order(network);
  const assembly::SystemModes modes = assembly::modes(system);
  const titop::StateSpace ss = assembly::state_space(network, system);
  const Json object = summary(options, system, modes, ss);
  if (!options.output.empty()) write_system(options.output, object, ss);
  if (options.json) {
    print(object);
    return done;
  }
  print_people(options, system, modes, ss);
  if (!options.output.empty()) print(fmt::format("\nWritten: {}", options.output.string()));
  return done;
}

}  // namespace

void add_assemble(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("assemble", "the linear system of a scene: modes and state space");
  command->add_option("SCENE", options->scene, "a scene (.yaml, .json)")->required();
  command->add_option("-o,--output", options->output, "write A, B, C, D with named channels as JSON");
  command->add_flag("--json", options->json, "one JSON object (without the matrices)");
  command->footer("Example: tenon assemble scene.yaml -o system.json");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace tenon::cli
