#include "fem/formats/matrices/dmig.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "fem/error.hpp"
#include "fem/formats/matrices/interface_cards.hpp"
#include "fem/formats/matrices/numbering.hpp"
#include "fem/formats/matrices/symmetric.hpp"

namespace tenon::fem {
namespace matrices {
namespace {

using nastran::Card;

/// A matrix that a file's DMIG cards give, its dofs as numbered in all of them.
struct DirectMatrix {
  std::string name;
  int form = 0;  ///< 1 square, 6 symmetric
  std::vector<Entry> terms;
};

/// DMIG NAME 0 IFO TIN TOUT POLAR – NCOL.
DirectMatrix header(const Card& card) {
  DirectMatrix matrix;
  matrix.name = nastran::upper(card.at(1));
  const long form = card.integer(3, "IFO"), type = card.integer(4, "TIN"), polar = card.integer(6, "POLAR", 0);
  if (form != 1 && form != 6)
    card.refuse(
        3, fmt::format("{} has the form {}: only square (1) and symmetric (6) matrices are read", matrix.name, form),
        "Write stiffness and mass as symmetric DMIG");
  if ((type != 1 && type != 2) || polar != 0)
    card.refuse(4, fmt::format("{} is complex: only real matrices (TIN 1 or 2, POLAR 0) are read", matrix.name),
                "Write stiffness and mass as real DMIG");
  matrix.form = static_cast<int>(form);
  return matrix;
}

/// Grid and direction, or scalar point and −1, of the fields G and C.
std::pair<long, int> label(const InterfaceCards& cards, const Card& card, int field) {
  const long id = card.id(field, "G");
  const long component = card.integer(field + 1, "C", 0);
  if (cards.is_grid(id)) {
    if (component < 1 || component > 6) card.fail(field + 1, "C", "a component 1 to 6 of a GRID");
    return {id, static_cast<int>(component) - 1};
  }
  if (!cards.is_scalar(id))
    card.refuse(field,
                fmt::format("names {}, which is neither a GRID nor an SPOINT of the file, so its displacement frame is "
                            "not known",
                            id),
                "Put its GRID card and coordinate systems into the file");
  if (component > 1) card.fail(field + 1, "C", "0, 1 or blank for an SPOINT");
  return {id, -1};
}

DirectMatrix& choose(const std::string& file, std::vector<DirectMatrix>& all, const std::string& name, char initial,
                     const char* what) {
  DirectMatrix* found = nullptr;
  std::vector<std::string> names;
  std::string list;
  for (DirectMatrix& matrix : all) {
    names.push_back(matrix.name);
    list += (list.empty() ? "" : ", ") + matrix.name;
    const bool fits = name.empty() ? matrix.name[0] == initial && !matrix.name.starts_with("K4") : matrix.name == name;
    if (!fits) continue;
    if (found)
      throw InputError({file}, fmt::format("{} could be {} or {}", what, found->name, matrix.name), "Name one of them");
    found = &matrix;
  }
  if (found) return *found;
  const std::string near = near_miss(name, names);
  throw InputError(
      {file},
      fmt::format("found no DMIG {} for {}; the file has {}", name.empty() ? std::string(1, initial) + "..." : name,
                  what, list.empty() ? "none" : list),
      near.empty() ? "Name the matrix" : fmt::format("Did you mean {}?", near));
}

/// Takes the DMIG cards. Throws InputError for complex and rectangular matrices.
std::vector<DirectMatrix> take_direct_matrices(InterfaceCards& cards, Numbering& number) {
  std::vector<DirectMatrix> all;
  std::map<std::string, std::size_t> index;
  for (const Card& card : cards.draft.take("DMIG")) {
    const std::string name = nastran::upper(card.at(1));
    if (name.empty()) card.fail(1, "NAME", "the matrix's name");
    if (card.integer(2, "GJ") == 0) {
      if (!index.emplace(name, all.size()).second)
        card.refuse(1, fmt::format("{} stands twice", name), "Keep one header of each matrix");
      all.push_back(header(card));
      continue;
    }
    const auto at = index.find(name);
    if (at == index.end())
      card.refuse(1, fmt::format("{} has no header ahead of this column", name), "Put 'DMIG,name,0,...' first");
    const int column = number(1, label(cards, card, 2));
    for (int field = 5; field <= card.size(); field += 4) {
      if (card.blank(field)) {
        if (card.size() > field) card.fail(field, "G", "a grid or scalar point");
        continue;
      }
      const double value = card.real(field + 2, "A");
      if (!card.blank(field + 3) && card.real(field + 3, "B") != 0.0)
        card.refuse(field + 3, fmt::format("{} has an imaginary part", name), "Write the matrix as real DMIG");
      all[at->second].terms.emplace_back(number(0, label(cards, card, field)), column, value);
    }
  }
  return all;
}

}  // namespace

MatrixData from_direct_matrices(const std::string& file, InterfaceCards& cards, const std::string& stiffness,
                                const std::string& mass) {
  Numbering number;
  std::vector<DirectMatrix> all = take_direct_matrices(cards, number);
  DirectMatrix& k = choose(file, all, nastran::upper(stiffness), 'K', "the stiffness matrix");
  DirectMatrix& m = choose(file, all, nastran::upper(mass), 'M', "the mass matrix");

  MatrixData data;
  data.source = file;
  std::vector<int> row_of(number.labels().size(), -1);  // −1: in other matrices alone
  for (const DirectMatrix* matrix : {&k, &m})
    for (const Entry& term : matrix->terms)
      row_of[static_cast<std::size_t>(term.row())] = row_of[static_cast<std::size_t>(term.col())] = 0;
  for (const std::size_t i : number.order()) {
    if (row_of[i] < 0) continue;
    row_of[i] = static_cast<int>(data.rows.size());
    const auto& [id, direction] = number.labels()[i];
    data.rows.push_back({id, std::max(direction, 0), direction < 0});
  }
  if (data.rows.empty())
    throw InputError({file}, fmt::format("{} and {} have no terms", k.name, m.name), "Write them again");
  const auto symmetric = [&](DirectMatrix& matrix) {
    for (Entry& term : matrix.terms)
      term = {row_of[static_cast<std::size_t>(term.row())], row_of[static_cast<std::size_t>(term.col())], term.value()};
    return lower_triangle(matrix.name, file, data.rows, std::move(matrix.terms),
                          matrix.form == 6 ? Stored::either : Stored::both);
  };
  data.K = symmetric(k);
  data.M = symmetric(m);
  for (const DirectMatrix& matrix : all)
    if (&matrix != &k && &matrix != &m)
      data.losses.push_back({"DMIG " + matrix.name, static_cast<long>(matrix.terms.size()),
                             "neither the stiffness nor the mass matrix: terms not read", false});
  turn_to_basic(data, cards);
  return data;
}

}  // namespace matrices

MatrixData read_nastran_dmig(const std::string& file, const std::string& stiffness, const std::string& mass) {
  matrices::InterfaceCards cards(file);
  MatrixData data = matrices::from_direct_matrices(file, cards, stiffness, mass);
  cards.finish(data);
  return data;
}

}  // namespace tenon::fem
