#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem::nastran {
namespace {

/// What CELAS1, CELAS3 and CBUSH name by PID.
using Stiffness = std::unordered_map<long, double>;
using BushStiffness = std::unordered_map<long, std::array<double, 6>>;

double stiffness(const Card& card, int field, const char* label) {
  const double k = card.real(field, label, 0.0);
  if (k < 0.0)
    card.fail(field, label,
              "a stiffness that is not negative: springs that push on make modes without bound, and what a negative "
              "one was to correct is better corrected in its own place");
  return k;
}

void damping_loss(Draft& draft, const Card& card, int field, const char* what) {
  if (!card.blank(field) && card.real(field, "GE") != 0.0)
    draft.losses.add(what, "structural damping is no part of K and M");
}

// PID K GE S, twice a card
Stiffness read_pelas(Draft& draft) {
  Stiffness properties;
  for (const Card& card : draft.take("PELAS"))
    for (const int first : {1, 5}) {
      if (first > 1 && card.blank(first)) continue;
      const long id = card.id(first, "PID");
      const double k = stiffness(card, first + 1, "K");
      damping_loss(draft, card, first + 2, "PELAS GE");
      const auto [entry, added] = properties.try_emplace(id, k);
      if (!added && entry->second != k)
        card.refuse(first, fmt::format("property {} stands already with K = {:g}", id, entry->second),
                    "Give it a number of its own or remove one of the two");
      if (!added) draft.losses.add("PELAS", "repeated, identical property");
    }
  return properties;
}

// lines of "K", "B", "GE", "RCV" or "M" and six values, the flag in the second field of a line
BushStiffness read_pbush(Draft& draft) {
  BushStiffness properties;
  Register known("PBUSH");
  for (const Card& card : draft.take("PBUSH")) {
    const long id = card.id(1, "PID");
    if (!known.admit(id, card, draft.losses)) continue;
    std::array<double, 6> k{};
    for (int line = 1; line <= card.size(); line += 8) {
      const std::string flag = upper(card.at(line + 1));
      const auto any = [&] {
        for (int i = 2; i < 8; ++i)
          if (!card.blank(line + i) && parse_real(card.at(line + i)) != 0.0) return true;
        return false;
      };
      if (flag == "K") {
        for (int i = 0; i < 6; ++i) {
          if (upper(card.at(line + 2 + i)) == "RIGID")
            card.fail(line + 2 + i, "K", "a number: a rigid direction is that of an RBE2");
          k[static_cast<std::size_t>(i)] = stiffness(card, line + 2 + i, "K");
        }
      } else if (flag == "B" || flag == "GE") {
        if (any()) draft.losses.add("PBUSH " + flag, "damping is no part of K and M");
      } else if (flag == "M") {
        if (any()) draft.losses.add_physical("PBUSH M", "mass of a bush is not read", card.place(line + 1));
      } else if (flag == "RCV") {
        draft.losses.add("PBUSH RCV", "recovery of stress and strain");
      } else if (!flag.empty() || any()) {
        card.fail(line + 1, "flag", "K, B, GE, M or RCV");
      }
    }
    properties.emplace(id, k);
  }
  return properties;
}

template <class Value>
const Value& property(const std::unordered_map<long, Value>& properties, const char* kind, const Card& card) {
  const long id = card.blank(2) ? card.id(1, "EID") : card.id(2, "PID");
  const auto found = properties.find(id);
  if (found == properties.end())
    card.refuse(2, fmt::format("field PID names property {}, which is not defined by a {}", id, kind),
                fmt::format("Add the {} card or correct the number", kind));
  return found->second;
}

/// One end of a scalar spring: a dof of a grid in its displacement frame, a scalar point, or ground.
struct End {
  int node = -1, dof = 0;
  Vec3 axis = Vec3::Zero();
};

End scalar_end(Draft& draft, const Card& card, long id, const std::vector<int>& fields) {
  if (draft.scalars.in_q_set(id))
    card.refuse(fields.front(), fmt::format("acts on scalar point {} of the q-set", id),
                "Generalised coordinates belong to the reduced body: put springs on grids");
  const int node = scalar_node(draft, card, id, fields);
  draft.carries[static_cast<std::size_t>(node)] = true;
  return {node, 0, Vec3::Zero()};
}

End end_of(Draft& draft, const Card& card, int grid, int component, const std::vector<int>& grids) {
  const long id = card.integer(grid, "G", 0);
  if (id == 0) return {};
  if (draft.scalars.contains(id)) {
    if (card.components(component, "C") > 1) card.fail(component, "C", "0, 1 or a blank for a scalar point");
    return scalar_end(draft, card, id, grids);
  }
  End end{.node = draft.node(card, grid, "G")};
  const unsigned bits = card.components(component, "C");
  if (!std::has_single_bit(bits)) card.fail(component, "C", "one digit 1 to 6");
  end.dof = std::countr_zero(bits);
  const auto n = static_cast<std::size_t>(end.node);
  draft.carries[n] = true;
  const int half = end.dof / 3 * 3;
  const Vec3 axis = draft.axes[n].col(end.dof - half);
  if (const auto along = basic_axis(axis); along && along->sign > 0.0)
    end.dof = half + along->direction;
  else
    end.axis = axis;
  return end;
}

void add_spring(Draft& draft, const Card& card, double k, End a, End b) {
  if (a.node < 0) std::swap(a, b);
  if (a.node < 0) card.refuse(0, "joins ground to ground", "Name a grid or a scalar point");
  if (a.node == b.node && a.dof == b.dof && a.axis == b.axis)
    card.refuse(0, "joins a dof to itself", "Leave the second end blank for a spring to ground");
  draft.deck.model.elements.emplace_back(Spring{.node_a = a.node,
                                                .dof_a = a.dof,
                                                .node_b = b.node,
                                                .dof_b = b.dof,
                                                .k = k,
                                                .id = card.id(1, "EID"),
                                                .axis_a = a.axis,
                                                .axis_b = b.axis});
}

// CELAS1 EID PID G1 C1 G2 C2, CELAS2 EID K G1 C1 G2 C2 GE S, CELAS3 EID PID S1 S2, CELAS4 EID K S1 S2
void read_scalar_springs(Draft& draft, Register& elements) {
  const Stiffness properties = read_pelas(draft);
  for (const char* name : {"CELAS1", "CELAS2", "CELAS3", "CELAS4"})
    for (const Card& card : draft.take(name)) {
      if (!elements.admit(card.id(1, "EID"), card, draft.losses)) continue;
      const char kind = name[5];
      const double k = kind == '1' || kind == '3' ? property(properties, "PELAS", card) : stiffness(card, 2, "K");
      if (kind < '3') {
        if (kind == '2') damping_loss(draft, card, 7, "CELAS2 GE");
        add_spring(draft, card, k, end_of(draft, card, 3, 4, {3, 5}), end_of(draft, card, 5, 6, {3, 5}));
        continue;
      }
      const auto end = [&](int field, const char* label) -> End {
        const long id = card.integer(field, label, 0);
        if (id == 0) return {};
        if (!draft.scalars.contains(id)) card.fail(field, label, "a scalar point, which no GRID is");
        return scalar_end(draft, card, id, {3, 4});
      };
      add_spring(draft, card, k, end(3, "S1"), end(4, "S2"));
    }
}

// x from GA to GB and v in the x-y plane, or the axes of CID; without either the line alone, which bears K1 and K4
Mat3 bush_axes(Draft& draft, const Card& card, const Bush& bush) {
  const Vec3& a = draft.deck.model.nodes[static_cast<std::size_t>(bush.node_a)];
  if (!card.blank(8)) {
    const long cid = card.integer(8, "CID");
    if (cid < 0) card.fail(8, "CID", "a coordinate system, 0 for the basic one, or a blank");
    return draft.frame_at(card, 8, "CID", cid, a);
  }
  const Vec3 b = bush.node_b < 0 ? a : draft.deck.model.nodes[static_cast<std::size_t>(bush.node_b)];
  const double length = (b - a).norm();
  if (!(length > 1e-12 * (a.norm() + b.norm())))
    card.fail(8, "CID", "a coordinate system (0: basic): coincident grids and ground give no axes");
  const Vec3 x = (b - a) / length;
  Vec3 v = Vec3::Zero();
  if (!card.blank(5) && parse_integer(card.at(5)) && card.blank(6) && card.blank(7))
    v = draft.deck.model.nodes[static_cast<std::size_t>(draft.node(card, 5, "GO"))] - a;
  else if (!card.blank(5) || !card.blank(6) || !card.blank(7))
    v = draft.axes[static_cast<std::size_t>(bush.node_a)] *
        Vec3(card.real(5, "X1", 0.0), card.real(6, "X2", 0.0), card.real(7, "X3", 0.0));
  else if (bush.k[1] + bush.k[2] + bush.k[4] + bush.k[5] > 0.0)
    card.fail(5, "GO/X1", "a grid or a vector, or a CID: K2, K3, K5 and K6 need axes across the line of its grids");
  else
    v = x.unitOrthogonal();
  const Vec3 z = x.cross(v);
  if (!(z.norm() > 1e-9 * v.norm()))
    card.refuse(5, fmt::format("{} has an orientation vector along its own axis (or of no length)", bush.id),
                "Give a vector or a grid GO off its axis, or a CID");
  Mat3 axes;
  axes << x, z.normalized().cross(x), z.normalized();
  return axes;
}

// EID PID GA GB GO/X1 X2 X3 CID | S OCID S1 S2 S3
void read_bushes(Draft& draft, Register& elements) {
  const BushStiffness properties = read_pbush(draft);
  for (const Card& card : draft.take("CBUSH")) {
    Bush bush;
    bush.id = card.id(1, "EID");
    if (!elements.admit(bush.id, card, draft.losses)) continue;
    bush.k = property(properties, "PBUSH", card);
    bush.node_a = draft.node(card, 3, "GA");
    if (!card.blank(4)) bush.node_b = draft.node(card, 4, "GB");
    if (bush.node_a == bush.node_b)
      card.refuse(4, fmt::format("{} joins GRID {} to itself", bush.id, card.at(4)),
                  "Leave GB blank for a bush to ground");
    bush.axes = bush_axes(draft, card, bush);
    const Vec3& a = draft.deck.model.nodes[static_cast<std::size_t>(bush.node_a)];
    const double s = card.real(9, "S", 0.5);
    if (!(s >= 0.0 && s <= 1.0)) card.fail(9, "S", "a number from 0 to 1");
    if (const long ocid = card.integer(10, "OCID", -1); ocid >= 0) {
      const Vec3 offset(card.real(11, "S1", 0.0), card.real(12, "S2", 0.0), card.real(13, "S3", 0.0));
      bush.offset = draft.frame_at(card, 10, "OCID", ocid, a) * offset;
    } else if (bush.node_b >= 0) {
      bush.offset = s * (draft.deck.model.nodes[static_cast<std::size_t>(bush.node_b)] - a);
    }
    for (const int node : {bush.node_a, bush.node_b})
      if (node >= 0) draft.carries[static_cast<std::size_t>(node)] = true;
    draft.deck.model.elements.emplace_back(bush);
  }
}

}  // namespace

void read_springs(Draft& draft, Register& elements) {
  read_scalar_springs(draft, elements);
  read_bushes(draft, elements);
}

}  // namespace tenon::fem::nastran
