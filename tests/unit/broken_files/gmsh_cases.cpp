#include <cstdint>
#include <cstring>

#include "fem/formats/gmsh.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string text_22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
1 5 "beam"
$EndPhysicalNames
$Nodes
3
1 0 0 0
2 1 0 0
3 2 0 0
$EndNodes
$Elements
2
1 1 2 5 1 1 2
2 1 2 5 1 2 3
$EndElements
)";

const std::string text_40 = R"($MeshFormat
4 0 8
$EndMeshFormat
$PhysicalNames
1
1 5 "beam"
$EndPhysicalNames
$Entities
0 1 0 0
1 0 0 0 2 0 0 1 5 0
$EndEntities
$Nodes
1 3
1 1 0 3
1 0 0 0
2 1 0 0
3 2 0 0
$EndNodes
$Elements
1 2
1 1 1 2
1 1 2
2 2 3
$EndElements
)";

const std::string text_41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
1 5 "beam"
$EndPhysicalNames
$Entities
0 1 0 0
1 0 0 0 2 0 0 1 5 0
$EndEntities
$Nodes
1 3 1 3
1 1 0 3
1
2
3
0 0 0
1 0 0
2 0 0
$EndNodes
$Elements
1 2 1 2
1 1 1 2
1 1 2
2 2 3
$EndElements
)";

template <class T>
std::string raw(std::initializer_list<T> values, bool swapped) {
  std::string bytes;
  for (const T value : values) {
    std::string one(sizeof value, '\0');
    std::memcpy(one.data(), &value, sizeof value);
    bytes += swapped ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

/// The same line of two elements as binary 4.1.
std::string binary_41(bool swapped, std::uint64_t nodes = 3, double x = 1.0, std::uint64_t last = 3) {
  using I = std::int32_t;
  using S = std::uint64_t;
  return "$MeshFormat\n4.1 1 8\n" + raw<I>({1}, swapped) + "\n$EndMeshFormat\n$Nodes\n" +
         raw<S>({1, 3, 1, 3}, swapped) + raw<I>({1, 1, 0}, swapped) + raw<S>({nodes, 1, 2, 3}, swapped) +
         raw<double>({0, 0, 0, x, 0, 0, 2, 0, 0}, swapped) + "\n$EndNodes\n$Elements\n" +
         raw<S>({1, 2, 1, 2}, swapped) + raw<I>({1, 1, 1}, swapped) + raw<S>({2, 1, 1, 2, 2, 2, last}, swapped) +
         "\n$EndElements\n";
}

std::string binary_22(bool swapped, std::int32_t nodes = 3, double x = 1.0, std::int32_t last = 3) {
  using I = std::int32_t;
  std::string bytes =
      "$MeshFormat\n2.2 1 8\n" + raw<I>({1}, swapped) + "\n$EndMeshFormat\n$Nodes\n" + std::to_string(nodes) + "\n";
  for (const std::int32_t i : {1, 2, 3})
    bytes += raw<I>({i}, swapped) + raw<double>({i == 2 ? x : i - 1.0, 0, 0}, swapped);
  return bytes + "\n$EndNodes\n$Elements\n2\n" + raw<I>({1, 2, 2, 1, 5, 1, 1, 2, 2, 5, 1, 2, last}, swapped) +
         "\n$EndElements\n";
}

void add_counts_and_ids(std::vector<Case>& cases) {
  const char* const huge = "9000000000000000000";
  for (const char* count : {huge, "-1", "4", "2147483648", "1e3"})
    cases.push_back({std::string("2.2: nodes ") + count,
                     replaced(text_22, "$Nodes\n3", std::string("$Nodes\n") + count),
                     {"$Nodes"}});
  for (const char* count : {huge, "-1", "3", "4294967296", ""})
    cases.push_back({std::string("2.2: elements ") + count,
                     replaced(text_22, "$Elements\n2", std::string("$Elements\n") + count),
                     {"$Elements"}});
  cases.push_back({"2.2: fewer nodes declared", replaced(text_22, "$Nodes\n3", "$Nodes\n2"), {"expected $EndNodes"}});
  cases.push_back(
      {"2.2: fewer elements declared", replaced(text_22, "$Elements\n2", "$Elements\n1"), {"expected $EndElements"}});
  cases.push_back({"2.2: node twice", replaced(text_22, "2 1 0 0\n", "1 1 0 0\n"), {"bad.msh:11:1", "node 1"}});
  cases.push_back({"2.2: unknown node", replaced(text_22, "1 2 3\n", "1 2 9\n"), {"names node 9"}});
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "0x10", "1,5", "1d0"})
    for (const auto& [format, text, heading] :
         {std::tuple{"2.2", text_22, "2 1 0 0\n"}, {"4.0", text_40, "2 1 0 0\n"}, {"4.1", text_41, "\n1 0 0\n2 0 0\n"}})
      cases.push_back({std::string(format) + ": coordinate " + bad,
                       replaced(text, heading, replaced(heading, "1 0 0", std::string(bad) + " 0 0")),
                       {"expected the x coordinate"}});
  for (const auto& [format, text] : {std::pair{"4.0", text_40}, {"4.1", text_41}}) {
    const std::string f = format, nodes = f == "4.0" ? "$Nodes\n1 3" : "$Nodes\n1 3 1 3";
    const std::string elements = f == "4.0" ? "$Elements\n1 2" : "$Elements\n1 2 1 2";
    for (const char* count : {huge, "-1", "2"})
      cases.push_back({f + ": node blocks " + count,
                       replaced(text, nodes, "$Nodes\n" + std::string(count) + nodes.substr(8)),
                       {"bad.msh", "Nodes"}});
    for (const char* count : {huge, "-1", "2"})
      cases.push_back({f + ": element blocks " + count,
                       replaced(text, elements, "$Elements\n" + std::string(count) + elements.substr(11)),
                       {"bad.msh", "Elements"}});
    for (const char* count : {huge, "-1", "4", "2"})
      cases.push_back({f + ": nodes of a block " + count,
                       replaced(text, "1 1 0 3\n", "1 1 0 " + std::string(count) + "\n"),
                       {"in $Nodes"}});
    for (const char* count : {huge, "-1", "3", "1"})
      cases.push_back({f + ": elements of a block " + count,
                       replaced(text, "1 1 1 2\n", "1 1 1 " + std::string(count) + "\n"),
                       {"in $Elements"}});
    cases.push_back({f + ": unknown node", replaced(text, "2 2 3\n", "2 2 9\n"), {"node 9"}});
    cases.push_back({f + ": unknown cell type", replaced(text, "1 1 1 2\n", "1 1 99 2\n"), {"found element type 99"}});
    cases.push_back(
        {f + ": entities " + huge, replaced(text, "0 1 0 0", "0 " + std::string(huge) + " 0 0"), {"$Entities"}});
  }
}

void add_text_oddities(std::vector<Case>& cases) {
  for (const auto& [format, text] : {std::pair{"2.2", text_22}, {"4.0", text_40}, {"4.1", text_41}}) {
    const std::string f = format;
    cases.push_back({.name = f + ": Windows line ends", .bytes = with_windows_ends(text), .reads = true});
    cases.push_back({.name = f + ": tabs", .bytes = replaced(text, "1 5 \"", "1\t5\t\""), .reads = true});
    cases.push_back({f + ": byte order mark of UTF-8", "\xEF\xBB\xBF" + text, {"bad.msh:1:1"}});
    std::string wide;
    for (const char c : text) wide += {c, '\0'};
    cases.push_back({f + ": UTF-16", "\xFF\xFE" + wide, {"bad.msh:1:1"}});
    cases.push_back({f + ": compressed", "\x1f\x8b\x08" + text, {"bad.msh:1:1"}});
    cases.push_back({f + ": format twice", text + text, {"second $MeshFormat"}});
    cases.push_back({f + ": no end of $Nodes", replaced(text, "$EndNodes\n", ""), {"$Elements"}});
    cases.push_back({f + ": another end", replaced(text, "$EndNodes", "$EndElements"), {"expected $EndNodes"}});
    cases.push_back(
        {f + ": unknown version", replaced(text, f == "4.0" ? "4 0 8" : f + " 0 8", "9.9 0 8"), {"found version 9.9"}});
    cases.push_back({f + ": said to be binary", replaced(text, " 0 8", " 1 8"), {f == "4.0" ? "binary" : "expected"}});
  }
  cases.push_back({"empty", "", {"empty"}});
  cases.push_back({"blanks alone", " \n\t\n", {"bad.msh"}});
  cases.push_back({"no nodes", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", {"$Nodes"}});
  cases.push_back({"empty $Nodes", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n$EndNodes\n", {"number of nodes"}});
}

void add_binary(std::vector<Case>& cases) {
  for (const bool swapped : {false, true}) {
    const std::string order = swapped ? " big-endian" : " little-endian";
    for (const auto& [format, whole] : {std::pair{"4.1", binary_41(swapped)}, {"2.2", binary_22(swapped)}}) {
      const std::string f = format + order;
      cases.push_back({.name = f, .bytes = whole, .reads = true});
      for (std::size_t n = 20; n + 2 < whole.size(); n += 23)
        cases.push_back({f + " cut after " + std::to_string(n), whole.substr(0, n), {"bad.msh"}});
      cases.push_back({.name = f + " with Windows line ends", .bytes = with_windows_ends(whole), .reads = true});
    }
    const double nan = std::nan("");
    cases.push_back({"4.1" + order + " nan", binary_41(swapped, 3, nan), {"byte offset", "found nan"}});
    cases.push_back({"2.2" + order + " nan", binary_22(swapped, 3, nan), {"byte offset", "found nan"}});
    cases.push_back({"4.1" + order + " huge", binary_41(swapped, std::uint64_t{1} << 62), {"in $Nodes"}});
    cases.push_back({"2.2" + order + " huge", binary_22(swapped, 2000000000), {"in $Nodes"}});
    cases.push_back({"4.1" + order + " unknown node", binary_41(swapped, 3, 1.0, 9), {"node 9"}});
    cases.push_back({"2.2" + order + " unknown node", binary_22(swapped, 3, 1.0, 9), {"node 9"}});
  }
}

}  // namespace

Family gmsh_cases() {
  Family family{"bad.msh", [](const std::filesystem::path& file) { fem::read_gmsh(file); }, {}};
  for (const auto& [format, text] : {std::pair{"2.2", text_22}, {"4.0", text_40}, {"4.1", text_41}}) {
    family.cases.push_back({.name = std::string(format) + ": sound", .bytes = text, .reads = true});
    add_words_for_numbers(family.cases, format, text, numbers_of(text));
    add_cuts(family.cases, format, text, 1);
  }
  add_counts_and_ids(family.cases);
  add_text_oddities(family.cases);
  add_binary(family.cases);
  return family;
}

}  // namespace tenon::broken
