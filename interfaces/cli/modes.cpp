#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <span>

#include "fem/error.hpp"
#include "fem/model_check.hpp"
#include "fem/rigid_forces.hpp"
#include "fem/singular_directions.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/input.hpp"
#include "interfaces/cli/modes.hpp"
#include "interfaces/cli/output.hpp"
#include "interfaces/report/mode_pictures.hpp"

namespace tenon::cli {
namespace {

/// What changes the answer beside the elements: directions held because they have no stiffness, what was read past.
struct Remarks {
  std::vector<std::string> held, read_past;
};

Json modes_json(const ModesOptions& options, const fem::Structure& structure, const reduction::Modes& modes,
                const Remarks& remarks) {
  Json object{
      {"source", options.file.string()}, {"model", "full"}, {"dofs", structure.n()}, {"rigid_modes", modes.rigid}};
  object["frequencies_hz"] = Json::array();
  for (const double lambda : modes.lambda)
    if (shows(options, omega_of(lambda))) object["frequencies_hz"].push_back(hertz(omega_of(lambda)));
  object["max_residual"] = modes.max_residual;
  object["max_orthogonality"] = modes.max_orthogonality;
  object["rigid_force"] = modes.rigid_force;
  object["counted"] = modes.counted;
  object["counted_below_hz"] = hertz(omega_of(modes.count_shift));
  object["held_without_stiffness"] = remarks.held;
  object["read_past"] = remarks.read_past;
  return object;
}

void print_modes(const ModesOptions& options, const fem::Structure& structure, const reduction::Modes& modes,
                 const Remarks& remarks) {
  print(fmt::format("{}: {} degrees of freedom, unreduced", options.file.string(), structure.n()));
  Table table({"mode", "frequency [Hz]"});
  for (Eigen::Index k = 0; k < modes.lambda.size(); ++k)
    if (shows(options, omega_of(modes.lambda[k])))
      table.row({std::to_string(k + 1), frequency_text(omega_of(modes.lambda[k]), k < modes.rigid)});
  print(table);
  print(fmt::format("  residuals at most {:.1e}; {}", modes.max_residual,
                    modes.counted < 0 ? "not certified"
                                      : fmt::format("inertia count below {:.6g} Hz: {}",
                                                    hertz(omega_of(modes.count_shift)), modes.counted)));
  if (modes.rigid > 0 && modes.rigid_force > fem::rigid_limit::unsaid)
    print(
        wrapped(fmt::format("K resists the rigid motions by {:.1e} of what cancels in a row, most at {}: taken as the "
                            "rounding of its numbers, so a tie to the ground that soft is not seen",
                            modes.rigid_force, structure.dofs.names[static_cast<std::size_t>(modes.rigid_force_row)]),
                2));
  if (!remarks.held.empty()) {
    constexpr std::size_t listed = 5;
    const std::size_t n = std::min(listed, remarks.held.size());
    print(wrapped(fmt::format("held, as Nastran's AUTOSPC holds what has no stiffness: {}{}",
                              fmt::join(std::span(remarks.held).first(n), ", "),
                              remarks.held.size() > n ? fmt::format(" and {} more", remarks.held.size() - n) : ""),
                  2));
  }
  if (!remarks.read_past.empty()) print("  Read past:");
  for (const std::string& line : remarks.read_past) print(wrapped(line, 4));
}

void write_pictures(const ModesOptions& options, const fem::Model& model, const fem::Structure& structure,
                    const reduction::Modes& modes) {
  if (options.vtu.empty()) return;
  Eigen::VectorXd omega = modes.lambda.cwiseMax(0.0).cwiseSqrt();
  const report::ModePictures pictures = report::mode_pictures(model, structure.dofs.expand(modes.shapes), omega);
  fem::write_vtu(options.vtu, pictures.mesh, pictures.modes);
}

int solve_and_show(const ModesOptions& options, fem::Model model, const fem::Mesh& mesh, bool auto_spc) {
  for (const std::string& set : options.clamp)
    for (const int node : fem::points_of_set(mesh, set))
      for (int k = 0; k < 6; ++k) model.supports.push_back({{node, k}});
  Remarks remarks{.held = {}, .read_past = loss_lines(model.losses)};
  if (auto_spc) remarks.held = fem::hold_singular_directions(model, fem::assemble(model), fem::CheckLimits().singular);
  const fem::Structure structure = fem::assemble(model);
  if (structure.n() == 0)
    throw ModelError(
        fmt::format("{}: nothing is free to move: supports, or links to what they hold, take all", model.source),
        "Look at the sets that supports name: `tenon info` lists them with their sizes");
  if (structure.M.nonZeros() == 0)
    throw ModelError(fmt::format("{}: nothing has mass", model.source),
                     "Give its materials a density, or masses to its nodes");
  reduction::Modes modes;
  {
    ProgressBar bar;
    modes = solve(structure, options, options.count, bar.callback());
  }
  write_pictures(options, model, structure, modes);
  if (options.json)
    print(modes_json(options, structure, modes, remarks));
  else
    print_modes(options, structure, modes, remarks);
  return done;
}

int run_deck(const ModesOptions& options) {
  fem::Deck deck = read_deck(options.file, options.allow);
  const int status = solve_and_show(options, std::move(deck.model), deck.mesh, deck.auto_spc);
  if (!options.json)
    print("  A deck names no units: these frequencies are per its own unit of time, taken as seconds.");
  return status;
}

}  // namespace

int run(const ModesOptions& options) {
  if (!options.band_hz.empty() && !(options.band_hz[0] < options.band_hz[1]))
    throw InputError({"--band"}, "the band is empty", "Write the lower frequency first, in Hz: --band 0 50");
  switch (kind_of(options.file)) {
    case InputKind::deck:
      return run_deck(options);
    case InputKind::scene:
      return modes_of_scene(options);
    case InputKind::mesh:
      break;
  }
  throw InputError({options.file.string()}, "a mesh alone has neither units nor materials nor sections",
                   fmt::format("Write a scene for it: `tenon init {}` makes one to fill in", options.file.string()));
}

reduction::Modes solve(const fem::Structure& structure, const ModesOptions& options, int count,
                       const reduction::Progress& progress) {
  reduction::ModesOptions solver;
  solver.count = count;
  if (!options.band_hz.empty()) solver.band = 2.0 * std::numbers::pi * options.band_hz[1];
  solver.progress = progress;
  return reduction::solve_modes(structure, solver);
}

int modes_of_model(const ModesOptions& options, fem::Model model) {
  return solve_and_show(options, std::move(model), {}, false);
}

}  // namespace tenon::cli
