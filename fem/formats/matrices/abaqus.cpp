#include "fem/formats/matrices/abaqus.hpp"

#include <fmt/format.h>

#include <utility>

#include "fem/error.hpp"
#include "fem/formats/matrices/number_lines.hpp"
#include "fem/formats/matrices/numbering.hpp"
#include "fem/formats/matrices/symmetric.hpp"
#include "fem/formats/nastran/cards.hpp"

namespace tenon::fem {
namespace {

using matrices::Label;
using matrices::Numbering;
using matrices::NumberLines;

constexpr double mark_of_support = 1e35;  // Abaqus writes 1e36 on the diagonal of a dof that is held

std::vector<matrices::Entry> read_entries(const std::filesystem::path& file, Numbering& number) {
  NumberLines lines(file);
  std::vector<matrices::Entry> all;
  all.reserve(lines.count());
  while (lines.next()) {
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
    const Label row = label("row node", "row dof"), column = label("column node", "column dof");
    const double value = lines.real("a number");
    lines.end_line();
    const int i = number(0, row);
    all.emplace_back(i, number(1, column), value);
  }
  if (all.empty())
    throw InputError({file.string()}, "the file holds no matrix entry", "Check that it is the right file");
  return all;
}

}  // namespace

MatrixData read_abaqus_matrices(const std::filesystem::path& stiffness, const std::filesystem::path& mass) {
  Numbering number;
  std::vector<matrices::Entry> k = read_entries(stiffness, number), m = read_entries(mass, number);
  const std::vector<Label>& labels = number.labels();
  std::vector<int> row_of(labels.size(), 0);  // −1: held
  long held = 0;
  for (const matrices::Entry& e : k)
    if (int& row = row_of[static_cast<std::size_t>(e.row())];
        e.row() == e.col() && e.value() >= mark_of_support && row == 0)
      row = -1, ++held;

  MatrixData data;
  data.source = stiffness.string();
  for (const std::size_t i : number.order()) {
    if (row_of[i] < 0) continue;
    row_of[i] = static_cast<int>(data.rows.size());
    data.rows.push_back({labels[i].first, labels[i].second, false});
  }
  if (data.rows.empty())
    throw InputError({stiffness.string()}, "every dof is held", "Generate the matrices without the supports");
  if (held > 0)
    data.losses.push_back(
        {"held dofs", held, "1e36 on the diagonal: they are zero, and their rows are left out", false});

  const auto matrix = [&](const char* name, const std::filesystem::path& file, std::vector<matrices::Entry>& entries) {
    const auto row = [&](int i) { return row_of[static_cast<std::size_t>(i)]; };
    std::erase_if(entries, [&](const matrices::Entry& e) { return row(e.row()) < 0 || row(e.col()) < 0; });
    for (matrices::Entry& e : entries) e = {row(e.row()), row(e.col()), e.value()};
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
