#include "fem/formats/matrices/superelement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "fem/error.hpp"
#include "fem/formats/matrices/interface_cards.hpp"
#include "fem/formats/matrices/op4.hpp"
#include "fem/formats/matrices/symmetric.hpp"

namespace tenon::fem {
namespace matrices {
namespace {

namespace fs = std::filesystem;
using nastran::Card;
using nastran::upper;

constexpr unsigned all_six = 0b111111U;

/// A point of the interface: its number in the superelement and in the assembly, and the components among the rows
/// (none: a scalar point).
struct Connection {
  long own = 0, assembly = 0;
  unsigned components = 0;
};

/// Adds ids while they stay within the size of the matrices.
class Connections {
 public:
  explicit Connections(long limit) : limit_(limit) {}
  void add(const Card& card, int field, const Connection& connection) {
    if (std::ssize(all) >= limit_)
      card.refuse(field, fmt::format("names more points than the {} rows that the matrices have", limit_),
                  "Take the description and the matrices of one run");
    all.push_back(connection);
  }
  std::vector<Connection> all;

 private:
  long limit_;
};

bool thru(const Card& card, int field) { return upper(card.at(field)) == "THRU"; }

/// EXTRN G1 C1 G2 C2 ..., or G1 THRU G2 C.
std::vector<Connection> read_extrn(nastran::Draft& draft, long limit) {
  Connections result(limit);
  for (const Card& card : draft.take("EXTRN"))
    for (int field = 1; field <= card.size();) {
      const long first = card.id(field, "GID");
      const bool range = thru(card, field + 1);
      const long last = range ? card.id(field + 2, "GID after THRU") : first;
      const unsigned components = card.components(field + (range ? 3 : 1), "C");
      if (last < first) card.fail(field + 2, "GID after THRU", fmt::format("at least {}", first));
      if (!result.all.empty() && result.all.back().own >= first)
        card.refuse(
            field,
            fmt::format("names {} behind {}: the rows of the matrices are in rising order, so which row belongs "
                        "to which point cannot be told",
                        first, result.all.back().own),
            "Let Nastran write EXTRN (EXTSEOUT)");
      for (long i = 0; i <= last - first; ++i) result.add(card, field, {first + i, first + i, components});
      field += range ? 4 : 2;
    }
  return result.all;
}

/// SECONCT SSIDA SSIDB TOL LOC – – – – GIDA1 GIDB1 ..., or GIDA1 THRU GIDA2 GIDB1 THRU GIDB2.
std::vector<Connection> read_seconct(nastran::Draft& draft, long limit) {
  Connections result(limit);
  for (const Card& card : draft.take("SECONCT")) {
    const bool swapped = card.integer(1, "SSIDA") == 0;  // the superelement is the side that is not 0
    if (!swapped && card.integer(2, "SSIDB") != 0)
      card.refuse(2, "connects two superelements, so which one this file describes cannot be told",
                  "Give the .asm that EXTSEOUT wrote for one superelement");
    for (int field = 9; field <= card.size();) {
      if (card.blank(field)) {
        ++field;
        continue;
      }
      const bool range = thru(card, field + 1);
      const int other = field + (range ? 3 : 1);
      const long a = card.id(field, "GIDA"), b = card.id(other, "GIDB");
      const long count = range ? card.id(field + 2, "GIDA after THRU") - a + 1 : 1;
      if (range && (count < 1 || !thru(card, other + 1) || card.id(other + 2, "GIDB after THRU") - b + 1 != count))
        card.refuse(field, "pairs two ranges of different length", "Give as many numbers on both sides");
      for (long i = 0; i < count; ++i)
        result.add(card, field, swapped ? Connection{b + i, a + i, all_six} : Connection{a + i, b + i, all_six});
      field = other + (range ? 3 : 1);
    }
  }
  std::ranges::sort(result.all, {}, &Connection::own);
  return result.all;
}

/// The points of the interface in the order of the rows.
std::vector<Connection> connections(InterfaceCards& cards, const fs::path& file, long rows) {
  std::vector<Connection> named = read_extrn(cards.draft, rows);
  const std::vector<Connection> pairs = read_seconct(cards.draft, rows);
  const fs::path punch = fs::path(file).replace_extension(".pch");
  std::error_code ignored;
  if (named.empty() && punch != file && fs::exists(punch, ignored)) {
    InterfaceCards beside(punch);
    named = read_extrn(beside.draft, rows);
  }
  if (named.empty()) {
    named = pairs;
    if (pairs.empty()) {  // every point of the file is its interface
      std::set<long> ids(cards.draft.sorted_grids.begin(), cards.draft.sorted_grids.end());
      for (const nastran::Range& range : cards.draft.scalars.points) {
        const long more = range.last - range.first;  // besides the first one
        if (more >= rows || std::ssize(ids) + more >= rows)
          throw InputError(
              {file.string()},
              fmt::format("SPOINT names {} to {}, but the matrices have {} rows only", range.first, range.last, rows),
              "Take the description and the matrices of one run");
        for (long i = 0; i <= more; ++i) ids.insert(range.first + i);
      }
      for (const long id : ids) named.push_back({id, id, all_six});
    }
  } else if (!pairs.empty()) {
    if (!std::ranges::equal(named, pairs, {}, &Connection::own, &Connection::own))
      throw InputError({file.string()}, "SECONCT and EXTRN name different points of the superelement",
                       "Take the .asm and the .pch of one run");
    for (std::size_t i = 0; i < named.size(); ++i) named[i].assembly = pairs[i].assembly;
  }
  return named;
}

std::vector<MatrixRow> rows_of(const std::vector<Connection>& points, const InterfaceCards& cards,
                               const std::string& file) {
  std::vector<MatrixRow> rows;
  std::set<long> seen;
  for (const Connection& point : points) {
    if (!seen.insert(point.assembly).second)
      throw InputError({file}, fmt::format("point {} stands twice in the interface", point.assembly),
                       "Name each point of the interface once");
    const bool grid = cards.is_grid(point.assembly);
    if (!grid && !cards.is_scalar(point.assembly))
      throw InputError(
          {file}, fmt::format("point {} of the interface is neither a GRID nor an SPOINT of the file", point.assembly),
          "Add its card");
    if (!grid) rows.push_back({point.assembly, 0, true});
    for (int d = 0; grid && d < 6; ++d)
      if (point.components >> d & 1U) rows.push_back({point.assembly, d, false});
  }
  return rows;
}

NamedMatrix& choose(const std::string& file, std::vector<NamedMatrix>& all,
                    std::initializer_list<std::string_view> names) {
  NamedMatrix* chosen = nullptr;
  std::string list;
  for (NamedMatrix& matrix : all) {
    list += (list.empty() ? "" : ", ") + matrix.name;
    if (std::ranges::find(names, upper(matrix.name)) == names.end()) continue;
    if (chosen != nullptr)
      throw InputError({file},
                       fmt::format("has {} and {}, and which one is meant cannot be told", chosen->name, matrix.name),
                       "Keep the boundary matrices of one superelement in a file");
    chosen = &matrix;
  }
  if (chosen == nullptr)
    throw InputError({file}, fmt::format("found no matrix {}; the file has {}", *names.begin(), list),
                     "Let EXTSEOUT write the boundary matrices (MATOP4)");
  return *chosen;
}

std::string note_on_card(const std::string& name) {
  if (name.starts_with("BXX") || name.starts_with("BAA")) return "viscous damping is not read";
  if (name.starts_with("K4")) return "structural damping is not read";
  return "loads and output recovery: no part of K and M";
}

}  // namespace
}  // namespace matrices

MatrixData read_nastran_superelement(const std::string& asm_file) {
  using namespace matrices;
  const fs::path path(asm_file), matrices_file = fs::path(path).replace_extension(".op4");
  const std::string op4_name = matrices_file.string();
  InterfaceCards cards(path);
  MatrixData data;
  std::error_code ignored;
  if (cards.draft.cards.contains("DMIG") && !fs::exists(matrices_file, ignored)) {
    data = from_direct_matrices(asm_file, cards, "", "");
    cards.draft.take("EXTRN");
    cards.draft.take("SECONCT");
    cards.finish(data);
    return data;
  }

  if (!fs::exists(matrices_file, ignored))
    throw InputError({asm_file},
                     fmt::format("holds no DMIG, and there is no {} beside it", matrices_file.filename().string()),
                     "Keep the .op4 of the same run beside it");

  std::vector<NamedMatrix> all = read_op4(matrices_file);
  NamedMatrix& K = choose(op4_name, all, {"KXX", "KAAX", "KAA"});
  NamedMatrix& M = choose(op4_name, all, {"MXX", "MAAX", "MAA"});
  for (const NamedMatrix* m : {&K, &M})
    if (m->rows != m->columns || m->rows != K.rows)
      throw InputError({op4_name},
                       fmt::format("{} is {}×{} and {} is {}×{}, expected square ones of equal size", K.name, K.rows,
                                   K.columns, m->name, m->rows, m->columns),
                       "Take both from one run");
  // a size that the file's content cannot explain is not believed
  const std::int64_t at_most = 6 * std::ssize(cards.draft.sorted_grids) + std::ssize(K.entries) + std::ssize(M.entries);
  if (K.rows > at_most)
    throw InputError({op4_name},
                     fmt::format("{} has {} rows, more than the grids and entries found account for", K.name, K.rows),
                     "The file may be damaged; write it again");

  data.source = asm_file;
  data.rows = rows_of(connections(cards, path, static_cast<long>(K.rows)), cards, asm_file);
  if (std::ssize(data.rows) != K.rows)
    throw InputError(
        {asm_file},
        fmt::format("the description gives {} rows, but {} of {} has {}", data.rows.size(), K.name, op4_name, K.rows),
        "Take the description and the matrices of one run; where a grid has fewer than six components, keep "
        "the .pch beside the .asm");
  data.K = lower_triangle(K.name, op4_name, data.rows, std::move(K.entries), Stored::both);
  data.M = lower_triangle(M.name, op4_name, data.rows, std::move(M.entries), Stored::both);
  for (const NamedMatrix& matrix : all)
    if (&matrix != &K && &matrix != &M && !matrix.entries.empty())
      data.losses.push_back(
          {matrix.name, static_cast<long>(matrix.entries.size()), note_on_card(upper(matrix.name)), false});
  turn_to_basic(data, cards);
  cards.finish(data);
  return data;
}

}  // namespace tenon::fem
