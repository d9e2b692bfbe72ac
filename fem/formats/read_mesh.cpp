#include "fem/formats/read_mesh.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "fem/error.hpp"
#include "fem/formats/abaqus.hpp"
#include "fem/formats/extension.hpp"
#include "fem/formats/gmsh.hpp"
#include "fem/formats/nastran.hpp"
#include "fem/formats/read_med.hpp"
#include "fem/formats/read_vtk.hpp"
#include "fem/formats/read_vtu.hpp"
#include "fem/formats/read_xdmf.hpp"

namespace tenon::fem {
namespace {

bool begins_as_gmsh(const std::filesystem::path& path) {
  constexpr std::string_view heading = "$MeshFormat";
  std::array<char, heading.size()> start{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(start.data(), start.size());
  return stream.gcount() == std::ssize(start) && std::string_view(start.data(), start.size()) == heading;
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  const std::string extension = lower_extension(path);
  if (!regular || extension == ".msh" || begins_as_gmsh(path)) return read_gmsh(path);
  if (extension == ".inp") return read_abaqus(path, {.allow_losses = true}).mesh;
  if (extension == ".vtu") return read_vtu(path);
  if (extension == ".vtk") return read_vtk(path);
  if (extension == ".xdmf" || extension == ".xmf") return read_xdmf(path);
  if (extension == ".med" || extension == ".mmed" || extension == ".rmed") return read_med(path);
  if (is_nastran(extension) && !nastran_gives_sections(path)) return read_nastran_mesh(path);
  throw InputError(
      {path.string()}, fmt::format("'{}' is not a mesh format that is read here", extension),
      is_nastran(extension)
          ? "A Nastran deck is a whole model with its own sections, not a mesh: give it where a deck is asked for"
          : "Give a Gmsh mesh (.msh, version 2.2 or 4.1), an Abaqus one (.inp), Nastran's grids and elements (.bdf), a "
            "VTK "
            "grid (.vtu, .vtk), an XDMF (.xdmf) or a MED one (.med); gmsh converts others: gmsh in.unv -save -format "
            "msh41 -o out.msh");
}

}  // namespace tenon::fem
