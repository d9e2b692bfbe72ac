#include "fem/formats/vtu.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"

namespace tenon::fem {
namespace {

/// Numbers of vtkCellType.h in the order of CellType.
constexpr std::array<int, 19> vtk_types{1, 3, 21, 5, 22, 9, 23, 28, 10, 24, 12, 25, 29, 13, 26, 32, 14, 27, 27};

int vtk_type(CellType type) { return vtk_types[static_cast<std::size_t>(type)]; }
int vtk_node_count(CellType type) { return type == CellType::pyramid14 ? 13 : node_count(type); }

/// VTK's linear wedge is the only cell whose nodes stand otherwise than in a Mesh.
int vtk_node(CellType type, int i) {
  constexpr std::array<int, 6> wedge{0, 2, 1, 3, 5, 4};
  return type == CellType::wedge ? wedge[static_cast<std::size_t>(i)] : i;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

void check(const std::vector<PointArray>& arrays, Eigen::Index n, const char* things) {
  for (const PointArray& array : arrays) {
    if (array.values.rows() != n)
      throw ModelError(fmt::format("the array '{}' has {} rows for {} {}", array.name, array.values.rows(), n, things),
                       "Give one row for each, of the same mesh");
    if (!array.values.allFinite())
      throw ModelError(fmt::format("the array '{}' holds NaN or infinity", array.name), "Give finite values");
  }
}

void check(const Mesh& mesh, const std::vector<PointArray>& arrays) {
  const auto n = static_cast<Eigen::Index>(mesh.points.size());
  check(arrays, n, "points");
  for (const CellBlock& block : mesh.cells)
    for (const int node : block.nodes)
      if (node < 0 || node >= n)
        throw ModelError(fmt::format("a {} names point {} of {}", name(block.type), node, n),
                         "Give cells and points of the same mesh");
}

using Text = fmt::memory_buffer;

void open_array(Text& text, const char* type, const std::string& name, Eigen::Index components) {
  fmt::format_to(std::back_inserter(text),
                 "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type,
                 escaped(name), components);
}

void close_array(Text& text) { fmt::format_to(std::back_inserter(text), "</DataArray>\n"); }

void put_points(Text& text, const Mesh& mesh, int digits) {
  open_array(text, "Float64", "Points", 3);
  for (const Vec3& p : mesh.points)
    fmt::format_to(std::back_inserter(text), "{:.{}g} {:.{}g} {:.{}g}\n", p.x(), digits, p.y(), digits, p.z(), digits);
  close_array(text);
}

void put_cells(Text& text, const Mesh& mesh) {
  const auto out = std::back_inserter(text);
  open_array(text, "Int64", "connectivity", 1);
  for (const CellBlock& block : mesh.cells) {
    const int width = node_count(block.type);
    for (std::size_t first = 0; first + static_cast<std::size_t>(width) <= block.nodes.size();
         first += static_cast<std::size_t>(width)) {
      for (int i = 0; i < vtk_node_count(block.type); ++i)
        fmt::format_to(out, "{} ", block.nodes[first + static_cast<std::size_t>(vtk_node(block.type, i))]);
      text.push_back('\n');
    }
  }
  close_array(text);
  open_array(text, "Int64", "offsets", 1);
  long offset = 0;
  for (const CellBlock& block : mesh.cells)
    for (int c = 0; c < block.size(); ++c) fmt::format_to(out, "{}\n", offset += vtk_node_count(block.type));
  close_array(text);
  open_array(text, "UInt8", "types", 1);
  for (const CellBlock& block : mesh.cells)
    for (int c = 0; c < block.size(); ++c) fmt::format_to(out, "{}\n", vtk_type(block.type));
  close_array(text);
}

void put_values(Text& text, const PointArray& array, int digits) {
  open_array(text, "Float64", array.name, array.values.cols());
  for (Eigen::Index i = 0; i < array.values.rows(); ++i) {
    for (Eigen::Index c = 0; c < array.values.cols(); ++c)
      fmt::format_to(std::back_inserter(text), "{:.{}g} ", array.values(i, c), digits);
    text.push_back('\n');
  }
  close_array(text);
}

void write(const std::filesystem::path& path, const Text& text) {
  AtomicFile file(path);
  file.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  file.commit();
}

/// Length of the diagonal of the box around the points.
double diagonal(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.points) box.extend(p);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace

std::vector<PointArray> mode_arrays(const Eigen::Ref<const Eigen::MatrixXd>& shapes) {
  if (shapes.rows() % 6 != 0)
    throw ModelError(fmt::format("shapes of {} rows are not six dofs a node", shapes.rows()),
                     "Give all dofs, as DofMap::expand does");
  std::vector<PointArray> arrays;
  for (Eigen::Index j = 0; j < shapes.cols(); ++j) {
    Eigen::MatrixXd u(shapes.rows() / 6, 3);
    for (Eigen::Index i = 0; i < u.rows(); ++i) u.row(i) = shapes.col(j).segment<3>(6 * i).transpose();
    arrays.push_back({fmt::format("mode_{}", j + 1), std::move(u)});
  }
  return arrays;
}

void write_vtu(const std::filesystem::path& path, const Mesh& mesh, const std::vector<PointArray>& arrays,
               const VtuOptions& options) {
  check(mesh, arrays);
  std::size_t n_cells = 0;
  for (const CellBlock& block : mesh.cells) n_cells += static_cast<std::size_t>(block.size());
  check(options.cell_arrays, static_cast<Eigen::Index>(n_cells), "cells");
  Text text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
                 "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
                 "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
                 mesh.points.size(), n_cells);
  put_points(text, mesh, options.digits);
  fmt::format_to(out, "</Points>\n<Cells>\n");
  put_cells(text, mesh);
  fmt::format_to(out, "</Cells>\n<PointData>\n");
  for (const PointArray& array : arrays) put_values(text, array, options.digits);
  fmt::format_to(out, "</PointData>\n<CellData>\n");
  for (const PointArray& array : options.cell_arrays) put_values(text, array, options.digits);
  fmt::format_to(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  write(path, text);
}

void write_mode_animation(const std::filesystem::path& pvd, const Mesh& mesh,
                          const Eigen::Ref<const Eigen::MatrixX3d>& mode, const AnimationOptions& options) {
  check(mesh, {{"displacement", mode}});
  const double largest = mode.rows() > 0 ? mode.rowwise().norm().maxCoeff() : 0.0;
  const double a = largest > 0.0 ? options.amplitude * diagonal(mesh) / largest : 0.0;
  Text collection;
  const auto out = std::back_inserter(collection);
  fmt::format_to(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
  Mesh frame = mesh;
  for (int k = 0; k < options.frames; ++k) {
    const double t = static_cast<double>(k) / options.frames;
    const Eigen::MatrixX3d u = a * std::sin(2.0 * std::numbers::pi * t) * mode;
    for (std::size_t i = 0; i < frame.points.size(); ++i)
      frame.points[i] = mesh.points[i] + u.row(static_cast<Eigen::Index>(i)).transpose();
    const std::string name = fmt::format("{}_{:03}.vtu", pvd.stem().string(), k);
    write_vtu(pvd.parent_path() / name, frame, {{"displacement", u}});
    fmt::format_to(out, "<DataSet timestep=\"{:.6g}\" part=\"0\" file=\"{}\"/>\n", t, escaped(name));
  }
  fmt::format_to(out, "</Collection>\n</VTKFile>\n");
  write(pvd, collection);
}

}  // namespace tenon::fem
