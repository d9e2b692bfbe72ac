#include <bit>
#include <cstdint>
#include <cstring>

#include "fem/formats/read_vtu.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string vtu_text = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">
<UnstructuredGrid>
<Piece NumberOfPoints="3" NumberOfCells="2">
<PointData>
<DataArray type="Float64" Name="T" format="ascii">7 8 9</DataArray>
</PointData>
<CellData>
<DataArray type="Int32" Name="part" format="ascii">5 6</DataArray>
</CellData>
<Points>
<DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 2 0 0</DataArray>
</Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 1 2</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">2 4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">3 3</DataArray>
</Cells>
</Piece>
</UnstructuredGrid>
</VTKFile>
)";

struct VtuChange {
  const char *from, *to, *says;
  long line;  ///< of the element at fault, whose name stands in column 2; 0: not said, −1: reads
};

constexpr VtuChange of_text[] = {
    {"UnstructuredGrid\" v", "PolyData\" v", "found a file of type 'PolyData'", 2},
    {"type=\"UnstructuredGrid\" ", "", "found a file of type ''", 2},
    {"LittleEndian", "MiddleEndian", "found byte_order 'MiddleEndian'", 2},
    {"version=\"1.0\" b", "header_type=\"UInt16\" b", "found header_type 'UInt16'", 2},
    {"version=\"1.0\" b", "compressor=\"vtkLZMADataCompressor\" b", "found the compressor 'vtkLZMADataCompressor'", 2},
    {"<VTKFile", "<VTKfile", "no well-formed XML", 0},
    {"<?xml version=\"1.0\"?>\n<VTKFile", "<VTKFile type=\"UnstructuredGrid\"/><VTKFile", "a second VTKFile", 0},
    {"</UnstructuredGrid>", "</UnstructuredGrid><UnstructuredGrid/>", "second UnstructuredGrid", 0},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"2\"", "found 9 coordinates for 2 points", 12},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"4\"", "found 9 coordinates for 4 points", 12},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"2147483647\"", "found 9 coordinates for 2147483647 points", 12},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"2147483648\"", "found NumberOfPoints=\"2147483648\"", 4},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"99999999999999999999\"", "found NumberOfPoints=", 4},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"-3\"", "found NumberOfPoints=\"-3\"", 4},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"3.0\"", "found NumberOfPoints=\"3.0\"", 4},
    {"NumberOfPoints=\"3\"", "NumberOfPoints=\"\"", "found NumberOfPoints=\"\"", 4},
    {"NumberOfPoints=\"3\" ", "", "found NumberOfPoints=\"\"", 4},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"1\"", "found 2 offsets and 2 types for 1 cells", 14},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"3\"", "found 2 offsets and 2 types for 3 cells", 14},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"0\"", "found 2 offsets and 2 types for 0 cells", 14},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"2147483647\"", "for 2147483647 cells", 14},
    {"NumberOfCells=\"2\"", "NumberOfCells=\"two\"", "found NumberOfCells=\"two\"", 4},
    {"0 0 0 1", "0 0 0 nan", "point 1 is not finite", 12},
    {"0 0 0 1", "0 0 0 -inf", "point 1 is not finite", 12},
    {"0 0 0 1", "0 0 0 1e999", "found '1e999' in place of value 4", 12},
    {"0 0 0 1", "0,0,0,1", "found '0,0,0,1' in place of value 1", 12},
    {"0 0 0 1", "0 0 0", "found 8 coordinates for 3 points", 12},
    {"0 0 0 1", "0 0 0 0 1", "found 10 coordinates for 3 points", 12},
    {">0 0 0 1 0 0 2 0 0<", "><", "found 0 coordinates for 3 points", 12},
    {">0 0 0 1 0 0 2 0 0<", ">&x;<", "found '&x;' in place of value 1", 12},
    {"type=\"Float64\" Name=\"Points\"", "type=\"Float80\" Name=\"Points\"", "has type 'Float80'", 12},
    {"type=\"Float64\" Name=\"Points\"", "Name=\"Points\"", "has type ''", 12},
    {"<Points>\n", "<Points>\n<DataArray type=\"Float64\">0 0 0 0 0 0 0 0 0</DataArray>\n", "more than one DataArray",
     11},
    {"</Points>", "</Points><Points/>", "a second Points", 0},
    {"</Cells>", "</Cells><Cells/>", "a second Cells", 0},
    {"</PointData>", "</PointData><PointData/>", "a second PointData", 0},
    {"format=\"ascii\">0 0", "format=\"text\">0 0", "found format 'text'", 12},
    {"format=\"ascii\">0 0", "format=\"appended\">0 0", "found offset=\"\"", 12},
    {"connectivity", "connection", "the cells have no array 'connectivity'", 14},
    {"offsets", "ends", "the cells have no array 'offsets'", 14},
    {"types", "kinds", "the cells have no array 'types'", 14},
    {"\"types\"", "\"offsets\"", "a second array 'offsets'", 14},
    {"Int64\" Name=\"connectivity", "Float64\" Name=\"connectivity", "found cells made of reals", 14},
    {"0 1 1 2", "0 1 1 3", "cell 1 names point 3 of 3", 14},
    {"0 1 1 2", "0 1 1 -1", "cell 1 names point -1 of 3", 14},
    {"0 1 1 2", "0 1 1 4294967298", "cell 1 names point 4294967298 of 3", 14},
    {"0 1 1 2", "0 1 1 99999999999999999999", "found '99999999999999999999' in place of value 4", 15},
    {"0 1 1 2", "0 1 1 1.5", "found '1.5' in place of value 4", 15},
    {"0 1 1 2", "0 1 1", "cell 1 ends at 4 after 2", 14},
    {"0 1 1 2", "0 1 1 2 2", "the 2 cells take 4 of 5 nodes", 14},
    {">2 4<", ">2<", "found 1 offsets and 2 types for 2 cells", 14},
    {">2 4<", ">4 2<", "cell 0 ends at 4 after 0", 14},
    {">2 4<", ">0 2<", "cell 0 ends at 0 after 0", 14},
    {">2 4<", ">2 9<", "cell 1 ends at 9 after 2", 14},
    {">2 4<", ">-2 4<", "cell 0 ends at -2 after 0", 14},
    {">2 4<", ">9223372036854775807 4<", "cell 0 ends at 9223372036854775807", 14},
    {">3 3<", ">3 5<", "cell 1 ends at 4 after 2, expected 3 nodes of a triangle", 14},
    {">3 3<", ">3 7<", "cell 1 has VTK's type 7, which is not read", 14},
    {">3 3<", ">3 42<", "cell 1 has VTK's type 42, which is not read", 14},
    {">3 3<", ">3 0<", "cell 1 has VTK's type 0, which is not read", 14},
    {">3 3<", ">3<", "found 2 offsets and 1 types for 2 cells", 14},
    {"\"part\"", "\"vtkGhostType\"", "some cells are ghosts", 9},
    {">5 6<", ">5<", "the array 'part' holds 1 values for 2 cells", 9},
    {">7 8 9<", ">7 8<", "the array 'T' holds 2 values for 3 points", 6},
    {"<PointData>\n", "<PointData>\n<DataArray type=\"Float64\" Name=\"T\">1 2 3</DataArray>\n",
     "found a second array 'T'", 7},
    {"<Cells>", "<Cell>", "no well-formed XML", 0},
    {"Name=\"T\"", "Name=\"T\" Name=\"T", "no well-formed XML", 0},
    // odd, not wrong
    {">7 8 9<", ">nan inf -inf<", "", -1},
    {">5 6<", ">\n\t5\n\t6\n<", "", -1},
    {"<Points>", "<!-- points --><Points>", "", -1},
    {"Name=\"T\"", "Name='T' RangeMin='7'", "", -1},
    {"UInt8", "Int32", "", -1},
    {"<UnstructuredGrid>", "<UnstructuredGrid><FieldData><DataArray type=\"String\" Name=\"n\"/></FieldData>", "", -1},
    {"<UnstructuredGrid>", "<UnstructuredGrid><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>", "", -1},
    {"<PointData>", "<PointData><DataArray type=\"String\" Name=\"names\" format=\"ascii\">65 0</DataArray>", "", -1},
};

void add_changes(std::vector<Case>& cases) {
  for (const VtuChange& c : of_text) {
    Case& added = cases.emplace_back();
    added.name = std::string("'") + c.from + "' made '" + c.to + "'";
    added.bytes = replaced(vtu_text, c.from, c.to);
    added.says = {c.says};
    if (c.line > 0) added.place = std::pair{c.line, 2L};
    added.reads = c.line < 0;
  }
}

/// Little-endian bytes.
template <class T>
std::string bytes_of(T value) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  if constexpr (std::endian::native == std::endian::big) raw.assign(raw.rbegin(), raw.rend());
  return raw;
}

std::string u32(std::uint32_t value) { return bytes_of(value); }

std::string base64(const std::string& data) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < data.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < data.size() ? static_cast<unsigned char>(data[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > data.size() ? '=' : digits[bits >> (18 - 6 * k) & 63U];
  }
  return out;
}

/// A zlib stream of one stored block (RFC 1950, 1951), ended by the Adler-32 sum of the data.
std::string stored(const std::string& data) {
  std::uint32_t a = 1, b = 0;
  for (const char c : data) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint16_t>(data.size());
  const std::string sum = u32(b << 16 | a);
  return "\x78\x01\x01" + bytes_of(size) + bytes_of(static_cast<std::uint16_t>(~size)) + data +
         std::string(sum.rbegin(), sum.rend());
}

std::string coordinates() {
  std::string data;
  for (const double x : {0., 0., 0., 1., 0., 0., 2., 0., 0.}) data += bytes_of(x);
  return data;
}

const std::string text_points = "format=\"ascii\">0 0 0 1 0 0 2 0 0<";

std::string appended(const std::string& data, const std::string& encoding = "raw", const std::string& offset = "0") {
  const std::string text = replaced(vtu_text, text_points, "format=\"appended\" offset=\"" + offset + "\"><");
  return replaced(text, "</VTKFile>",
                  "<AppendedData encoding=\"" + encoding + "\">\n_" + data + "\n</AppendedData>\n</VTKFile>");
}

std::string zlib(const std::string& text) {
  return replaced(text, "version=\"1.0\" b", "compressor=\"vtkZLibDataCompressor\" b");
}

void add_encoded(std::vector<Case>& cases) {
  const std::string x = coordinates(), sound = u32(72) + x;
  const auto at_points = [&](const char* name, const std::string& bytes, const char* says) {
    cases.push_back({name, bytes, {says}, {{12, 2}}});
  };
  cases.push_back({.name = "raw", .bytes = appended(sound), .reads = true});
  at_points("raw: size beyond the file", appended(u32(0xffffffff) + x), "needs 4294967295 more bytes");
  at_points("raw: size not of whole numbers", appended(u32(71) + x), "holds 71 bytes, no whole number of values of 8");
  at_points("raw: a number missing", appended(u32(64) + x), "found 8 coordinates for 3 points");
  at_points("raw: size 0", appended(u32(0) + x), "found 0 coordinates for 3 points");
  at_points("raw: offset beyond the data", appended(sound, "raw", "999"), "found offset=\"999\"");
  at_points("raw: offset at the end", appended(sound, "raw", "77"), "needs 4 more bytes, at most 0 are left");
  at_points("raw: offset negative", appended(sound, "raw", "-1"), "found offset=\"-1\"");
  at_points("raw: offset too large", appended(sound, "raw", "99999999999999999999"), "found offset=");
  at_points("raw: offset of a word", appended(sound, "raw", "none"), "found offset=\"none\"");
  at_points("raw: nan",
            appended(u32(72) + x.substr(0, 24) + bytes_of(std::uint64_t{0x7ff8000000000000}) + x.substr(32)),
            "point 1 is not finite");
  at_points("raw: other byte order", replaced(appended(sound), "LittleEndian", "BigEndian"),
            "needs 1207959552 more bytes");
  at_points("raw: longer words in the header",
            replaced(appended(sound), "version=\"1.0\" b", "header_type=\"UInt64\" b"), "needs 72 more bytes");
  cases.push_back({"raw: encoding unknown", appended(sound, "base32"), {"found encoding 'base32'"}, {{21, 2}}});
  cases.push_back({"raw: no underscore", replaced(appended(x.substr(0, 8)), "\n_", "\n"), {"has no '_'"}, {{21, 1}}});
  cases.push_back({"raw: no end", replaced(appended(sound), "</AppendedData>", ""), {"or no end"}, {{21, 1}}});
  const std::string raw = appended(sound);
  for (std::size_t size = 1; size + 12 < raw.size(); size += 11)
    cases.push_back({"raw: cut after byte " + std::to_string(size), raw.substr(0, size), {"bad.vtu"}});

  cases.push_back({.name = "base64 behind the text", .bytes = appended(base64(sound), "base64"), .reads = true});
  const auto inline64 = [&](const std::string& text) {
    return replaced(vtu_text, text_points, "format=\"binary\">" + text + "<");
  };
  const std::string good = base64(sound);
  cases.push_back({.name = "base64", .bytes = inline64("\n  " + good + "\n"), .reads = true});
  cases.push_back({.name = "base64, header alone", .bytes = inline64(base64(u32(72)) + base64(x)), .reads = true});
  at_points("base64: size beyond the text", inline64(base64(u32(4000) + x)), "needs 4000 more bytes");
  at_points("base64: cut", inline64(good.substr(0, 60)), "needs 72 more bytes");
  at_points("base64: cut within four", inline64(good.substr(0, good.size() - 2) + "  "), "ends too early");
  at_points("base64: nothing", inline64(""), "needs 4 more bytes");
  at_points("base64: a foreign character", inline64(replaced(good, "AAAA", "AA*A")), "no base64");
  at_points("base64: an = too early", inline64(replaced(good, "AAAA", "A=AA")), "misplaced '='");

  const std::string packed = stored(x);
  const auto size = static_cast<std::uint32_t>(packed.size());
  const auto blocks = [](std::uint32_t n, std::uint32_t each, std::uint32_t last, std::uint32_t stored_size) {
    return u32(n) + u32(each) + u32(last) + u32(stored_size);
  };
  const std::string heading = blocks(1, 72, 0, size);
  cases.push_back({.name = "zlib", .bytes = zlib(appended(heading + packed)), .reads = true});
  at_points("zlib: blocks beyond the file", zlib(appended(blocks(0xffffffff, 72, 0, size) + packed)), "more bytes");
  at_points("zlib: no block", zlib(appended(blocks(0, 72, 0, size) + packed)), "found 0 coordinates for 3 points");
  at_points("zlib: block larger than all numbers", zlib(appended(blocks(1, 80, 0, size) + packed)),
            "block 1 of 1 cannot be decompressed");
  at_points("zlib: block smaller than its numbers", zlib(appended(blocks(1, 64, 0, size) + packed)),
            "block 1 of 1 cannot be decompressed");
  at_points("zlib: block of gigabytes", zlib(appended(blocks(1, 0xffffffff, 0, size) + packed)),
            "more than a hundred times the file");
  at_points("zlib: packed size beyond the file", zlib(appended(blocks(1, 72, 0, 60000) + packed)),
            "needs 60000 more bytes");
  at_points("zlib: packed size too small", zlib(appended(blocks(1, 72, 0, size - 1) + packed)),
            "block 1 of 1 cannot be decompressed");
  for (std::size_t at = 0; at < packed.size(); at += 5) {
    std::string damaged = packed;
    damaged[at] = static_cast<char>(~damaged[at]);
    cases.push_back({"zlib: byte " + std::to_string(at) + " damaged",
                     zlib(appended(heading + damaged)),
                     {"block 1 of 1 cannot be decompressed"},
                     {{12, 2}}});
  }
}

void add_text_oddities(std::vector<Case>& cases) {
  std::string wide, deep;
  for (const char c : vtu_text) wide += {c, '\0'};
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 100000; ++i) deep += "</a>";
  cases.push_back({"empty", "", {"the file is empty"}});
  cases.push_back({"blank", "\n\n", {"bad.vtu"}});
  cases.push_back({"no XML", "# vtk DataFile Version 3.0\n", {"bad.vtu"}});
  cases.push_back({"another XML", "<?xml version=\"1.0\"?>\n<svg/>\n", {"has no element VTKFile"}});
  cases.push_back({"no grid", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>\n", {"has no points or no cells"}});
  cases.push_back({"no piece",
                   "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid/></VTKFile>\n",
                   {"has no points or no cells"}});
  cases.push_back({"UTF-16", "\xFF\xFE" + wide, {"bad.vtu"}});
  cases.push_back({"zero byte", replaced(vtu_text, ">5 6<", std::string(">5 \0 6<", 7)), {"bad.vtu"}});
  cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(vtu_text), .reads = true});
  cases.push_back({.name = "UTF-8 byte order mark", .bytes = "\xEF\xBB\xBF" + vtu_text, .reads = true});
  cases.push_back({.name = "Latin-1 in a comment",
                   .bytes = replaced(vtu_text, "<Cells>", "<!-- Fl\xFCgel --><Cells>"),
                   .reads = true});
  cases.push_back(
      {.name = "elements in elements", .bytes = replaced(vtu_text, "<Cells>", deep + "<Cells>"), .reads = true});
  const std::string nothing =  // as VTK writes a piece that holds none
      "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points><DataArray type=\"Float32\"/></Points><Cells>"
      "<DataArray type=\"Int64\" Name=\"connectivity\"/><DataArray type=\"Int64\" Name=\"offsets\"/>"
      "<DataArray type=\"UInt8\" Name=\"types\"/></Cells></Piece>";
  cases.push_back({.name = "empty piece",
                   .bytes = replaced(vtu_text, "<UnstructuredGrid>", "<UnstructuredGrid>" + nothing),
                   .reads = true});
  const std::string two =
      replaced(vtu_text, "</UnstructuredGrid>", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"1\"/></UnstructuredGrid>");
  cases.push_back({"second piece without cells", two, {"the piece has no Cells"}});
}

}  // namespace

Family vtu_cases() {
  Family family{"bad.vtu", [](const std::filesystem::path& file) { fem::read_vtu(file); }, {}};
  family.cases.push_back({.name = "sound", .bytes = vtu_text, .reads = true});
  for (const Word& number : numbers_of(vtu_text, "<>")) {
    std::string bytes = vtu_text;
    bytes.replace(number.offset, number.text.size(), "oops");
    family.cases.push_back(
        {"a word for the number at " + std::to_string(number.line) + ":" + std::to_string(number.column),
         bytes,
         {"found 'oops' in place of value"},
         {{number.line, 2}}});
  }
  add_cuts(family.cases, "text", vtu_text, 1);
  add_changes(family.cases);
  add_encoded(family.cases);
  add_text_oddities(family.cases);
  return family;
}

}  // namespace tenon::broken
