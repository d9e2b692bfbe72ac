#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <numeric>
#include <optional>
#include <ranges>

#include "fem/constraints.hpp"
#include "fem/elements/beam.hpp"
#include "fem/elements/bush.hpp"
#include "fem/elements/general_beam.hpp"
#include "fem/elements/point_mass.hpp"
#include "fem/elements/rod.hpp"
#include "fem/elements/shell.hpp"
#include "fem/elements/spring.hpp"
#include "fem/error.hpp"
#include "fem/loose_rotations.hpp"
#include "fem/matrix_part.hpp"
#include "fem/rigid_forces.hpp"
#include "fem/shell_directors.hpp"
#include "fem/sparsity.hpp"
#include "fem/structure.hpp"

namespace tenon::fem {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

/// The full dofs of an element in the order of its matrices, at most 24.
struct FullDofs {
  std::array<int, ElementMatrices::max_dofs> dof{};
  int size = 0;

  void add_node(int node) {
    for (int d = 0; d < 6; ++d) dof[static_cast<std::size_t>(size++)] = 6 * node + d;
  }
  /// One dof, or the three of its kind when `axis` is given.
  void add_end(int node, int direction, const Vec3& axis) {
    const bool skew = axis != Vec3::Zero();
    const int first = skew ? direction / 3 * 3 : direction;
    for (int d = first; d < first + (skew ? 3 : 1); ++d) dof[static_cast<std::size_t>(size++)] = 6 * node + d;
  }
};

FullDofs full_dofs(const Element& element) {
  FullDofs dofs;
  std::visit(Overloaded{[&](const PointMass& e) { dofs.add_node(e.node); },
                        [&](const Spring& e) {
                          dofs.add_end(e.node_a, e.dof_a, e.axis_a);
                          if (e.node_b >= 0) dofs.add_end(e.node_b, e.dof_b, e.axis_b);
                        },
                        [&](const Bush& e) {
                          dofs.add_node(e.node_a);
                          if (e.node_b >= 0) dofs.add_node(e.node_b);
                        },
                        [&](const auto& e) {
                          for (const int node : e.nodes) dofs.add_node(node);
                        }},
             element);
  return dofs;
}

void element_matrices(const Model& model, std::span<const Vec3> directors, const Element& element,
                      ElementMatrices& out) {
  const auto material = [&](int i) -> const Material& { return model.materials[static_cast<std::size_t>(i)]; };
  const auto shell = [&](int i) -> const ShellSection& { return model.shell_sections[static_cast<std::size_t>(i)]; };
  std::visit(Overloaded{[&](const Beam& e) {
                          const SectionLine line(model, e);
                          line.plain() ? beam_matrices(e, line.section(0), material(e.material), model.nodes, out)
                                       : general_beam_matrices(e, line, material(e.material), model.nodes, out);
                        },
                        [&](const Quad4& e) {
                          quad4_matrices(e, shell(e.section), material(e.material), model.nodes, out, directors);
                        },
                        [&](const Tria3& e) {
                          tria3_matrices(e, shell(e.section), material(e.material), model.nodes, out, directors);
                        },
                        [&](const PointMass& e) { point_mass_matrices(e, out); },
                        [&](const Spring& e) { spring_matrices(e, out); },
                        [&](const Rod& e) {
                          rod_matrices(e, model.beam_sections[static_cast<std::size_t>(e.section)],
                                       material(e.material), model.nodes, out);
                        },
                        [&](const Bush& e) { bush_matrices(e, model.nodes, out); }},
             element);
}

std::vector<char> used_dofs(const Model& model) {
  std::vector<char> used(6 * model.nodes.size(), 0);
  for (const Element& element : model.elements) {
    const FullDofs dofs = full_dofs(element);
    for (int i = 0; i < dofs.size; ++i) used[static_cast<std::size_t>(dofs.dof[static_cast<std::size_t>(i)])] = 1;
  }
  for (const auto& part : model.matrix_parts) mark_used(*part, used);
  return used;
}

ElementDofs free_dofs(const Model& model, const DofMap& map) {
  const std::size_t total = model.elements.size();
  ElementDofs elements;
  elements.start.assign(total + 1, 0);
  std::vector<std::vector<int>> of_thread(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
  {
    std::vector<int> mine, list;
#pragma omp for schedule(static)
    for (std::size_t e = 0; e < total; ++e) {
      const FullDofs dofs = full_dofs(model.elements[e]);
      list.clear();
      for (int i = 0; i < dofs.size; ++i) {
        const auto f = static_cast<std::size_t>(dofs.dof[static_cast<std::size_t>(i)]);
        for (int t = map.start[f]; t < map.start[f + 1]; ++t)
          list.push_back(map.terms[static_cast<std::size_t>(t)].free);
      }
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      mine.insert(mine.end(), list.begin(), list.end());
      elements.start[e + 1] = static_cast<int>(list.size());
    }
    of_thread[static_cast<std::size_t>(omp_get_thread_num())] = std::move(mine);
  }
  std::partial_sum(elements.start.begin(), elements.start.end(), elements.start.begin());
  elements.dofs.reserve(static_cast<std::size_t>(elements.start.back()));
  for (const auto& dofs : of_thread) elements.dofs.insert(elements.dofs.end(), dofs.begin(), dofs.end());
  return elements;
}

/// T_eᵀ A_e T_e of an element over its free dofs, these in rising order.
struct Contribution {
  Eigen::MatrixXd A;
  Eigen::MatrixXd T, AT;  ///< scratch
};

const DofMap::Term& only_term(const DofMap& map, int dof) {
  return map.terms[static_cast<std::size_t>(map.start[static_cast<std::size_t>(dof)])];
}

/// Every dof is itself free.
bool plain(const DofMap& map, const FullDofs& dofs) {
  for (int i = 0; i < dofs.size; ++i) {
    const int dof = dofs.dof[static_cast<std::size_t>(i)];
    const auto f = static_cast<std::size_t>(dof);
    if (map.start[f + 1] - map.start[f] != 1 || only_term(map, dof).coefficient != 1.0) return false;
  }
  return true;
}

void transform(const DofMap& map, const FullDofs& dofs, std::span<const int> free, const ElementMatrices::Matrix& A,
               Contribution& out) {
  const auto place = [&](int dof) { return std::lower_bound(free.begin(), free.end(), dof) - free.begin(); };
  const auto n = static_cast<Eigen::Index>(free.size());
  if (plain(map, dofs)) {
    std::array<Eigen::Index, ElementMatrices::max_dofs> to{};
    for (int i = 0; i < dofs.size; ++i)
      to[static_cast<std::size_t>(i)] = place(only_term(map, dofs.dof[static_cast<std::size_t>(i)]).free);
    out.A.setZero(n, n);
    for (int j = 0; j < dofs.size; ++j)
      for (int i = 0; i < dofs.size; ++i)
        out.A(to[static_cast<std::size_t>(i)], to[static_cast<std::size_t>(j)]) += A(i, j);
    return;
  }
  out.T.setZero(dofs.size, n);
  for (int i = 0; i < dofs.size; ++i) {
    const auto f = static_cast<std::size_t>(dofs.dof[static_cast<std::size_t>(i)]);
    for (int t = map.start[f]; t < map.start[f + 1]; ++t) {
      const DofMap::Term& s = map.terms[static_cast<std::size_t>(t)];
      out.T(i, place(s.free)) += s.coefficient;
    }
  }
  out.AT.noalias() = A * out.T;
  out.A.noalias() = out.T.transpose() * out.AT;
}

/// A += contribution, lower triangle, in the columns that `owned` chooses.
template <class Owned>
void scatter(const Contribution& contribution, std::span<const int> free, LowerTriangle& A, Beside& beside,
             Owned owned) {
  for (std::size_t b = 0; b < free.size(); ++b) {
    const int j = free[b];
    if (!owned(j)) continue;
    int at = 0;  // rows come in rising order
    for (std::size_t a = b; a < free.size(); ++a) {
      const double value = contribution.A(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      if (value == 0.0) continue;
      const int found = A.position(free[a], j, at);
      if (found < 0) {
        beside[static_cast<std::size_t>(j / columns_of_strip)].emplace_back(free[a], j, value);
        continue;
      }
      A.value[found] += value;
      at = found;
    }
  }
}

[[noreturn]] void rethrow(const std::exception_ptr& fault, const std::string& source) {
  try {
    std::rethrow_exception(fault);
  } catch (const ModelError& error) {
    if (source.empty()) throw;
    throw ModelError(source, error);
  }
}

/// Elements are computed side by side in chunks; then each thread adds them all, in their order, to columns of its own:
/// the sums do not depend on the number of threads.
void add_elements(const Model& model, std::span<const Vec3> directors, const DofMap& map, const ElementDofs& elements,
                  ElementMatrices::Matrix ElementMatrices::*part, LowerTriangle& A, Beside& beside) {
  constexpr std::size_t chunk = 512;
  const std::size_t total = model.elements.size();
  // A thread that has added its columns starts the next chunk while the other still reads this one: the threads wait
  // for each other once a chunk, at the end of the loop that computes it.
  std::array<std::vector<Contribution>, 2> chunks;
  for (auto& contributions : chunks) contributions.resize(std::min(chunk, total));
  std::exception_ptr fault;
  std::atomic<std::size_t> faulty = total;
#pragma omp parallel
  {
    const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
    ElementMatrices matrices;
    for (std::size_t first = 0; first < total; first += chunk) {
      const std::size_t count = std::min(chunk, total - first);
      std::vector<Contribution>& contributions = chunks[first / chunk % 2];
#pragma omp for schedule(dynamic, 16)
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t e = first + i;
        if (e > faulty) continue;
        try {
          element_matrices(model, directors, model.elements[e], matrices);
          transform(map, full_dofs(model.elements[e]), elements.of(e), matrices.*part, contributions[i]);
        } catch (...) {
#pragma omp critical(tenon_element_fault)
          if (e < faulty) {
            faulty = e;
            fault = std::current_exception();
          }
        }
      }
      if (faulty < total) continue;  // no thread leaves: all meet at each chunk's end
      for (std::size_t i = 0; i < count; ++i)
        scatter(contributions[i], elements.of(first + i), A, beside,
                [=](int j) { return threads == 1 || (j / columns_of_strip) % threads == thread; });
    }
  }
  if (fault) rethrow(fault, model.source);
}

/// Eigen's assignment would copy what a function returns.
void take(SparseMatrix& into, SparseMatrix from) { into.swap(from); }

/// Rows that got neither stiffness nor mass are taken out (a port's rows stay, so that reduction can say what is
/// missing).
void drop_empty_rows(const Model& model, Structure& s) {
  const Eigen::VectorXd k = diagonal(s.K), m = diagonal(s.M);
  std::vector<char> is_port(model.nodes.size(), 0);
  for (const Port& port : model.ports) is_port[static_cast<std::size_t>(port.node)] = 1;
  DofMap& map = s.dofs;
  const auto is_dropped = [&](int i) {
    return k(i) == 0.0 && m(i) == 0.0 &&
           is_port[static_cast<std::size_t>(map.free[static_cast<std::size_t>(i)].node)] == 0;
  };
  if (std::ranges::none_of(std::views::iota(0, static_cast<int>(s.n())), is_dropped)) return;
  std::vector<int> kept(static_cast<std::size_t>(s.n()), -1);
  std::vector<Dof> free;
  std::vector<std::string> names;
  for (int i = 0; i < s.n(); ++i) {
    const auto u = static_cast<std::size_t>(i);
    if (is_dropped(i)) {
      map.unused.push_back(map.free[u]);
      continue;
    }
    kept[u] = static_cast<int>(free.size());
    free.push_back(map.free[u]);
    names.push_back(std::move(map.names[u]));
  }
  map.names = std::move(names);
  std::vector<int> start{0};
  std::vector<DofMap::Term> terms;
  for (std::size_t f = 0; f + 1 < map.start.size(); ++f) {
    for (int t = map.start[f]; t < map.start[f + 1]; ++t) {
      DofMap::Term term = map.terms[static_cast<std::size_t>(t)];
      term.free = kept[static_cast<std::size_t>(term.free)];
      if (term.free >= 0) terms.push_back(term);
    }
    start.push_back(static_cast<int>(terms.size()));
  }
  map.start = std::move(start);
  map.terms = std::move(terms);
  const auto restrict = [&](const SparseMatrix& A) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(A.nonZeros()));
    for (int j = 0; j < A.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(A, j); it; ++it)
        if (const int a = kept[static_cast<std::size_t>(it.row())], b = kept[static_cast<std::size_t>(j)];
            a >= 0 && b >= 0)
          entries.emplace_back(a, b, it.value());
    SparseMatrix result(static_cast<Eigen::Index>(free.size()), static_cast<Eigen::Index>(free.size()));
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  };
  take(s.K, restrict(s.K));
  take(s.M, restrict(s.M));
  map.free = std::move(free);
}

/// Nodes of solids have no rotations, so that a port there would turn without resistance.
void require_complete_ports(const Model& model, const Structure& s) {
  const Eigen::VectorXd k = s.K.diagonal(), m = s.M.diagonal();
  for (const Port& port : model.ports) {
    std::vector<std::string_view> loose;
    static constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
    for (int d = 0; d < 6; ++d)
      if (const int row = s.dofs.row({port.node, d}); row >= 0 && k(row) == 0.0 && m(row) == 0.0)
        loose.emplace_back(directions[static_cast<std::size_t>(d)]);
    if (!loose.empty())
      throw ModelError(fmt::format("{}: port '{}' lies on {}, which has neither stiffness nor mass in {}", model.source,
                                   port.name, name(model, port.node), fmt::join(loose, ", ")),
                       "Join the port to a `set` of several nodes: their translations carry its rotations");
  }
}

/// Constraints eliminated, those of rotations that nothing holds or moves among them.
DofMap dof_map(const Model& model) {
  const std::vector<LinearConstraint> loose = loose_rotations(model);
  if (loose.empty()) return eliminate_constraints(model, used_dofs(model));
  Model held = model;
  held.constraints.insert(held.constraints.end(), loose.begin(), loose.end());
  return eliminate_constraints(held, used_dofs(model));
}

}  // namespace

Structure assemble(const Model& model) {
  if (model.elements.empty() && model.matrix_parts.empty())
    throw ModelError(fmt::format("{}: the model has no elements", model.source),
                     "Give sections to the mesh's lines and surfaces, or check the set names");
  require_consistent_parts(model);
  Structure s;
  s.dofs = dof_map(model);
  const ElementDofs elements = free_dofs(model, s.dofs);
  const std::vector<Vec3> directors = shell_directors(model);
  const auto nothing_beside = [&] { return Beside(static_cast<std::size_t>(s.dofs.n_free() / columns_of_strip + 1)); };
  {
    LowerTriangle K = lower_zeros(elements, s.dofs.n_free());
    Beside beside = nothing_beside();
    add_elements(model, directors, s.dofs, elements, &ElementMatrices::K, K, beside);
    take(s.K, without_zeros(std::move(K), std::move(beside)));
  }
  // Mass acts, but for offset points, where stiffness does: it grows in the entries that K has kept. The elements are
  // computed anew for it, which costs less than holding both patterns in full.
  LowerTriangle M = zeros_of_pattern(s.K);
  Beside beside = nothing_beside();
  add_elements(model, directors, s.dofs, elements, &ElementMatrices::M, M, beside);
  take(s.M, without_zeros(std::move(M), std::move(beside)));
  for (const auto& part : model.matrix_parts) {
    s.K = SparseMatrix(s.K + over_free_dofs(*part, part->K, s.dofs));
    s.M = SparseMatrix(s.M + over_free_dofs(*part, part->M, s.dofs));
  }
  if (!model.matrix_parts.empty()) require_complete_ports(model, s);
  s.nodes = model.nodes;
  s.node_ids = model.node_ids;
  s.scalar_points = model.scalar_points;
  s.ports = model.ports;
  s.rounding = rigid_rounding(model);
  drop_empty_rows(model, s);
  return s;
}

}  // namespace tenon::fem
