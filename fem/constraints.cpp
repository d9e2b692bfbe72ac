#include "fem/constraints.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

struct Term {
  int dof = 0;  ///< full dof, 6·node + direction
  double c = 0.0;
};

/// Σ c u = 0, and the dof it would like to give up (−1: none in particular).
struct Row {
  std::vector<Term> terms;
  int dependent = -1;
  std::string link;  ///< its name
};

int full(int node, int direction) { return 6 * node + direction; }
bool has(Directions directions, int d) { return ((directions >> d) & 1U) != 0; }

/// u_dep(axis) = the rigid motion of the independent node, one row a direction and dependent node.
void rigid_link_rows(const Model& model, const RigidLink& link, std::vector<Row>& rows) {
  const Vec3& x = position(model, link.independent);
  const Mat6 axes = rotation6(link.axes);
  const std::string by = link_name(model, link);
  for (const int node : link.dependents) {
    const Mat6 T = tau(position(model, node) - x);
    for (int d = 0; d < 6; ++d) {
      if (!has(link.directions, d)) continue;
      Row row{{}, -1, by};
      const Vec6 on_dependent = axes.col(d);
      const Vec6 on_independent = -T.transpose() * on_dependent;
      double largest = 0.0;
      for (int i = 0; i < 6; ++i) {
        if (on_dependent(i) != 0.0) row.terms.push_back({full(node, i), on_dependent(i)});
        if (on_independent(i) != 0.0) row.terms.push_back({full(link.independent, i), on_independent(i)});
        if (std::abs(on_dependent(i)) > largest) {
          largest = std::abs(on_dependent(i));
          row.dependent = full(node, i);
        }
      }
      rows.push_back(std::move(row));
    }
  }
}

void average_link_rows(const Model& model, const AverageLink& link, std::vector<Row>& rows) {
  const Mat6X A = averaging_matrix(model, link);
  const std::string by = link_name(model, link);
  for (int d = 0; d < 6; ++d) {
    if (!has(link.directions, d)) continue;
    Row row{{{full(link.reference, d), 1.0}}, full(link.reference, d), by};
    Eigen::Index column = 0;
    for (const AverageLink::Group& group : link.nodes)
      for (int i = 0; i < 6; ++i)
        if (has(group.directions, i)) {
          if (A(d, column) != 0.0) row.terms.push_back({full(group.node, i), -A(d, column)});
          ++column;
        }
    rows.push_back(std::move(row));
  }
}

/// Gauss-Jordan on sparse rows: `expression[dof]` holds a dependent dof in terms of dofs that are not dependent.
class Elimination {
 public:
  explicit Elimination(int n) : state_(static_cast<std::size_t>(n), free) {}

  void hold(int dof) { state_[static_cast<std::size_t>(dof)] = held; }
  void keep(int dof) { kept_.insert({dof, true}); }
  bool is_held(int dof) const { return state_[static_cast<std::size_t>(dof)] == held; }
  const std::vector<Term>* expression(int dof) const {
    const auto found = expression_.find(dof);
    return found == expression_.end() ? nullptr : &found->second;
  }

  /// True when the row said something new; `notes` gets what else there is to say.
  bool add(const Model& model, const Row& row, std::vector<ConstraintNote>& notes) {
    const auto note = [&](ConstraintNote::Kind kind, int dof, double figure = 0.0) {
      notes.push_back({kind, row.link, {dof / 6, dof % 6}, figure});
    };
    for (const Term& t : row.terms)
      if (!std::isfinite(t.c))
        throw ModelError(fmt::format("{}: the {} has a coefficient that is not finite, at {}", model.source, row.link,
                                     name(model, {t.dof / 6, t.dof % 6})),
                         "Give it a number");
    const std::vector<Term> terms = reduced(row.terms);
    if (terms.empty()) {
      if (row.dependent >= 0) note(ConstraintNote::Kind::redundant, row.dependent);
      return false;
    }
    double largest = 0.0;
    for (const Term& t : terms)
      if (!kept_.contains(t.dof)) largest = std::max(largest, std::abs(t.c));
    if (largest == 0.0)
      throw ModelError(fmt::format("{}: the {} ties the port dof {} to ground or to another port", model.source,
                                   row.link, name(model, {terms.front().dof / 6, terms.front().dof % 6})),
                       "A port's six dofs must stay free: move the port or drop that constraint");
    const Term* pivot = nullptr;
    for (const Term& t : terms) {
      if (kept_.contains(t.dof)) continue;
      if (t.dof == row.dependent && std::abs(t.c) > 1e-6 * largest) {
        pivot = &t;
        break;
      }
      if (pivot == nullptr || std::abs(t.c) > std::abs(pivot->c)) pivot = &t;
    }
    double size = 0.0;  // of the row as it was
    int moving = 0;
    for (const Term& t : row.terms) {
      size = std::max(size, std::abs(t.c));
      if (moves(t.dof)) ++moving;
    }
    if (std::abs(pivot->c) < digits_of_coefficients * size)
      note(ConstraintNote::Kind::ill_determined, pivot->dof, std::abs(pivot->c) / size);
    else if (terms.size() == 1 && moving > 1)
      note(ConstraintNote::Kind::forced_zero, pivot->dof);
    else if (row.dependent >= 0 && expression(row.dependent) != nullptr)
      notes.push_back({ConstraintNote::Kind::dependent_twice,
                       fmt::format("{}, dependent already by {}", row.link, given_up_by_.at(row.dependent)),
                       {row.dependent / 6, row.dependent % 6}});
    given_up_by_.emplace(pivot->dof, row.link);
    give_up(pivot->dof, pivot->c, terms);
    return true;
  }

 private:
  enum State : char { free, held, dependent };
  static constexpr double digits_of_coefficients = 1e-6;  ///< that eight-column fields keep at least

  /// Neither held nor made zero by rows before.
  bool moves(int dof) const {
    const std::vector<Term>* e = expression(dof);
    return !is_held(dof) && (e == nullptr || !e->empty());
  }

  /// The terms with every dependent dof replaced and every held one dropped, equal dofs summed, round-off dropped.
  std::vector<Term> reduced(const std::vector<Term>& terms) const {
    std::unordered_map<int, std::pair<double, double>> sum;  // dof → (Σ c, Σ |c|)
    const auto add = [&sum](int dof, double c) {
      auto& [value, size] = sum[dof];
      value += c;
      size += std::abs(c);
    };
    for (const Term& t : terms) {
      if (state_[static_cast<std::size_t>(t.dof)] == held) continue;
      if (const std::vector<Term>* e = expression(t.dof))
        for (const Term& s : *e) add(s.dof, t.c * s.c);
      else
        add(t.dof, t.c);
    }
    double row_size = 0.0;
    for (const auto& [dof, value] : sum) row_size = std::max(row_size, value.second);
    std::vector<Term> result;
    for (const auto& [dof, value] : sum)
      if (std::abs(value.first) > std::max(1e-13 * value.second, 1e-15 * row_size))
        result.push_back({dof, value.first});
    std::sort(result.begin(), result.end(), [](const Term& a, const Term& b) { return a.dof < b.dof; });
    return result;
  }

  void give_up(int dof, double c, const std::vector<Term>& terms) {
    std::vector<Term> e;
    for (const Term& t : terms)
      if (t.dof != dof) e.push_back({t.dof, -t.c / c});
    state_[static_cast<std::size_t>(dof)] = dependent;
    for (const Term& t : e) users_[t.dof].push_back(dof);
    std::vector<int> users;
    if (const auto found = users_.find(dof); found != users_.end()) users = std::move(found->second);
    users_.erase(dof);
    expression_[dof] = std::move(e);
    for (const int user : users) {  // those that leaned on it lean on its expression now
      std::vector<Term>& of_user = expression_.at(user);
      of_user = reduced(of_user);
      for (const Term& t : of_user) {
        std::vector<int>& list = users_[t.dof];
        if (std::find(list.begin(), list.end(), user) == list.end()) list.push_back(user);
      }
    }
  }

  std::vector<State> state_;
  std::unordered_map<int, bool> kept_;
  std::unordered_map<int, std::vector<Term>> expression_;
  std::unordered_map<int, std::vector<int>> users_;
  std::unordered_map<int, std::string> given_up_by_;  ///< the link that made a dof dependent
};

std::vector<Row> rows_of(const Model& model) {
  std::vector<Row> rows;
  for (const RigidLink& link : model.rigid_links) rigid_link_rows(model, link, rows);
  for (const AverageLink& link : model.average_links) average_link_rows(model, link, rows);
  for (const LinearConstraint& constraint : model.constraints) {
    Row row{{}, -1, fmt::format("linear constraint {}", constraint.id)};
    for (const LinearConstraint::Term& t : constraint.terms)
      row.terms.push_back({full(t.dof.node, t.dof.direction), t.coefficient});
    if (!row.terms.empty()) row.dependent = row.terms.front().dof;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Mat6X averaging_matrix(const Model& model, const AverageLink& link) {
  const Vec3& x = position(model, link.reference);
  double distance = 0.0;
  int columns = 0;
  for (const AverageLink::Group& group : link.nodes) {
    distance += (position(model, group.node) - x).norm() / static_cast<double>(link.nodes.size());
    for (int d = 0; d < 6; ++d) columns += has(group.directions, d) ? 1 : 0;
  }
  const double length = distance > 0.0 ? distance : 1.0;  // rotations weigh as translations at the mean distance
  // minimise Σ w |u − S u_ref|², S the rigid motion of each included dof; rotations of u_ref scaled by the length
  Mat6X SW = Mat6X::Zero(6, columns);
  Mat6 normal = Mat6::Zero();
  Eigen::Index column = 0;
  for (const AverageLink::Group& group : link.nodes) {
    Mat6 S = tau(model.nodes[static_cast<std::size_t>(group.node)] - x);
    S.rightCols<3>() /= length;
    for (int d = 0; d < 6; ++d) {
      if (!has(group.directions, d)) continue;
      const double scale = d < 3 ? 1.0 : length;
      SW.col(column) = group.weight * scale * scale * S.row(d).transpose();
      normal += SW.col(column) * S.row(d);
      ++column;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd{normal});
  if (!(eigen.eigenvalues()(0) > 1e-12 * eigen.eigenvalues()(5)))
    throw ModelError(
        fmt::format("{}: the {}{} has nodes that do not determine a rigid motion (condition {:.1e})", model.source,
                    link_name(model, link), link.id < 0 ? "" : " at " + name(model, link.reference),
                    eigen.eigenvalues()(0) / eigen.eigenvalues()(5)),
        "Add nodes off their common line, include their rotations, or use a rigid link");
  Mat6X A = normal.ldlt().solve(SW);
  A.bottomRows<3>() /= length;
  return A;
}

DofMap eliminate_constraints(const Model& model, const std::vector<char>& used) {
  const int n_full = static_cast<int>(6 * model.nodes.size());
  std::vector<char> named(used);
  Elimination elimination(n_full);
  for (const Support& support : model.supports) elimination.hold(full(support.dof.node, support.dof.direction));
  for (const Port& port : model.ports)
    for (int d = 0; d < 6; ++d) {
      elimination.keep(full(port.node, d));
      named[static_cast<std::size_t>(full(port.node, d))] = 1;
    }

  DofMap map;
  for (const Row& row : rows_of(model)) {
    for (const Term& t : row.terms) named[static_cast<std::size_t>(t.dof)] = 1;
    if (!elimination.add(model, row, map.notes)) ++map.redundant_constraints;
  }

  std::vector<int> free_index(static_cast<std::size_t>(n_full), -1);
  std::vector<char> scalar(model.nodes.size(), 0);
  for (const int node : model.scalar_points) scalar[static_cast<std::size_t>(node)] = 1;
  for (int i = 0; i < n_full; ++i) {
    const Dof dof{i / 6, i % 6};
    if (elimination.is_held(i) || elimination.expression(i) != nullptr) continue;
    if (named[static_cast<std::size_t>(i)] == 0) {
      if (scalar[static_cast<std::size_t>(dof.node)] == 0 || dof.direction == 0) map.unused.push_back(dof);
      continue;
    }
    free_index[static_cast<std::size_t>(i)] = map.n_free();
    map.free.push_back(dof);
  }
  map.names.resize(map.free.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < map.free.size(); ++i) map.names[i] = name(model, map.free[i]);
  map.start.reserve(static_cast<std::size_t>(n_full) + 1);
  map.terms.reserve(map.free.size());
  map.start.push_back(0);
  for (int i = 0; i < n_full; ++i) {
    if (const std::vector<Term>* e = elimination.expression(i)) {
      for (const Term& t : *e)
        if (free_index[static_cast<std::size_t>(t.dof)] >= 0)
          map.terms.push_back({free_index[static_cast<std::size_t>(t.dof)], t.c});
    } else if (free_index[static_cast<std::size_t>(i)] >= 0) {
      map.terms.push_back({free_index[static_cast<std::size_t>(i)], 1.0});
    }
    map.start.push_back(static_cast<int>(map.terms.size()));
  }
  return map;
}

}  // namespace tenon::fem
