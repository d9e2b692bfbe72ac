#include "fem/formats/matrices/abaqus.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "fem/error.hpp"
#include "fem/formats/matrices/number_lines.hpp"
#include "fem/formats/matrices/symmetric.hpp"
#include "fem/formats/nastran/cards.hpp"

namespace tenon::fem {
namespace {

using matrices::NumberLines;
using Label = std::pair<long, int>;  ///< node, direction

struct Line {
  Label row, column;
  double value = 0.0;
};

constexpr double mark_of_support = 1e35;  // Abaqus writes 1e36 on the diagonal of a dof that is held

std::vector<Line> read_lines(const std::filesystem::path& file) {
  std::vector<Line> all;
  for (NumberLines lines(file); lines.next();) {
    if (lines.line().starts_with("**")) continue;
    if (lines.line().starts_with("*"))
      lines.fail(fmt::format("found '{}' in a file of matrix entries", lines.line().substr(0, 40)),
                 "Write it by *MATRIX OUTPUT, FORMAT=MATRIX INPUT and give it as it is");
    const auto label = [&](const char* node_label, const char* dof_label) {
      const long node = lines.integer(node_label);
      if (node < 1)
        lines.fail(fmt::format("found {} {}: internal nodes (of connectors, hybrid elements, multipliers) are not read",
                               node_label, node),
                   "Use elements without internal dofs, or reduce the part to a substructure");
      const long dof = lines.integer(dof_label);
      if (dof < 1 || dof > 6)
        lines.fail(fmt::format("found {} {}: only the dofs 1 to 6 are displacements and rotations", dof_label, dof),
                   "Leave warping, pressure and temperature out of the model");
      return Label{node, static_cast<int>(dof) - 1};
    };
    Line line;
    line.row = label("row node", "row dof");
    line.column = label("column node", "column dof");
    line.value = lines.real("a number");
    lines.end_line();
    all.push_back(line);
  }
  if (all.empty())
    throw InputError({file.string()}, "the file holds no matrix entry", "Check that it is the right file");
  return all;
}

}  // namespace

MatrixData read_abaqus_matrices(const std::filesystem::path& stiffness, const std::filesystem::path& mass) {
  const std::vector<Line> k = read_lines(stiffness), m = read_lines(mass);
  std::map<Label, int> index;  // −1: held
  for (const auto* lines : {&k, &m})
    for (const Line& line : *lines) index[line.row] = index[line.column] = 0;
  long held = 0;
  for (const Line& line : k)
    if (line.row == line.column && line.value >= mark_of_support) index[line.row] = -1, ++held;

  MatrixData data;
  data.source = stiffness.string();
  for (auto& [label, row] : index) {
    if (row < 0) continue;
    row = static_cast<int>(data.rows.size());
    data.rows.push_back({label.first, label.second, false});
  }
  if (data.rows.empty())
    throw InputError({stiffness.string()}, "every dof is held", "Generate the matrices without the supports");
  if (held > 0)
    data.losses.push_back(
        {"held dofs", held, "1e36 on the diagonal: they are zero, and their rows are left out", false});

  const auto matrix = [&](const char* name, const std::filesystem::path& file, const std::vector<Line>& lines) {
    std::vector<matrices::Entry> entries;
    for (const Line& line : lines) {
      const int row = index.at(line.row), column = index.at(line.column);
      if (row >= 0 && column >= 0) entries.emplace_back(row, column, line.value);
    }
    return matrices::lower_triangle(name, file.string(), data.rows, std::move(entries), matrices::Stored::either);
  };
  data.K = matrix("the stiffness matrix", stiffness, k);
  data.M = matrix("the mass matrix", mass, m);
  return data;
}

MatrixData read_abaqus_matrices(const std::string& job) {
  namespace fs = std::filesystem;
  const fs::path path(job), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string begin = path.filename().string() + "_STIF", end = ".mtx";
  std::vector<std::pair<fs::path, fs::path>> pairs;
  std::error_code error;
  for (fs::directory_iterator entries(folder, error); !error && entries != fs::directory_iterator();
       entries.increment(error)) {
    const std::string name = entries->path().filename().string();
    if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end)) continue;
    const std::string step = name.substr(begin.size());
    fs::path mass = path.parent_path() / (path.filename().string() + "_MASS" + step);
    std::error_code ignored;
    if (nastran::parse_integer(std::string_view(step).substr(0, step.size() - end.size())) && fs::exists(mass, ignored))
      pairs.emplace_back(path.parent_path() / name, std::move(mass));
  }
  if (pairs.size() != 1)
    throw InputError({job},
                     pairs.empty()
                         ? "found no pair of files " + begin + "n.mtx and " + path.filename().string() + "_MASSn.mtx"
                         : fmt::format("found the matrices of {} steps, among them {} and {}", pairs.size(),
                                       pairs[0].first.string(), pairs[1].first.string()),
                     "Name the two .mtx files");
  return read_abaqus_matrices(pairs[0].first, pairs[0].second);
}

}  // namespace tenon::fem
