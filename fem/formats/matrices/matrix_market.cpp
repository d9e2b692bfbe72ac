#include "fem/formats/matrices/matrix_market.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <tuple>

#include "fem/error.hpp"
#include "fem/formats/matrices/labels.hpp"
#include "fem/formats/matrices/text.hpp"

namespace tenon::fem {
namespace {

constexpr double round_off = 1e-12;        // of the largest entry of the row: sums over elements in another order
constexpr std::size_t shortest_entry = 6;  // bytes of "1 1 1\n"

/// An entry of the file, brought into the lower triangle.
struct Entry {
  int row = 0, column = 0;
  bool upper = false;
  double value = 0.0;
  std::size_t at = 0;  ///< byte of the file
};

struct Banner {
  bool general = false, integer = false;
};

std::string lower_case(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

Banner read_banner(market::Text& text) {
  Banner banner;
  if (text.word("%%MatrixMarket") != "%%MatrixMarket")
    text.fail(0, "the first line does not begin with %%MatrixMarket", "Name a Matrix Market file (.mtx)");
  const auto one_of = [&](const char* what, std::initializer_list<const char*> good, const std::string& cure) {
    const std::string word = lower_case(text.word(what));
    for (const char* candidate : good)
      if (word == candidate) return word;
    text.fail(text.offset(), fmt::format("{} is {}", what, gmsh::quoted(word)), cure);
  };
  one_of("the object", {"matrix"}, "It must be `matrix`");
  one_of("the format", {"coordinate"}, "Write the matrix sparse: `coordinate`, one line an entry");
  banner.integer =
      one_of("the field", {"real", "integer"},
             "Stiffness and mass are real: a pattern has no values, and complex matrices hold damping") == "integer";
  banner.general = one_of("the symmetry", {"symmetric", "general"}, "Stiffness and mass are symmetric") == "general";
  text.end_line('\n');
  return banner;
}

std::vector<Entry> read_entries(market::Text& text, const Banner& banner, std::size_t n) {
  constexpr long most = std::numeric_limits<int>::max();
  if (!text.next_line('%')) text.fail(text.size(), "the file ends, expected the line of sizes");
  const long rows = text.whole("the number of rows", 1, most), columns = text.whole("the number of columns", 1, most);
  if (rows != columns)
    text.fail(text.offset(), fmt::format("{}×{} is not square", rows, columns), "Give K and M whole");
  if (static_cast<std::size_t>(rows) != n)
    text.fail(text.offset(), fmt::format("the matrix has {} rows and the label file {}", rows, n),
              "The label file holds one line a row");
  const long count = text.whole("the number of entries", 0, std::numeric_limits<long>::max());
  text.end_line('\n');
  std::vector<Entry> entries;
  entries.reserve(std::min(static_cast<std::size_t>(count), text.size() / shortest_entry));
  for (long k = 0; k < count; ++k) {
    if (!text.next_line('%')) text.fail(text.size(), fmt::format("the file ends after {} of {} entries", k, count));
    const auto i = static_cast<int>(text.whole("a row", 1, rows)) - 1;
    const std::size_t at = text.offset();
    const auto j = static_cast<int>(text.whole("a column", 1, rows)) - 1;
    const double value = text.real("a value");
    if (banner.integer && value != std::floor(value))
      text.fail(text.offset(), fmt::format("found {}, expected a whole number", value), "Call the field `real`");
    text.end_line('\n');
    entries.push_back({std::max(i, j), std::min(i, j), i < j, value, at});
  }
  if (text.next_line('%')) {
    text.word("nothing");
    text.fail(text.offset(), fmt::format("there is more after the {} entries that the file declares", count));
  }
  return entries;
}

std::string label(const MatrixRow& row) {
  static constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
  return row.scalar ? fmt::format("scalar {}", row.node)
                    : fmt::format("node {} {}", row.node, directions.at(static_cast<std::size_t>(row.direction)));
}

}  // namespace

SparseMatrix read_matrix_market(const std::filesystem::path& path, const std::vector<MatrixRow>& rows) {
  market::Text text(path, "The file is damaged or was cut short: write it again");
  const Banner banner = read_banner(text);
  std::vector<Entry> entries = read_entries(text, banner, rows.size());
  const auto order = [](const Entry& e) { return std::tuple(e.column, e.row, e.upper); };
  std::ranges::sort(entries, {}, order);
  std::vector<double> largest(rows.size(), 0.0);
  for (const Entry& e : entries)
    for (const int i : {e.row, e.column})
      largest[static_cast<std::size_t>(i)] = std::max(largest[static_cast<std::size_t>(i)], std::abs(e.value));

  std::vector<Eigen::Triplet<double>> lower;
  lower.reserve(entries.size());
  double worst = 0.0;
  std::string fault;
  std::size_t fault_at = 0;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Entry& e = entries[k];
    const Entry* partner = k + 1 < entries.size() && entries[k + 1].row == e.row && entries[k + 1].column == e.column
                               ? &entries[k + 1]
                               : nullptr;
    if (partner && (partner->upper == e.upper || !banner.general))
      text.fail(std::max(e.at, partner->at), fmt::format("the entry ({}, {}) is given twice", e.row + 1, e.column + 1),
                banner.general ? "Write each entry once, summed" : "A symmetric file holds one triangle");
    double value = e.value;
    if (banner.general && e.row != e.column) {
      const double other = partner ? partner->value : 0.0;
      const double scale =
          std::max(largest[static_cast<std::size_t>(e.row)], largest[static_cast<std::size_t>(e.column)]);
      const double gap = scale > 0.0 ? std::abs(value - other) / scale : 0.0;
      if (gap > std::max(worst, round_off)) {
        worst = gap;
        fault_at = e.at;
        fault = fmt::format(
            "the matrix is not symmetric: {:.17g} and {:.17g} couple {} and {}, the worst of its entries", value, other,
            label(rows[static_cast<std::size_t>(e.row)]), label(rows[static_cast<std::size_t>(e.column)]));
      }
      value = 0.5 * value + 0.5 * other;
    }
    if (partner) ++k;
    if (value != 0.0) lower.emplace_back(e.row, e.column, value);
  }
  if (!fault.empty())
    text.fail(fault_at, fault,
              "Gyroscopic, friction and follower terms have no place in K and M; write both triangles to all digits");
  const auto n = static_cast<Eigen::Index>(rows.size());
  SparseMatrix A(n, n);
  A.setFromTriplets(lower.begin(), lower.end());
  return A;
}

MatrixData read_market_matrices(const std::filesystem::path& stiffness, const std::filesystem::path& mass,
                                const std::filesystem::path& labels) {
  MatrixData data = read_matrix_labels(labels);
  data.source = stiffness.string();
  data.K = read_matrix_market(stiffness, data.rows);
  data.M = read_matrix_market(mass, data.rows);
  return data;
}

}  // namespace tenon::fem
