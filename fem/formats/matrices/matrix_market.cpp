#include "fem/formats/matrices/matrix_market.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>

#include "fem/error.hpp"
#include "fem/formats/matrices/labels.hpp"
#include "fem/formats/matrices/symmetric.hpp"
#include "fem/formats/matrices/text.hpp"

namespace tenon::fem {
namespace {

constexpr double round_off = 1e-12;        // of the largest entry of the row: sums over elements in another order
constexpr std::size_t shortest_entry = 6;  // bytes of "1 1 1\n"

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

/// Calls use(row, column, value, byte of the file) for every entry, counted from 0.
template <class Use>
void each_entry(market::Text& text, const Banner& banner, std::size_t n, const std::function<void(std::size_t)>& expect,
                Use use) {
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
  expect(std::min(static_cast<std::size_t>(count), text.size() / shortest_entry));
  for (long k = 0; k < count; ++k) {
    if (!text.next_line('%')) text.fail(text.size(), fmt::format("the file ends after {} of {} entries", k, count));
    const auto i = static_cast<int>(text.whole("a row", 1, rows)) - 1;
    const std::size_t at = text.offset();
    const auto j = static_cast<int>(text.whole("a column", 1, rows)) - 1;
    const double value = text.real("a value");
    if (banner.integer && value != std::floor(value))
      text.fail(text.offset(), fmt::format("found {}, expected a whole number", value), "Call the field `real`");
    text.end_line('\n');
    use(i, j, value, at);
  }
  if (text.next_line('%')) {
    text.word("nothing");
    text.fail(text.offset(), fmt::format("there is more after the {} entries that the file declares", count));
  }
}

/// Where the entry stands that couples two dofs: the first of them, or the second that is one too many.
std::size_t place_of(const std::filesystem::path& path, std::size_t n, const matrices::Asymmetry& fault) {
  market::Text text(path, "");
  std::size_t found = 0;
  int others = fault.twice ? 1 : 0;  // ahead of it
  const Banner banner = read_banner(text);
  each_entry(
      text, banner, n, [](std::size_t) {},
      [&](int i, int j, double, std::size_t at) {
        const bool same = i == fault.row && j == fault.column, mirrored = j == fault.row && i == fault.column;
        if ((same || (mirrored && !(fault.twice && banner.general))) && others-- == 0) found = at;
      });
  return found;
}

}  // namespace

SparseMatrix read_matrix_market(const std::filesystem::path& path, const std::vector<MatrixRow>& rows) {
  market::Text text(path, "The file is damaged or was cut short: write it again");
  const Banner banner = read_banner(text);
  std::vector<matrices::Entry> entries;
  each_entry(
      text, banner, rows.size(), [&](std::size_t count) { entries.reserve(count); },
      [&](int i, int j, double value, std::size_t) { entries.emplace_back(i, j, value); });
  auto result = matrices::lower_triangle(static_cast<Eigen::Index>(rows.size()), std::move(entries),
                                         banner.general ? matrices::Stored::both : matrices::Stored::one, round_off);
  const auto* const fault = std::get_if<matrices::Asymmetry>(&result);
  if (!fault) return std::move(std::get<SparseMatrix>(result));
  if (fault->twice)
    text.fail(place_of(path, rows.size(), *fault),
              fmt::format("the entry ({}, {}) is given twice", fault->row + 1, fault->column + 1),
              banner.general ? "Write each entry once, summed" : "A symmetric file holds one triangle");
  text.fail(place_of(path, rows.size(), *fault),
            fmt::format("the matrix is not symmetric: {:.17g} and {:.17g} couple {} and {}, the worst of its entries",
                        fault->lower, fault->upper, matrices::to_string(rows[static_cast<std::size_t>(fault->row)]),
                        matrices::to_string(rows[static_cast<std::size_t>(fault->column)])),
            "Gyroscopic, friction and follower terms have no place in K and M; write both triangles to all digits");
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
