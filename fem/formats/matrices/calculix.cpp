#include "fem/formats/matrices/calculix.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <utility>

#include "fem/error.hpp"
#include "fem/formats/matrices/number_lines.hpp"
#include "fem/formats/matrices/symmetric.hpp"
#include "fem/formats/nastran/cards.hpp"

namespace tenon::fem {
namespace {

using matrices::Entry;
using matrices::NumberLines;

std::vector<MatrixRow> read_labels(const std::string& file) {
  std::vector<MatrixRow> rows;
  std::set<std::pair<long, int>> seen;
  for (NumberLines lines(file); lines.next();) {
    const std::string_view text = lines.word("a label node.direction");
    const std::size_t point = text.find('.');
    const long node = nastran::parse_integer(text.substr(0, point)).value_or(0);
    const std::string_view direction = point == std::string_view::npos ? "" : text.substr(point + 1);
    if (node < 1 || direction.size() != 1 || direction < "0" || direction > "9")
      lines.fail(fmt::format("found '{}', expected a label node.direction such as 12.3", text.substr(0, 40)),
                 "Let CalculiX write the file again");
    if (direction < "1" || direction > "3")
      lines.fail(fmt::format("found the label '{}': only the directions 1 to 3 of solids are read", text),
                 "Leave temperature and other fields out of the step");
    if (!seen.emplace(node, direction[0] - '1').second)
      lines.fail(
          fmt::format("the label {} stands twice: CalculiX expands beams and shells to solids and labels several "
                      "rows alike",
                      text),
          "Model the part with solid elements, or give the deck itself with its beams and shells");
    rows.push_back({node, direction[0] - '1', false});
    lines.end_line();
  }
  if (rows.empty()) throw InputError({file}, "the file holds no dof", "Give the part a dof that is not held");
  return rows;
}

SparseMatrix read_matrix(const std::string& name, const std::string& file, const std::vector<MatrixRow>& rows) {
  const long n = static_cast<long>(rows.size());
  std::vector<Entry> entries;
  std::vector<bool> diagonal(rows.size(), false);
  NumberLines lines(file);
  entries.reserve(lines.count());
  while (lines.next()) {
    const auto index = [&](const char* what) {
      const long value = lines.integer(what);
      if (value < 1 || value > n)
        lines.fail(fmt::format("found {} {}, but the .dof file labels {} rows", what, value, n),
                   "Take the .sti, .mas and .dof of one run");
      return static_cast<int>(value - 1);
    };
    const int row = index("row"), column = index("column");
    entries.emplace_back(row, column, lines.real("a number"));
    lines.end_line();
    if (row == column) diagonal[static_cast<std::size_t>(row)] = true;
  }
  // CalculiX writes every diagonal entry, zero or not: one that is missing shows where a file was cut off
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!diagonal[i])
      throw InputError({file},
                       fmt::format("the diagonal entry of row {} ({}) is missing: the file is cut off", i + 1,
                                   matrices::to_string(rows[i])),
                       "Take the .sti, .mas and .dof of one run, and let it run to its end");
  return matrices::lower_triangle(name, file, rows, std::move(entries), matrices::Stored::either);
}

}  // namespace

MatrixData read_calculix_matrices(const std::string& job, const std::map<long, Vec3>& positions) {
  const std::filesystem::path path(job);
  const std::string ending = path.extension().string();
  const bool whole = ending == ".sti" || ending == ".mas" || ending == ".dof" || ending == ".inp";
  const std::string stem = whole ? (path.parent_path() / path.stem()).string() : job;

  MatrixData data;
  data.source = stem + ".sti";
  data.rows = read_labels(stem + ".dof");
  data.K = read_matrix("the stiffness matrix", stem + ".sti", data.rows);
  data.M = read_matrix("the mass matrix", stem + ".mas", data.rows);
  for (const MatrixRow& row : data.rows)
    if (const auto known = positions.find(row.node); known != positions.end()) data.positions.insert(*known);
  return data;
}

}  // namespace tenon::fem
