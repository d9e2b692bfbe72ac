#include "fem/matrix_part.hpp"

#include <fmt/format.h>

#include <map>
#include <span>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

using Entry = Eigen::Triplet<double>;

std::size_t full(const Dof& dof) { return static_cast<std::size_t>(6 * dof.node + dof.direction); }

SparseMatrix lower_of(const SparseMatrix& A) {
  SparseMatrix lower = A.triangularView<Eigen::Lower>();
  lower.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
  lower.makeCompressed();
  return lower;
}

}  // namespace

void require_consistent_parts(const Model& model) {
  std::vector<char> seen;
  for (const auto& part : model.matrix_parts) {
    const auto n = static_cast<Eigen::Index>(part->dofs.size());
    if (part->K.rows() != n || part->K.cols() != n || part->M.rows() != n || part->M.cols() != n)
      throw ModelError(fmt::format("{}: matrices of {}×{} (K) and {}×{} (M) for {} labelled rows", model.source,
                                   part->K.rows(), part->K.cols(), part->M.rows(), part->M.cols(), n),
                       "K and M must be square and have one label a row");
    seen.assign(6 * model.nodes.size(), 0);
    for (const Dof& dof : part->dofs) {
      if (dof.node < 0 || dof.node >= static_cast<int>(model.nodes.size()) || dof.direction < 0 || dof.direction > 5)
        throw ModelError(fmt::format("{}: a row of matrices belongs to direction {} of node index {}", model.source,
                                     dof.direction, dof.node),
                         "Directions are 0..5, nodes those of the model");
      if (seen[full(dof)]++ != 0)
        throw ModelError(fmt::format("{}: two rows of the matrices belong to {}", model.source, name(model, dof)),
                         "Label each row with a dof of its own");
    }
  }
}

void mark_used(const MatrixPart& part, std::vector<char>& used) {
  for (const SparseMatrix* A : {&part.K, &part.M})
    for (int j = 0; j < A->outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(*A, j); it; ++it)
        if (it.value() != 0.0)
          used[full(part.dofs[static_cast<std::size_t>(it.row())])] =
              used[full(part.dofs[static_cast<std::size_t>(j)])] = 1;
}

SparseMatrix over_free_dofs(const MatrixPart& part, const SparseMatrix& A, const DofMap& map) {
  const auto n_part = static_cast<Eigen::Index>(part.dofs.size());
  const auto terms = [&](Eigen::Index i) {
    const std::size_t f = full(part.dofs[static_cast<std::size_t>(i)]);
    return std::span(map.terms).subspan(static_cast<std::size_t>(map.start[f]),
                                        static_cast<std::size_t>(map.start[f + 1] - map.start[f]));
  };
  const auto is_free = [](std::span<const DofMap::Term> t) { return t.size() == 1 && t.front().coefficient == 1.0; };
  std::vector<Entry> plain, linked, T_entries;
  plain.reserve(static_cast<std::size_t>(A.nonZeros()));
  std::vector<char> in_T(part.dofs.size(), 0);
  const auto add_to_T = [&](Eigen::Index i) {
    if (in_T[static_cast<std::size_t>(i)]++ == 0)
      for (const DofMap::Term& t : terms(i)) T_entries.emplace_back(static_cast<int>(i), t.free, t.coefficient);
    in_T[static_cast<std::size_t>(i)] = 1;
  };
  for (int j = 0; j < A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(A, j); it; ++it) {
      if (it.value() == 0.0) continue;
      const auto a = terms(it.row()), b = terms(j);
      if (a.empty() || b.empty()) continue;
      if (is_free(a) && is_free(b)) {
        const int p = a.front().free, q = b.front().free;
        const bool meet = p == q && it.row() != j;  // two dofs that move as one: both triangles land on the diagonal
        plain.emplace_back(std::max(p, q), std::min(p, q), meet ? 2.0 * it.value() : it.value());
        continue;
      }
      linked.emplace_back(static_cast<int>(it.row()), j, it.value());
      if (it.row() != j) linked.emplace_back(j, static_cast<int>(it.row()), it.value());
      add_to_T(it.row());
      add_to_T(j);
    }
  SparseMatrix result(map.n_free(), map.n_free());
  result.setFromTriplets(plain.begin(), plain.end());
  if (linked.empty()) return result;
  SparseMatrix rest(n_part, n_part), T(n_part, map.n_free());
  rest.setFromTriplets(linked.begin(), linked.end());
  T.setFromTriplets(T_entries.begin(), T_entries.end());
  const SparseMatrix AT = rest * T;
  return result + lower_of(SparseMatrix(T.transpose()) * AT);
}

std::shared_ptr<const MatrixPart> moved(const MatrixPart& part, const Mat3& R, int first_node,
                                        const std::vector<char>& scalar) {
  auto result = std::make_shared<MatrixPart>();
  if (R.isIdentity(0.0)) {
    *result = part;
    for (Dof& dof : result->dofs) dof.node += first_node;
    return result;
  }
  std::map<std::pair<int, int>, int> row_of;  // (node, direction) of the turned part
  const auto row = [&](int node, int direction) {
    const auto [at, made] = row_of.try_emplace({node, direction}, static_cast<int>(result->dofs.size()));
    if (made) result->dofs.push_back({node + first_node, direction});
    return at->second;
  };
  std::vector<Entry> entries;  // of Q: turned displacements from those of the part
  for (std::size_t k = 0; k < part.dofs.size(); ++k) {
    const Dof& dof = part.dofs[k];
    const auto column = static_cast<int>(k);
    if (scalar[static_cast<std::size_t>(dof.node)] != 0) {
      entries.emplace_back(row(dof.node, 0), column, 1.0);
      continue;
    }
    const int block = 3 * (dof.direction / 3);
    for (int i = 0; i < 3; ++i) entries.emplace_back(row(dof.node, block + i), column, R(i, dof.direction % 3));
  }
  SparseMatrix Q(static_cast<Eigen::Index>(result->dofs.size()), static_cast<Eigen::Index>(part.dofs.size()));
  Q.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix Qt = Q.transpose();
  const auto turned = [&](const SparseMatrix& A) {
    const SparseMatrix whole = A.selfadjointView<Eigen::Lower>();
    const SparseMatrix AQt = whole * Qt;
    return lower_of(Q * AQt);
  };
  result->rounding = part.rounding;
  result->K = turned(part.K);
  result->M = turned(part.M);
  return result;
}

}  // namespace tenon::fem
