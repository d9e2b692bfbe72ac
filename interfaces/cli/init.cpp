#include <fmt/format.h>

#include <Eigen/Geometry>
#include <iostream>

#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "fem/formats/read_mesh.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/input.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

/// The highest dimension of a set's cells, 0 for points alone.
int dimension_of(const fem::Mesh& mesh, const std::vector<std::vector<int>>& blocks) {
  int dimension = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (!blocks[b].empty()) dimension = std::max(dimension, fem::dimension(mesh.cells[b].type));
  return dimension;
}

std::string section_lines(const fem::Mesh& mesh) {
  std::string text;
  for (const auto& [set, blocks] : mesh.cell_sets) {
    const int dimension = dimension_of(mesh, blocks);
    if (dimension == 2) text += fmt::format("      {}: {{shell: THICKNESS}}\n", set);
    if (dimension == 1)
      text += fmt::format(
          "      {}: {{tube: [OUTER, INNER]}}  # radii; or circle, rectangle, box, general; "
          "move to `ignore` if it is no structure\n",
          set);
  }
  return text.empty() ? "      everywhere: {shell: THICKNESS}\n" : text;
}

std::string port_lines(const fem::Mesh& mesh) {
  std::string text;
  for (const auto& [set, points] : mesh.point_sets) text += fmt::format("      {0}: {{set: {0}}}\n", set);
  return text.empty() ? "      root: {nearest: [0, 0, 0]}\n" : text;
}

/// What only the user knows stands in capitals; `tenon check` points at each until it is filled in.
std::string scene_for(const fem::Mesh& mesh, const std::filesystem::path& file) {
  Eigen::AlignedBox3d box;
  for (const fem::Vec3& point : mesh.points) box.extend(point);
  const fem::Vec3 size = box.isEmpty() ? fem::Vec3(0.0, 0.0, 0.0) : fem::Vec3(box.sizes());
  const std::string body = file.stem().string();
  return fmt::format(
      "# A scene for {0}: {1} points, {2:g} x {3:g} x {4:g} in its unit of length.\n"
      "# Words in CAPITALS are for you to replace; `tenon check` points at those that are left.\n"
      "units: UNITS                    # SI, or e.g. {{length: mm, mass: t, time: s}}: of this file and of the mesh\n"
      "bodies:\n"
      "  {5}:\n"
      "    fe: {0}\n"
      "    material: aluminium         # or steel, titanium, {{E: ..., nu: ..., rho: ...}}\n"
      "    sections:                   # one for each set of cells\n"
      "{6}"
      "    ports:                      # where it is held or joined\n"
      "{7}"
      "    damping: 0.005\n"
      "    reduction: auto             # or {{basis: craig-bampton, modes: 12}}, or rigid\n"
      "joints: {{}}                      # e.g. drive: {{parent: hub.east, child: {5}.root, revolute: y, angle: 30 "
      "deg}}\n"
      "ground: []                      # ports fixed to the inertial frame, e.g. [{5}.root]\n"
      "inputs: {{}}                      # e.g. push: {{at: {5}.root, force: z}}\n"
      "outputs: {{}}                     # e.g. tip: {{at: {5}.root, acceleration: [x, y, z]}}\n"
      "requires: {{band: [0, BAND Hz], tolerance: 1e-3}}\n",
      file.filename().string(), mesh.points.size(), size.x(), size.y(), size.z(), body, section_lines(mesh),
      port_lines(mesh));
}

}  // namespace

int run(const InitOptions& options) {
  if (kind_of(options.mesh) != InputKind::mesh)
    throw InputError({options.mesh.string()}, "this is no mesh that lacks a scene",
                     "Name a .msh file; decks are solved as they are by `tenon modes`");
  if (!options.output.empty() && std::filesystem::exists(options.output))
    throw InputError({options.output.string()}, "exists already", "Name another file, or remove this one first");
  const std::string text = scene_for(fem::read_mesh(options.mesh), options.mesh);
  if (options.output.empty()) {
    fmt::print("{}", text);
    return done;
  }
  fem::AtomicFile file(options.output);
  file.stream() << text;
  file.commit();
  print(fmt::format("Written: {}", options.output.string()));
  return done;
}

}  // namespace tenon::cli
