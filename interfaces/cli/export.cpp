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

/// One array of all blocks; empty where they have not the same columns.
Eigen::MatrixXd joined(const std::vector<Eigen::MatrixXd>& blocks) {
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& values : blocks) {
    if (values.cols() != blocks.front().cols()) return {};
    rows += values.rows();
  }
  Eigen::MatrixXd all(rows, blocks.empty() ? 0 : blocks.front().cols());
  rows = 0;
  for (const Eigen::MatrixXd& values : blocks) {
    all.middleRows(rows, values.rows()) = values;
    rows += values.rows();
  }
  return all;
}

/// The mesh with all its digits, and its data where every value is known: VTK has no other.
void write_picture(const std::filesystem::path& path, const fem::Mesh& mesh, std::vector<std::string>& left_out) {
  std::vector<fem::PointArray> arrays;
  fem::VtuOptions options{.cell_arrays = {}, .digits = 17};
  for (const auto& [name, values] : mesh.point_data)
    if (values.allFinite())
      arrays.push_back({name, values});
    else
      left_out.push_back(fmt::format("point data '{}': not known at every point", name));
  for (const auto& [name, blocks] : mesh.cell_data)
    if (Eigen::MatrixXd values = joined(blocks); values.size() > 0 && values.allFinite())
      options.cell_arrays.push_back({name, std::move(values)});
    else
      left_out.push_back(fmt::format("cell data '{}': not known at every cell", name));
  if (!mesh.cell_sets.empty() || !mesh.point_sets.empty())
    left_out.push_back(fmt::format("sets: {}", mesh.cell_sets.size() + mesh.point_sets.size()));
  fem::write_vtu(path, mesh, arrays, options);
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
    write_picture(options.output, mesh, left_out);
  std::size_t cells = 0;
  for (const fem::CellBlock& block : mesh.cells) cells += static_cast<std::size_t>(block.size());
  print(
      fmt::format("{}: {} points and {} cells of {}", options.output.string(), mesh.points.size(), cells, mesh.source));
  for (const std::string& line : left_out) print("  left out " + line);
  return done;
}

}  // namespace tenon::cli
