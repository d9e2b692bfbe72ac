#include <fmt/format.h>

#include "fem/error.hpp"
#include "fem/formats/deck.hpp"
#include "fem/formats/extension.hpp"
#include "fem/formats/read_mesh.hpp"
#include "fem/formats/vtu.hpp"
#include "fem/formats/write_gmsh.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/input.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

/// Point data as arrays of a picture; where a value is not known there is none.
std::vector<fem::PointArray> known_arrays(const fem::Mesh& mesh, std::vector<std::string>& left_out) {
  std::vector<fem::PointArray> arrays;
  for (const auto& [name, values] : mesh.point_data)
    if (values.allFinite())
      arrays.push_back({name, values});
    else
      left_out.push_back(fmt::format("point data '{}': not known at every point", name));
  if (!mesh.cell_data.empty()) left_out.push_back(fmt::format("cell data: {} arrays", mesh.cell_data.size()));
  if (!mesh.cell_sets.empty() || !mesh.point_sets.empty())
    left_out.push_back(fmt::format("sets: {}", mesh.cell_sets.size() + mesh.point_sets.size()));
  return arrays;
}

}  // namespace

int run(const ExportOptions& options) {
  const InputKind kind = kind_of(options.input);
  if (kind == InputKind::scene)
    throw InputError({options.input.string()}, "this is a scene, not a mesh", "Name the mesh of one of its bodies");
  const std::string ending = fem::lower_extension(options.output);
  if (ending != ".msh" && ending != ".vtu")
    throw InputError({options.output.string()}, fmt::format("meshes are written as .msh or .vtu, not as '{}'", ending),
                     "Change the ending");
  if (options.binary && ending != ".msh")
    throw InputError({options.output.string()}, "--binary is for .msh", "Leave it out");
  const fem::Mesh mesh =
      kind == InputKind::deck ? fem::read_deck(options.input, true).mesh : fem::read_mesh(options.input);
  std::vector<std::string> left_out;
  if (ending == ".msh")
    fem::write_gmsh(options.output, mesh, {.binary = options.binary});
  else
    fem::write_vtu(options.output, mesh, known_arrays(mesh, left_out));
  std::size_t cells = 0;
  for (const fem::CellBlock& block : mesh.cells) cells += static_cast<std::size_t>(block.size());
  print(
      fmt::format("{}: {} points and {} cells of {}", options.output.string(), mesh.points.size(), cells, mesh.source));
  for (const std::string& line : left_out) print("  left out " + line);
  return done;
}

}  // namespace tenon::cli
