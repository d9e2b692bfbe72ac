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
      : bytes_(bytes), reading_{std::move(folder), bytes.size(), 0} {
    mesh_.source = source;
  }
  Mesh read();

 private:
  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const;
  [[noreturn]] void fail(pugi::xml_node node, const std::string& what,
                         const std::string& cure = "Write it again") const {
    fail(node.offset_debug(), what, cure);
  }
  void read_grids(pugi::xml_node parent, int depth);
  void read_steps(pugi::xml_node collection);
  void read_grid(pugi::xml_node grid);
  void read_points(pugi::xml_node geometry);
  CellList cells(pugi::xml_node topology);
  void check_count(pugi::xml_node topology, std::size_t n_cells) const;
  CellList mixed_cells(pugi::xml_node topology, const Values& numbers) const;
  void read_attribute(pugi::xml_node attribute);
  void read_set(pugi::xml_node set);
  Values item(pugi::xml_node parent, bool whole = false);
  pugi::xml_node only(pugi::xml_node parent, const char* name) const;
  std::string named(pugi::xml_node node) const;
  template <class Step>
  void at(pugi::xml_node node, Step&& step) const;
  std::string attribute(pugi::xml_node node, const char* name, const char* older, const char* otherwise) const {
    return node.attribute(node.attribute(name) ? name : older).as_string(otherwise);
  }
  void lose(const std::string& name, const std::string& note);

  std::string_view bytes_;
  xdmf::Reading reading_;
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

/// The child of that name, if any; a second one would be read past.
pugi::xml_node XdmfReader::only(pugi::xml_node parent, const char* name) const {
  const pugi::xml_node child = parent.child(name);
  if (const pugi::xml_node second = child.next_sibling(name))
    fail(second, fmt::format("found a second {} in {}, expected one", name, parent.name()),
         "Write each in an element of its own");
  return child;
}

std::string XdmfReader::named(pugi::xml_node node) const {
  const std::string name = node.attribute("Name").value();
  if (name.empty()) fail(node, fmt::format("{} has no Name", node.name()), "Give it one");
  return name;
}

Values XdmfReader::item(pugi::xml_node parent, bool whole) {
  const pugi::xml_node node = only(parent, "DataItem");
  if (!node) fail(parent, fmt::format("{} has no DataItem", parent.name()));
  try {
    return xdmf::values_of(node, reading_, whole);
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
    if (x.size() % 2 != 0) fail(geometry, fmt::format("found {} coordinates, expected two of each point", x.size()));
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
    if (number <= 2 && i < n) {
      if (numbers.whole[i] != static_cast<std::int64_t>(kind->nodes))
        fail(topology,
             fmt::format("cell {} is a {} of {} nodes, expected {}", list.ends.size(), kind->names[0], numbers.whole[i],
                         kind->nodes),
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

void XdmfReader::check_count(pugi::xml_node topology, std::size_t n_cells) const {
  const char* const name = topology.attribute("NumberOfElements") ? "NumberOfElements" : "Dimensions";
  const pugi::xml_attribute count = topology.attribute(name);
  if (count && count.value() != std::to_string(n_cells))
    fail(topology, fmt::format("found {} cells, {} says {}", n_cells, name, count.value()));
}

CellList XdmfReader::cells(pugi::xml_node topology) {
  if (topology.attribute("Order"))
    fail(topology, "gives the nodes of a cell an Order of its own", "Write them in XDMF's order");
  const std::string type = attribute(topology, "TopologyType", "Type", "");
  Values numbers = item(topology, true);
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
    if (!width.empty() && width != std::to_string(kind->nodes))
      fail(topology, fmt::format("found {}s of {} nodes, expected {}", type, width, kind->nodes),
           kind->number <= 2 ? "Write each point and each line as a cell of its own" : "Write it again");
    if (numbers.size() % kind->nodes != 0)
      fail(topology,
           fmt::format("found {} numbers of nodes, expected {} for each {}", numbers.size(), kind->nodes, type));
    for (std::size_t i = 0; i < numbers.size(); i += kind->nodes) list.add(*kind, &numbers.whole[i]);
  }
  if (const pugi::xml_attribute base = topology.attribute("BaseOffset")) {
    const std::string first = base.value();
    if (first != "0" && first != "1") fail(topology, fmt::format("found BaseOffset=\"{}\", expected 0 or 1", first));
    if (first == "1")
      for (std::int64_t& node : list.nodes.whole) node = std::max<std::int64_t>(node, 0) - 1;
  }
  check_count(topology, list.ends.size());
  return list;
}

void XdmfReader::read_attribute(pugi::xml_node attribute) {
  const std::string name = named(attribute), centre = attribute.attribute("Center").as_string("Node");
  const bool of_cells = same_name(centre, "Cell");
  if (!of_cells && !same_name(centre, "Node")) {
    lose(fmt::format("Attribute '{}'", name), fmt::format("numbers of each {}", centre));
    return;
  }
  const Values values = item(attribute);
  at(attribute, [&] { grid_.add_data(of_cells, name, values, of_cells ? cells_ : points_); });
}

void XdmfReader::read_set(pugi::xml_node set) {
  const std::string name = named(set), type = attribute(set, "SetType", "Type", "Node");
  if (!same_name(type, "Node") && !same_name(type, "Cell")) {
    lose(fmt::format("Set '{}'", name), fmt::format("of kind {}", type));
    return;
  }
  const Values members = item(set, true);
  at(set, [&] { grid_.add_set(same_name(type, "Cell"), name, members); });
}

void XdmfReader::read_grid(pugi::xml_node grid) {
  const pugi::xml_node geometry = only(grid, "Geometry"), topology = only(grid, "Topology");
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

/// The first step of a series in time. Steps that refer to a mesh elsewhere in the file are no meshes.
void XdmfReader::read_steps(pugi::xml_node collection) {
  long past = 0;
  bool found = false;
  for (const pugi::xml_node step : collection.children("Grid")) {
    if (found || (!step.child("Topology") && !step.child("Geometry"))) {
      ++past;
      continue;
    }
    read_grid(step);
    found = true;
  }
  if (past > 0)
    mesh_.losses.push_back(
        {"Grid", past, found ? "later times of a temporal collection" : "times of a mesh elsewhere"});
}

void XdmfReader::read_grids(pugi::xml_node parent, int depth) {
  constexpr int deepest = 16;
  if (depth > deepest) fail(parent, "found grids within grids, more than 16 deep", "Write them side by side");
  for (const pugi::xml_node child : parent.children()) {
    const std::string_view name = child.name();
    if (name == "xi:include")
      fail(child, "a part stands in another place (xi:include), which is not read",
           "Write the file without references");
    if (name != "Grid") continue;
    const std::string type = attribute(child, "GridType", "Type", "Uniform");
    const std::string collection = child.attribute("CollectionType").as_string("Spatial");
    if (same_name(type, "Uniform"))
      read_grid(child);
    else if (same_name(type, "Collection") && same_name(collection, "Temporal"))
      read_steps(child);
    else if (same_name(type, "Tree") || (same_name(type, "Collection") && same_name(collection, "Spatial")))
      read_grids(child, depth + 1);
    else
      fail(child,
           fmt::format("found a grid of type {}, expected Uniform, Tree or a Collection, Spatial or Temporal",
                       same_name(type, "Collection") ? fmt::format("{} {}", type, collection) : type),
           "Write the mesh as one uniform grid");
  }
}

Mesh XdmfReader::read() {
  pugi::xml_document document;
  const auto result = document.load_buffer(bytes_.data(), bytes_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) fail(result.offset, fmt::format("no well-formed XML: {}", result.description()), "Write it again");
  const pugi::xml_node file = document.child("Xdmf"), domain = file.child("Domain");
  if (!file) throw InputError({mesh_.source}, "has no element Xdmf", "Give an .xdmf file");
  const std::string version = file.attribute("Version").as_string("3.0");
  if (!version.starts_with('2') && !version.starts_with('3'))
    fail(file, fmt::format("found version '{}', expected 2 or 3", version), "Save it as version 3");
  mesh_.format = fmt::format("xdmf {}", version);
  if (!domain) fail(file, "has no Domain");
  only(file, "Domain");
  read_grids(domain, 0);
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
