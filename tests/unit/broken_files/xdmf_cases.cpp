#include "fem/formats/read_xdmf.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string panel = R"(<?xml version="1.0"?>
<Xdmf Version="3.0">
<Domain>
<Grid Name="panel">
<Geometry GeometryType="XYZ">
<DataItem DataType="Float" Precision="8" Dimensions="5 3" Format="XML">
0 0 0 1 0 0 1 1 0
0 1 0 2 0 0
</DataItem>
</Geometry>
<Topology TopologyType="Mixed" NumberOfElements="3">
<DataItem DataType="Int" Precision="4" Dimensions="13" Format="XML">5 0 1 2 3 4 1 4 2 2 2 0 4</DataItem>
</Topology>
<Attribute Name="T" Center="Node">
<DataItem Dimensions="5">1 2 3 4 5</DataItem>
</Attribute>
<Attribute Name="part" Center="Cell">
<DataItem DataType="Int" Dimensions="3">7 7 8</DataItem>
</Attribute>
<Set Name="root" SetType="Node">
<DataItem DataType="UInt" Dimensions="2">0 3</DataItem>
</Set>
<Set Name="skin" SetType="Cell">
<DataItem DataType="UInt" Dimensions="2">0 1</DataItem>
</Set>
</Grid>
</Domain>
</Xdmf>
)";

const std::string bars = R"(<?xml version="1.0"?>
<Xdmf Version="2.0">
<Domain>
<Grid GridType="Uniform">
<Geometry GeometryType="XY">
<DataItem NumberType="Float" Dimensions="3 2" Format="XML">0 0 1 0 2 0</DataItem>
</Geometry>
<Topology TopologyType="PolyLine" NodesPerElement="2" NumberOfElements="2">
<DataItem NumberType="UInt" Dimensions="2 2" Format="XML">0 1 1 2</DataItem>
</Topology>
</Grid>
</Domain>
</Xdmf>
)";

struct XdmfChange {
  const char *from, *to, *says;
  long line;  ///< of the element at fault; 0: not said, −1: the file is read
};

constexpr XdmfChange of_panel[] = {
    {"</Domain>", "</Domian>", "no well-formed XML", 0},
    {"<Xdmf Version=\"3.0\">", "<Xdmf Version=\"3.0\"", "no well-formed XML", 0},
    {"Version=\"3.0\"", "Version=\"4.0\"", "found version '4.0', expected 2 or 3", 2},
    {"Version=\"3.0\"", "Version=\"\"", "found version '', expected 2 or 3", 2},
    {"XYZ", "VXVYVZ", "found the geometry VXVYVZ, expected XYZ or XY", 5},
    {"XYZ", "ORIGIN_DXDYDZ", "found the geometry ORIGIN_DXDYDZ", 5},
    {"XYZ", "xyz", "", -1},
    {"5 3\"", "5 4\"", "holds 15 numbers, its Dimensions say 20", 6},
    {"5 3\"", "4 3\"", "holds 15 numbers, its Dimensions say 12", 6},
    {"5 3\"", "-5 3\"", "has Dimensions=\"-5 3\", expected whole numbers", 6},
    {"5 3\"", "5 x\"", "has Dimensions=\"5 x\", expected whole numbers", 6},
    {"5 3\"", "\"", "has no Dimensions", 6},
    {"5 3\"", "99999999999 99999999999\"", "expected whole numbers", 6},
    {"5 3\"", "99999999999999999999\"", "expected whole numbers", 6},
    {"5 3\"", "5,3\"", "has Dimensions=\"5,3\", expected whole numbers", 6},
    {"5 3\"", "15\"", "", -1},
    {"1 0 0 1 1 0", "1 0 0 1 1", "holds 14 numbers", 6},
    {"1 0 0 1 1 0", "1 0 O 1 1 0", "found 'O' in place of value 6", 6},
    {"1 0 0 1 1 0", "1 0 1e999 1 1 0", "found '1e999' in place of value 6", 6},
    {"1 0 0 1 1 0", "1 0 nan 1 1 0", "point 1 is not finite", 5},
    {"1 0 0 1 1 0", "1 0 inf 1 1 0", "point 1 is not finite", 5},
    {"Format=\"XML\"", "Format=\"JSON\"", "has Format=\"JSON\", expected XML, HDF or Binary", 6},
    {"Format=\"XML\"", "Format=\"HDF\"", "expected FILE.h5:/DATASET", 6},
    {"Format=\"XML\"", "Format=\"Binary\"", "the DataItem", 6},
    {"Format=\"XML\"", "ItemType=\"HyperSlab\"", "is of ItemType HyperSlab, which is not read", 6},
    {"Format=\"XML\"", "ItemType=\"Function\"", "is of ItemType Function, which is not read", 6},
    {"Format=\"XML\"", "Reference=\"/Xdmf/Domain/DataItem\"", "refers to '/Xdmf/Domain/DataItem', which is no path", 6},
    {"Format=\"XML\"", "Reference=\"DataItem\"", "refers to 'DataItem', which is no path", 6},
    {"Format=\"XML\"", "Reference=\"/Xdmf/Domain/Grid\"", "which is no path to a DataItem", 6},
    {"Format=\"XML\"", "Reference=\"/Xdmf/Domain/Grid/Geometry/DataItem\"", "refers on and on", 6},
    {"Format=\"XML\"", "Reference=\"/Xdmf/Domain/Grid[x]/Geometry\"", "which is no path", 6},
    {"DataType=\"Float\" Precision=\"8\"", "DataType=\"Real\"", "has numbers of type Real with Precision 4", 6},
    {"DataType=\"Float\" Precision=\"8\"", "Precision=\"3\"", "has numbers of type Float with Precision 3", 6},
    {"DataType=\"Float\" Precision=\"8\"", "Precision=\"2\"", "has numbers of type Float with Precision 2", 6},
    {"DataType=\"Float\" Precision=\"8\"", "DataType=\"String\"", "has numbers of type String", 6},
    {"Mixed", "3DCoRectMesh", "found the topology '3DCoRectMesh', which is not read", 11},
    {"Mixed", "2DSMesh", "found the topology '2DSMesh', which is not read", 11},
    {"Mixed", "Hexahedron_64", "found the topology 'Hexahedron_64', which is not read", 11},
    {"Mixed", "", "found the topology '', which is not read", 11},
    {"Mixed", "Quadrilateral", "found 13 numbers of nodes, expected 4 for each Quadrilateral", 11},
    {"Mixed\"", "Mixed\" Order=\"0 2 1\"", "gives the nodes of a cell an Order of its own", 11},
    {"Mixed\"", "Mixed\" BaseOffset=\"two\"", "found BaseOffset=\"two\", expected 0 or 1", 11},
    {"Mixed\"", "Mixed\" BaseOffset=\"1\"", "cell 0 names point -1 of 5", 11},
    {"NumberOfElements=\"3\"", "NumberOfElements=\"4\"", "found 3 cells, NumberOfElements says 4", 11},
    {"NumberOfElements=\"3\"", "Dimensions=\"2\"", "found 3 cells, Dimensions says 2", 11},
    {"NumberOfElements=\"3\"", "", "", -1},
    {"DataType=\"Int\" Precision=\"4\"", "DataType=\"Float\"", "found cells made of reals", 11},
    {"DataType=\"Int\" Precision=\"4\"", "", "", -1},
    {"5 0 1 2 3", "5 0 1 2 9", "cell 0 names point 9 of 5", 11},
    {"5 0 1 2 3", "5 0 1 2 -3", "cell 0 names point -3 of 5", 11},
    {"5 0 1 2 3", "5 0 1 2 3.5", "found '3.5' in place of value 5", 12},
    {"5 0 1 2 3", "17 0 1 2 3", "cell 0 is of XDMF's type 17, which is not read", 11},
    {"5 0 1 2 3", "-5 0 1 2 3", "cell 0 is of XDMF's type -5, which is not read", 11},
    {"5 0 1 2 3", "9 0 1 2 3", "found 2 cells, NumberOfElements says 3", 11},
    {"2 2 0 4", "2 3 0 4", "cell 2 is a Polyline of 3 nodes, expected 2", 11},
    {"2 2 0 4", "2 -2 0 4", "cell 2 is a Polyline of -2 nodes, expected 2", 11},
    {"2 2 0 4", "1 2 0 4", "cell 2 is a Polyvertex of 2 nodes, expected 1", 11},
    {"2 2 0 4", "3 2 0 4", "cell 2 is of XDMF's type 3, which is not read", 11},
    {"2 2 0 4", "5 2 0 4", "cell 2, a Quadrilateral, lacks nodes", 11},
    {"Dimensions=\"13\" Format=\"XML\">5 0 1 2 3 4 1 4 2 2 2 0 4", "Dimensions=\"10\">5 0 1 2 3 4 1 4 2 2",
     "cell 2, a Polyline, lacks nodes", 11},
    {"Center=\"Node\"", "Center=\"Cell\"", "the array 'T' holds 5 values for 3 cells", 14},
    {"Center=\"Cell\"", "Center=\"Node\"", "the array 'part' holds 3 values for 5 points", 17},
    {"Center=\"Node\"", "Center=\"Grid\"", "", -1},
    {"Center=\"Node\"", "Center=\"Face\"", "", -1},
    {"Name=\"T\"", "", "Attribute has no Name", 14},
    {"Name=\"root\"", "", "Set has no Name", 20},
    {"<DataItem Dimensions=\"5\">1 2 3 4 5</DataItem>\n", "", "Attribute has no DataItem", 14},
    {"1 2 3 4 5</DataItem>", "1 2 3 4 5</DataItem><DataItem/>", "found a second DataItem in Attribute", 0},
    {"7 7 8", "7 7", "holds 2 numbers, its Dimensions say 3", 18},
    {"7 7 8", "7 7 8.5", "found '8.5' in place of value 3", 18},
    {"7 7 8", "7 7 99999999999999999999", "found '99999999999999999999' in place of value 3", 18},
    {"0 3<", "0 5<", "the set 'root' names 5 of 5 points", 20},
    {"0 3<", "-1 3<", "the set 'root' names -1 of 5 points", 20},
    {"0 1<", "0 3<", "the set 'skin' names 3 of 3 cells", 23},
    {"SetType=\"Cell\"", "SetType=\"Face\"", "", -1},
    {"UInt", "Float", "the set 'root' holds reals, expected whole numbers", 20},
    {"<Grid Name=\"panel\">", "<Grid GridType=\"Subset\">", "found a grid of type Subset", 4},
    {"<Grid Name=\"panel\">", "<Grid GridType=\"Collection\" CollectionType=\"Other\">",
     "found a grid of type Collection Other", 4},
    {"<Grid Name=\"panel\">", "<Grid GridType=\"Collection\">", "has no points or no cells", 0},
    {"<Grid Name=\"panel\">", "<Grid GridType=\"Tree\">", "has no points or no cells", 0},
    {"<Grid Name=\"panel\">", "<Grid><Topology/><Topology/><Geometry/>", "found a second ", 0},
    {"<Grid Name=\"panel\">", "<Grid><Geometry/>", "found a second Geometry in Grid", 0},
};

constexpr XdmfChange of_bars[] = {
    {"PolyLine", "Triangle", "found Triangles of 2 nodes, expected 3", 8},
    {"NodesPerElement=\"2\"", "NodesPerElement=\"3\"", "found PolyLines of 3 nodes, expected 2", 8},
    {"NodesPerElement=\"2\"", "", "", -1},
    {"PolyLine", "POLYLINE", "", -1},
    {"NumberType=\"UInt\"", "NumberType=\"Float\"", "found cells made of reals", 8},
    {"0 1 1 2", "0 1 1 3", "cell 1 names point 3 of 3", 8},
    {"3 2\"", "6\"", "", -1},
    {"\"3 2\" Format=\"XML\">0 0 1 0 2 0", "\"5\">0 0 1 0 2", "found 5 coordinates, expected two of each point", 5},
    {"<Geometry GeometryType=\"XY\">", "<Geometry>", "cell 1 names point 2 of 2", 8},
    {"GeometryType=\"XY\"", "GeometryType=\"X_Y\"", "found the geometry X_Y", 5},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"HDF\">no.h5:/x", "names the file 'no.h5', which is not there", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"HDF\">../no.h5:/x", "does not lie in the folder of the mesh", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"HDF\">/etc/passwd:/x", "does not lie in the folder of the mesh", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"HDF\">text.h5:/x", "is no HDF5 file", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"HDF\">text.h5", "expected FILE.h5:/DATASET", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"HDF\">text.h5:", "expected FILE.h5:/DATASET", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\">text.h5", "needs 24 bytes from 0 on, 'text.h5' has 20", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\" Seek=\"21\">text.h5",
     "needs 24 bytes from 21 on, 'text.h5' has 20", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\" Seek=\"-1\">text.h5", "has Seek=\"-1\"", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\" Endian=\"Middle\">text.h5", "has Endian=\"Middle\"", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\" Compression=\"Zlib\">text.h5", "has Compression=\"Zlib\"", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\">../text.bin", "does not lie in the folder of the mesh", 6},
    {"Format=\"XML\">0 0 1 0 2 0", "Format=\"Binary\">", "names the file ''", 6},
};

template <std::size_t n>
void add_changes(Family& family, const std::string& text, const XdmfChange (&changes)[n]) {
  for (const XdmfChange& c : changes) {
    Case& added = family.cases.emplace_back();
    added.name = std::string("'") + c.from + "' made '" + c.to + "'";
    added.bytes = replaced(text, c.from, c.to);
    added.beside = {{"text.h5", "twenty bytes of text"}};
    if (c.line >= 0) added.says = {"bad.xdmf:", c.says};
    if (c.line > 0) added.place = std::pair{c.line, 2L};
    added.reads = c.line < 0;
  }
}

}  // namespace

Family xdmf_cases() {
  Family family{"bad.xdmf", [](const std::filesystem::path& file) { fem::read_xdmf(file); }, {}};
  family.cases.push_back({.name = "empty", .bytes = "", .says = {"the file is empty"}});
  family.cases.push_back({.name = "blank", .bytes = "\n\n\n", .says = {"no well-formed XML"}});
  family.cases.push_back({.name = "another root", .bytes = "<VTKFile/>", .says = {"has no element Xdmf"}});
  family.cases.push_back({.name = "no Domain", .bytes = "<Xdmf/>", .says = {"has no Domain"}});
  family.cases.push_back({.name = "no Grid", .bytes = "<Xdmf><Domain/></Xdmf>", .says = {"has no points or no cells"}});
  family.cases.push_back({.name = "empty Grid",
                          .bytes = "<Xdmf><Domain><Grid/></Domain></Xdmf>",
                          .says = {"the grid '' has no Geometry"}});
  std::string deep = "<Xdmf><Domain>";
  for (int i = 0; i < 100000; ++i) deep += "<Grid GridType=\"Tree\">";
  for (int i = 0; i < 100000; ++i) deep += "</Grid>";
  family.cases.push_back({.name = "grids in grids", .bytes = deep + "</Domain></Xdmf>", .says = {"more than 16 deep"}});
  add_changes(family, panel, of_panel);
  add_changes(family, bars, of_bars);
  add_cuts(family.cases, "panel", panel, 1);
  add_cuts(family.cases, "bars", bars, 1);
  family.cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(panel), .reads = true});
  return family;
}

}  // namespace tenon::broken
