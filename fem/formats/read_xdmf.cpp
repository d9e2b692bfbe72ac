#include "fem/formats/read_xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <pugixml.hpp>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/vtk/grid.hpp"
#include "fem/formats/xdmf/data_item.hpp"

namespace tenon::fem {
namespace {

using vtk::Values;

/// A kind of cells by XDMF's names and number, as VTK numbers it; the first two carry their number of nodes along.
struct XdmfTopology {
  std::array<const char*, 2> names;
  std::int64_t number;
  std::int64_t vtk;
  std::size_t nodes;
};

constexpr std::array<XdmfTopology, 18> topologies{{{{"Polyvertex", ""}, 1, 1, 1},
                                                   {{"Polyline", ""}, 2, 3, 2},
                                                   {{"Triangle", ""}, 4, 5, 3},
                                                   {{"Quadrilateral", ""}, 5, 9, 4},
                                                   {{"Tetrahedron", ""}, 6, 10, 4},
                                                   {{"Pyramid", ""}, 7, 14, 5},
                                                   {{"Wedge", ""}, 8, 13, 6},
                                                   {{"Hexahedron", ""}, 9, 12, 8},
                                                   {{"Edge_3", ""}, 34, 21, 3},
                                                   {{"Quadrilateral_9", "Quad_9"}, 35, 28, 9},
                                                   {{"Triangle_6", "Tri_6"}, 36, 22, 6},
                                                   {{"Quadrilateral_8", "Quad_8"}, 37, 23, 8},
                                                   {{"Tetrahedron_10", "Tet_10"}, 38, 24, 10},
                                                   {{"Pyramid_13", ""}, 39, 27, 13},
                                                   {{"Wedge_15", ""}, 40, 26, 15},
                                                   {{"Wedge_18", ""}, 41, 32, 18},
                                                   {{"Hexahedron_20", "Hex_20"}, 48, 25, 20},
                                                   {{"Hexahedron_27", "Hex_27"}, 50, 29, 27}}};

bool same_name(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

/// Cells as VTK has them; linear wedges as meshio writes them, which vtk::Grid expects turned.
struct CellList {
  Values nodes, ends, types;

  void add(const XdmfTopology& kind, const std::int64_t* from) {
    constexpr std::array<std::size_t, 6> wedge{0, 2, 1, 3, 5, 4};
    for (std::size_t i = 0; i < kind.nodes; ++i) nodes.whole.push_back(from[kind.number == 8 ? wedge[i] : i]);
    ends.whole.push_back(static_cast<std::int64_t>(nodes.whole.size()));
    types.whole.push_back(kind.vtk);
  }
};

class XdmfReader {
 public:
  XdmfReader(std::string_view bytes, const std::string& source, std::filesystem::path folder)
      : bytes_(bytes), folder_(std::move(folder)) {
    mesh_.source = source;
  }
  Mesh read();

 private:
  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const;
  [[noreturn]] void fail(pugi::xml_node node, const std::string& what,
                         const std::string& cure = "Write it again") const {
    fail(node.offset_debug(), what, cure);
  }
  void read_grids(pugi::xml_node parent);
  void read_grid(pugi::xml_node grid);
  void read_points(pugi::xml_node geometry);
  CellList cells(pugi::xml_node topology) const;
  CellList mixed_cells(pugi::xml_node topology, const Values& numbers) const;
  void read_attribute(pugi::xml_node attribute);
  void read_set(pugi::xml_node set);
  Values item(pugi::xml_node parent) const;
  template <class Step>
  void at(pugi::xml_node node, Step&& step) const;
  std::string attribute(pugi::xml_node node, const char* name, const char* older, const char* otherwise) const {
    return node.attribute(node.attribute(name) ? name : older).as_string(otherwise);
  }
  void lose(const std::string& name, const std::string& note);

  std::string_view bytes_;
  std::filesystem::path folder_;
  Mesh mesh_;
  vtk::Grid grid_{mesh_};
  std::size_t grids_ = 0, points_ = 0, cells_ = 0;  ///< grids read; points and cells of the last
};

void XdmfReader::fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const {
  const auto before = bytes_.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  const auto line_start = before.rfind('\n');
  throw InputError({mesh_.source, 1 + std::ranges::count(before, '\n'),
                    static_cast<long>(before.size() - (line_start == before.npos ? 0 : line_start + 1)) + 1},
                   what, cure);
}

/// Faults of arrays are faults at the node.
template <class Step>
void XdmfReader::at(pugi::xml_node node, Step&& step) const {
  try {
    step();
  } catch (const vtk::ArrayFault& fault) {
    fail(node, fault.what, fault.cure);
  }
}

void XdmfReader::lose(const std::string& name, const std::string& note) {
  const auto known = std::ranges::find(mesh_.losses, name, &Loss::name);
  if (known == mesh_.losses.end())
    mesh_.losses.push_back({name, 1, note});
  else
    ++known->count;
}

Values XdmfReader::item(pugi::xml_node parent) const {
  const pugi::xml_node node = parent.child("DataItem");
  if (!node) fail(parent, fmt::format("{} has no DataItem", parent.name()));
  try {
    return xdmf::values_of(node, folder_);
  } catch (const vtk::ArrayFault& fault) {
    fail(node, "the DataItem " + fault.what, fault.cure);
  }
}

void XdmfReader::read_points(pugi::xml_node geometry) {
  const std::string type = attribute(geometry, "GeometryType", "Type", "XYZ");
  if (!same_name(type, "XYZ") && !same_name(type, "XY"))
    fail(geometry, fmt::format("found the geometry {}, expected XYZ or XY", type),
         "Write all coordinates of a point together");
  Values x = item(geometry);
  if (same_name(type, "XY")) {
    Values flat;
    flat.real = true;
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) flat.reals.insert(flat.reals.end(), {x.at(i), x.at(i + 1), 0.0});
    x = std::move(flat);
  }
  points_ = x.size() / 3;
  at(geometry, [&] { grid_.add_points(x, points_); });
}

CellList XdmfReader::mixed_cells(pugi::xml_node topology, const Values& numbers) const {
  CellList list;
  const std::size_t n = numbers.size();
  for (std::size_t i = 0; i < n;) {
    const std::int64_t number = numbers.whole[i++];
    const auto kind = std::ranges::find(topologies, number, &XdmfTopology::number);
    if (kind == topologies.end())
      fail(topology, fmt::format("cell {} is of XDMF's type {}, which is not read", list.ends.size(), number),
           "Convert it to lines, triangles, quadrilaterals or solids of first or second order");
    if (number <= 2) {
      if (i == n || numbers.whole[i] != static_cast<std::int64_t>(kind->nodes))
        fail(topology,
             fmt::format("cell {} is a {} of {} nodes, expected {}", list.ends.size(), kind->names[0],
                         i == n ? 0 : numbers.whole[i], kind->nodes),
             "Write each point and each line as a cell of its own");
      ++i;
    }
    if (n - i < kind->nodes)
      fail(topology, fmt::format("cell {}, a {}, lacks nodes", list.ends.size(), kind->names[0]));
    list.add(*kind, &numbers.whole[i]);
    i += kind->nodes;
  }
  return list;
}

CellList XdmfReader::cells(pugi::xml_node topology) const {
  const std::string type = attribute(topology, "TopologyType", "Type", "");
  Values numbers = item(topology);
  if (numbers.real && numbers.size() > 0) fail(topology, "found cells made of reals, expected whole numbers");
  CellList list;
  if (same_name(type, "Mixed")) {
    list = mixed_cells(topology, numbers);
  } else {
    const auto kind = std::ranges::find_if(
        topologies, [&](const XdmfTopology& t) { return same_name(type, t.names[0]) || same_name(type, t.names[1]); });
    if (kind == topologies.end() || type.empty())
      fail(topology, fmt::format("found the topology '{}', which is not read", type),
           "Convert it to lines, triangles, quadrilaterals or solids of first or second order");
    const std::string width = topology.attribute("NodesPerElement").as_string("");
    if (kind->number <= 2 && !width.empty() && width != std::to_string(kind->nodes))
      fail(topology, fmt::format("found {}s of {} nodes, expected {}", type, width, kind->nodes),
           "Write each point and each line as a cell of its own");
    if (numbers.size() % kind->nodes != 0)
      fail(topology,
           fmt::format("found {} numbers of nodes, expected {} for each {}", numbers.size(), kind->nodes, type));
    for (std::size_t i = 0; i < numbers.size(); i += kind->nodes) list.add(*kind, &numbers.whole[i]);
  }
  if (const long base = topology.attribute("BaseOffset").as_llong(0); base != 0)
    for (std::int64_t& node : list.nodes.whole) node -= base;
  const pugi::xml_attribute count = topology.attribute("NumberOfElements");
  if (count && count.as_ullong(0) != list.ends.size() &&
      std::string_view(count.value()).find(' ') == std::string_view::npos)
    fail(topology, fmt::format("found {} cells, NumberOfElements says {}", list.ends.size(), count.value()));
  return list;
}

void XdmfReader::read_attribute(pugi::xml_node attribute) {
  const std::string name = attribute.attribute("Name").value(),
                    centre = attribute.attribute("Center").as_string("Node");
  const bool of_cells = same_name(centre, "Cell");
  if (!of_cells && !same_name(centre, "Node")) {
    lose(fmt::format("Attribute '{}'", name), fmt::format("numbers of each {}", centre));
    return;
  }
  const Values values = item(attribute);
  at(attribute, [&] { grid_.add_data(of_cells, name, values, of_cells ? cells_ : points_); });
}

void XdmfReader::read_set(pugi::xml_node set) {
  const std::string name = set.attribute("Name").value(), type = attribute(set, "SetType", "Type", "Node");
  if (!same_name(type, "Node") && !same_name(type, "Cell")) {
    lose(fmt::format("Set '{}'", name), fmt::format("of kind {}", type));
    return;
  }
  const Values members = item(set);
  at(set, [&] { grid_.add_set(same_name(type, "Cell"), name, members); });
}

void XdmfReader::read_grid(pugi::xml_node grid) {
  const pugi::xml_node geometry = grid.child("Geometry"), topology = grid.child("Topology");
  if (!geometry || !topology)
    fail(grid,
         fmt::format("the grid '{}' has no {}", grid.attribute("Name").value(), geometry ? "Topology" : "Geometry"),
         "Give the grid that holds the mesh; those of later times may refer to it");
  ++grids_;
  read_points(geometry);
  const CellList list = cells(topology);
  cells_ = list.ends.size();
  at(topology, [&] { grid_.add_cells(list.nodes, list.ends, list.types, cells_); });
  for (const pugi::xml_node child : grid.children()) {
    const std::string_view name = child.name();
    if (name == "Attribute")
      read_attribute(child);
    else if (name == "Set")
      read_set(child);
    else if (name != "Geometry" && name != "Topology" && name != "Time" && child.type() == pugi::node_element)
      lose(std::string(name), "no part of a mesh");
  }
}

void XdmfReader::read_grids(pugi::xml_node parent) {
  for (const pugi::xml_node child : parent.children()) {
    const std::string_view name = child.name();
    if (name == "xi:include")
      fail(child, "a part stands in another place (xi:include), which is not read",
           "Write the file without references");
    if (name != "Grid") continue;
    const std::string type = attribute(child, "GridType", "Type", "Uniform");
    const std::string collection = child.attribute("CollectionType").as_string("Spatial");
    if (same_name(type, "Uniform")) {
      read_grid(child);
    } else if (same_name(type, "Tree") || same_name(type, "Collection")) {
      if (!same_name(type, "Collection") || !same_name(collection, "Temporal")) {
        read_grids(child);
        continue;
      }
      const auto steps = child.children("Grid");
      if (steps.begin() == steps.end()) continue;
      read_grid(*steps.begin());
      if (const auto later = std::distance(steps.begin(), steps.end()) - 1; later > 0)
        mesh_.losses.push_back({"Grid", static_cast<long>(later), "later times of a temporal collection"});
    } else {
      fail(child, fmt::format("found a grid of type {}, expected Uniform, Collection or Tree", type),
           "Write the mesh as one uniform grid");
    }
  }
}

Mesh XdmfReader::read() {
  pugi::xml_document document;
  const auto result = document.load_buffer(bytes_.data(), bytes_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) fail(result.offset, fmt::format("no well-formed XML: {}", result.description()), "Write it again");
  const pugi::xml_node file = document.child("Xdmf"), domain = file.child("Domain");
  if (!file) throw InputError({mesh_.source}, "has no element Xdmf", "Give an .xdmf file");
  mesh_.format = fmt::format("xdmf {}", file.attribute("Version").as_string("3.0"));
  if (!domain) fail(file, "has no Domain");
  read_grids(domain);
  if (grids_ > 1)
    mesh_.losses.push_back(
        {"Grid, side by side", static_cast<long>(grids_), "nothing joins the grids: shared points stay apart"});
  grid_.finish();
  return std::move(mesh_);
}

}  // namespace

Mesh parse_xdmf(std::string_view bytes, const std::string& source, const std::filesystem::path& folder) {
  if (bytes.empty()) throw InputError({source}, "the file is empty", "Save the mesh again");
  return XdmfReader(bytes, source, folder).read();
}

Mesh read_xdmf(const std::filesystem::path& path) {
  return parse_xdmf(read_bytes(path), path.string(), path.parent_path());
}

}  // namespace tenon::fem
