#include "assembly/modal_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fem/error.hpp"
#include "fem/formats/f06.hpp"
#include "fem/formats/nastran.hpp"
#include "reduction/body_file.hpp"
#include "reduction/modal_run.hpp"

namespace tenon::assembly {
namespace {

namespace fs = std::filesystem;

fs::path deck_beside(const fs::path& f06) {
  std::error_code fault;
  for (const char* ending : {".bdf", ".dat", ".nas"})
    if (const fs::path deck = fs::path(f06).replace_extension(ending); fs::is_regular_file(deck, fault)) return deck;
  throw InputError(
      {f06.string()}, "there is no deck beside it, and mass and places of nodes stand in the deck",
      fmt::format("Put {} there, or .dat or .nas", fs::path(f06).replace_extension(".bdf").filename().string()));
}

/// The nodes that supports hold in all six directions, by rising number.
std::vector<int> clamped_nodes(const fem::Model& model, const fs::path& deck) {
  std::map<int, unsigned> held;
  for (const fem::Support& support : model.supports) held[support.dof.node] |= 1U << support.dof.direction;
  std::vector<int> whole;
  for (const auto& [node, directions] : held)
    if (directions == fem::all_six) whole.push_back(node);
  if (whole.empty())
    throw InputError({deck.string()}, "no grid is held in all six directions, and the parent port is one",
                     "Clamp a grid (SPC1, 123456) and tie the interface to it by an RBE2");
  std::ranges::sort(whole, {}, [&](int node) { return model.node_ids[static_cast<std::size_t>(node)]; });
  return whole;
}

/// Supports elsewhere: those without mass (drilling rotations, AUTOSPC) go, others ground the body.
void refuse_ground(const fem::Model& model, const fem::Structure& structure, const std::vector<int>& clamped,
                   const fs::path& deck) {
  for (const fem::Support& support : model.supports) {
    if (std::ranges::find(clamped, support.dof.node) != clamped.end()) continue;
    const int row = structure.dofs.row(support.dof);
    if (row < 0) continue;
    if (structure.M.coeff(row, row) > 0.0)
      throw InputError({deck.string()}, fmt::format("{} is held beside the clamp", fem::name(model, support.dof)),
                       "A body is held at its clamped grids alone: take the other supports out and run it again");
  }
}

/// Mass of the weight generator, which counts in input units: WTMASS is not in it.
void compare_mass(const fem::ModalRun& run, double mass, double factor, const fs::path& f06) {
  if (!run.mass) return;
  const double printed = (*run.mass)(0, 0) * factor;
  if (std::abs(printed - mass) > 1e-3 * mass)
    throw InputError({f06.string()},
                     fmt::format("the weight generator counts the mass {:.6g}, the deck has {:.6g}", printed, mass),
                     "Deck and .f06 must be of one run");
}

/// Shapes keep their scale: translations to metres, so generalized masses by mass · length².
void take_to_si(fem::ModalRun& run, const Units& units) {
  const Factor length = units.to_si(dimension::length), inertia = units.to_si(dimension::inertia);
  const Factor lambda = units.to_si({-1, -1, 0, 1});  // stiffness over mass, whatever counts forces
  for (auto& [number, mode] : run.modes) {
    mode.lambda = lambda * mode.lambda;
    mode.generalized_mass = inertia * mode.generalized_mass;
  }
  for (auto& [number, shape] : run.shapes)
    for (auto& [grid, u] : shape) u.head<3>() = length * fem::Vec3(u.head<3>());
  if (run.mass) (*run.mass)(0, 0) = units.to_si(dimension::mass) * (*run.mass)(0, 0);  // all that is looked at
}

}  // namespace

reduction::ReducedBody read_modal_run(const fs::path& f06, const Units& units) {
  const fs::path file = deck_beside(f06);
  fem::ModalRun run = fem::read_f06(f06);
  take_to_si(run, units);
  fem::NastranDeck deck = fem::read_nastran(file);
  if (!deck.turned_nodes.empty())
    throw InputError({file.string()},
                     fmt::format("grid {} has a displacement frame CD, in which the .f06 prints its shapes",
                                 deck.turned_nodes.front()),
                     "Leave CD blank and run it again");
  fem::Model model = to_si(std::move(deck.model), units);
  const std::vector<int> clamped = clamped_nodes(model, file);
  std::vector<int> ports{clamped.front()};
  for (const int node : deck.boundary_nodes)
    if (node != clamped.front()) ports.push_back(node);
  for (const int node : ports)
    model.ports.push_back({fmt::format("g{}", model.node_ids[static_cast<std::size_t>(node)]), node});

  fem::Model free = model;
  free.supports.clear();
  const fem::Structure structure = fem::assemble(free);
  refuse_ground(model, structure, clamped, file);
  reduction::ReducedBody body =
      reduction::modal_body(structure, model.ports.front().name, run, {clamped.begin() + 1, clamped.end()});
  compare_mass(run, body.D(0, 0), deck.mass_factor, f06);
  body.name = f06.stem().string();
  body.certificate.source = fmt::format("{}, {}", f06.filename().string(), file.filename().string());
  body.certificate.source_hash = fmt::format("{}, {}", reduction::file_hash(f06), reduction::file_hash(file));
  body.certificate.nodes = static_cast<int>(model.nodes.size());
  body.certificate.elements = static_cast<int>(model.elements.size());
  body.certificate.dofs = structure.n();
  return body;
}

}  // namespace tenon::assembly
