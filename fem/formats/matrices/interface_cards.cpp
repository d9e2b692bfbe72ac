#include "fem/formats/matrices/interface_cards.hpp"

#include <fmt/format.h>

#include <array>

#include "fem/formats/matrices/symmetric.hpp"

namespace tenon::fem::matrices {

InterfaceCards::InterfaceCards(const std::filesystem::path& path) : text(nastran::read_text(path, true)) {
  nastran::sort_cards(text, draft);
  nastran::read_grids(draft);
  for (const unsigned held : draft.permanent_spc)
    if (held != 0) draft.losses.add("GRID PS", "supports are no part of the matrices: hold these dofs in the model");
  for (const nastran::Card& card : draft.take("SPOINT"))
    for (const nastran::Range& range : nastran::Draft::ranges(card, 1)) draft.scalars.points.push_back(range);
  for (const nastran::Card& card : draft.take("PARAM")) {
    const std::string name = nastran::upper(card.at(1));
    if (name.starts_with("CK") || name.starts_with("CM"))
      draft.losses.add_physical("PARAM " + name, "it scales the matrices and is not read", card.place());
    else
      draft.losses.add("PARAM " + name, "no effect on the matrices");
  }
}

void InterfaceCards::finish(MatrixData& data) {
  for (const char* name : {"ASET", "ASET1", "BSET", "BSET1", "QSET", "QSET1"}) draft.take(name);
  for (const nastran::Card& card : draft.take("SEBULK"))
    if (const std::string type = nastran::upper(card.at(2)); type == "MIRROR" || type == "IDENTCAL")
      card.refuse(
          2, fmt::format("TYPE {} makes the superelement from another one, which is not read", type),
          "Give the description and matrices of that one, and place a mirrored body in the scene by its own run");
  nastran::classify_rest(draft);
  draft.losses.refuse_physical();
  for (const Loss& loss : draft.losses.losses()) data.losses.push_back(loss);
}

namespace {

/// R: basic directions from those of the displacement frames; a row that only changes its name changes `rows`.
SparseMatrix turn(std::vector<MatrixRow>& rows, const InterfaceCards& cards, const std::string& file, bool& any) {
  std::map<long, std::array<int, 6>> row_of;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].scalar) continue;
    const auto [entry, added] = row_of.try_emplace(rows[i].node);
    if (added) entry->second.fill(-1);
    entry->second.at(static_cast<std::size_t>(rows[i].direction)) = static_cast<int>(i);
  }
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].scalar) entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  for (const auto& [id, at] : row_of) {
    const Mat3& axes = cards.draft.axes[static_cast<std::size_t>(*cards.draft.node_of.find(id))];
    if (!axes.isIdentity(0.0)) any = true;
    for (const int half : {0, 3}) {
      const int* local = at.data() + half;
      if (local[0] >= 0 && local[1] >= 0 && local[2] >= 0) {  // u_basic = A u_local, A = axes as columns
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            if (axes(i, j) != 0.0) entries.emplace_back(local[i], local[j], axes(i, j));
        continue;
      }
      for (int j = 0; j < 3; ++j) {
        if (local[j] < 0) continue;
        const auto axis = nastran::basic_axis(axes.col(j));
        if (!axis)
          throw InputError(
              {file},
              fmt::format("node {} has some but not all {} among the rows, in a displacement frame that is "
                          "skew to the basic one: they cannot be turned",
                          id, half == 0 ? "translations" : "rotations"),
              "Keep all three of them in the reduction, or give the grid a frame along the basic axes");
        entries.emplace_back(local[j], local[j], axis->sign);
        rows[static_cast<std::size_t>(local[j])].direction = half + axis->direction;
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  SparseMatrix R(n, n);
  R.setFromTriplets(entries.begin(), entries.end());
  return R;
}

}  // namespace

void turn_to_basic(MatrixData& data, const InterfaceCards& cards) {
  bool any = false;
  const SparseMatrix R = turn(data.rows, cards, data.source, any);
  if (any) {
    data.K = turned(R, data.K);
    data.M = turned(R, data.M);
  }
  for (const MatrixRow& row : data.rows) {
    if (row.scalar) continue;
    const auto node = static_cast<std::size_t>(*cards.draft.node_of.find(row.node));
    if (data.positions.emplace(row.node, cards.draft.deck.mesh.points[node]).second)
      data.sets["boundary"].push_back(row.node);
  }
}

}  // namespace tenon::fem::matrices
