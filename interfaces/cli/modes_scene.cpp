#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/build.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "fem/structure.hpp"
#include "interfaces/cli/modes.hpp"
#include "interfaces/report/mode_pictures.hpp"

namespace tenon::cli {
namespace {

/// Modes of the unreduced assembly beside those of the reduced one.
struct Full {
  int dofs = 0, rigid = 0;
  std::vector<double> omega;
  std::vector<double> error;    ///< reduced / full − 1; 0 for rigid modes
  double worst_required = 0.0;  ///< largest error of those the scene requires
  bool within = true;           ///< of the scene's tolerance, with as many rigid modes
};

/// Ritz values lie above the exact ones index by index (Courant-Fischer), so order alone pairs the two lists.
Full compare(const assembly::Scene& scene, const assembly::Network& network, const assembly::SystemModes& modes,
             const ModesOptions& command, int shown, const reduction::Progress& progress) {
  const fem::Structure structure = fem::assemble(assembly::full_model(scene, network).model);
  const reduction::Modes exact = solve(structure, command, shown, progress);

  Full full;
  full.dofs = structure.n();
  full.rigid = exact.rigid;
  const double top = scene.requirement.band ? (*scene.requirement.band)[1] : INFINITY;
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(shown, exact.lambda.size()); ++k) {
    const double omega = omega_of(exact.lambda[k]);
    const double error = k < modes.rigid && k < exact.rigid ? 0.0 : modes.omega[k] / omega - 1.0;
    full.omega.push_back(omega);
    full.error.push_back(error);
    if (omega <= top) full.worst_required = std::max(full.worst_required, std::abs(error));
  }
  full.within = full.rigid == modes.rigid && full.worst_required <= scene.requirement.tolerance;
  return full;
}

Json to_json(const assembly::Scene& scene, const assembly::SystemModes& modes, Eigen::Index coordinates,
             const std::optional<Full>& full, const ModesOptions& command, Eigen::Index shown) {
  Json object{{"source", scene.file.string()},   {"model", "reduced"},
              {"coordinates", coordinates},      {"rigid_modes", modes.rigid},
              {"frequencies_hz", Json::array()}, {"damping_ratios", Json::array()}};
  if (full)
    object["full"] = {{"dofs", full->dofs},
                      {"rigid_modes", full->rigid},
                      {"frequencies_hz", Json::array()},
                      {"relative_errors", Json::array()}};
  for (Eigen::Index k = 0; k < shown; ++k) {
    if (!shows(command, modes.omega[k])) continue;
    object["frequencies_hz"].push_back(hertz(modes.omega[k]));
    object["damping_ratios"].push_back(modes.zeta[k]);
    if (full && k < static_cast<Eigen::Index>(full->omega.size())) {
      object["full"]["frequencies_hz"].push_back(hertz(full->omega[static_cast<std::size_t>(k)]));
      object["full"]["relative_errors"].push_back(full->error[static_cast<std::size_t>(k)]);
    }
  }
  if (full) {
    object["full"]["largest_relative_error_in_required_band"] = full->worst_required;
    object["full"]["tolerance"] = scene.requirement.tolerance;
    object["full"]["within_tolerance"] = full->within;
  }
  return object;
}

void print_people(const assembly::Scene& scene, const assembly::SystemModes& modes, Eigen::Index coordinates,
                  const std::optional<Full>& full, const ModesOptions& command, Eigen::Index shown) {
  print(fmt::format("{}: {} coordinates{}", scene.file.string(), coordinates,
                    full ? fmt::format(" in place of {} degrees of freedom", full->dofs) : std::string()));
  Table table(full ? std::vector<std::string>{"mode", "reduced [Hz]", "full [Hz]", "error", "damping"}
                   : std::vector<std::string>{"mode", "frequency [Hz]", "damping"});
  for (Eigen::Index k = 0; k < shown; ++k) {
    if (!shows(command, modes.omega[k])) continue;
    const bool rigid = k < modes.rigid;
    std::vector<std::string> row{std::to_string(k + 1), frequency_text(modes.omega[k], rigid)};
    if (full && k < static_cast<Eigen::Index>(full->omega.size())) {
      row.push_back(frequency_text(full->omega[static_cast<std::size_t>(k)], k < full->rigid));
      row.push_back(rigid ? "" : fmt::format("{:.1e}", full->error[static_cast<std::size_t>(k)]));
    } else if (full) {
      row.insert(row.end(), {"", ""});
    }
    row.push_back(rigid ? "" : fmt::format("{:.4f}", modes.zeta[k]));
    table.row(std::move(row));
  }
  print(table);
  if (full)
    print(fmt::format("  largest error in the required band {:.1e}, tolerance {:.1e}: {}", full->worst_required,
                      scene.requirement.tolerance, full->within ? "met" : "NOT met"));
}

bool is_held(const assembly::SceneBody& body) {
  const auto* fe = std::get_if<assembly::FeSource>(&body.source);
  return fe && !fe->supports.empty();
}

}  // namespace

int modes_of_scene(const ModesOptions& command) {
  const assembly::Scene scene = assembly::read_scene(command.file);
  if (!command.clamp.empty())
    throw InputError({command.file.string()}, "--clamp is for decks", "Write `ground: [body.port]` into the scene");
  const assembly::SceneBody& first = scene.bodies.front();
  if (scene.bodies.size() == 1 && first.has_model() && (first.ports.empty() || is_held(first)))
    return modes_of_model(command, assembly::build_model(first));

  std::optional<ProgressBar> bar(std::in_place);
  const assembly::Network network = assembly::build_network(scene, assembly::plan(scene), bar->callback());
  const assembly::SecondOrderSystem system = assembly::second_order(network);
  const assembly::SystemModes modes = assembly::modes(system);
  const int all = static_cast<int>(modes.omega.size());
  const int shown = command.band_hz.empty() ? std::min(command.count, all) : all;
  std::optional<Full> full;
  if (command.full) full = compare(scene, network, modes, command, shown, bar->callback());
  bar.reset();
  if (!command.vtu.empty()) {
    const report::ModePictures pictures = report::mode_pictures(scene, network, system, modes, shown);
    fem::write_vtu(command.vtu, pictures.mesh, pictures.modes);
  }
  if (command.json)
    print(to_json(scene, modes, system.M.rows(), full, command, shown));
  else
    print_people(scene, modes, system.M.rows(), full, command, shown);
  return !full || full->within ? done : check_failed;
}

}  // namespace tenon::cli
