#include "fem/structure.hpp"

namespace tenon::fem {

int DofMap::row(const Dof& dof) const {
  const auto i = static_cast<std::size_t>(6 * dof.node + dof.direction);
  if (start[i + 1] - start[i] != 1) return -1;
  const Term& term = terms[static_cast<std::size_t>(start[i])];
  const Dof& candidate = free[static_cast<std::size_t>(term.free)];
  return candidate.node == dof.node && candidate.direction == dof.direction ? term.free : -1;
}

Eigen::MatrixXd DofMap::expand(const Eigen::Ref<const Eigen::MatrixXd>& u_free) const {
  const auto n_full = static_cast<Eigen::Index>(start.size()) - 1;
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(n_full, u_free.cols());
  for (Eigen::Index i = 0; i < n_full; ++i)
    for (int t = start[static_cast<std::size_t>(i)]; t < start[static_cast<std::size_t>(i) + 1]; ++t) {
      const Term& term = terms[static_cast<std::size_t>(t)];
      u.row(i) += term.coefficient * u_free.row(term.free);
    }
  return u;
}

Mat6X DofMap::expand_node(int node, const Eigen::Ref<const Eigen::MatrixXd>& u_free) const {
  Mat6X u = Mat6X::Zero(6, u_free.cols());
  for (int d = 0; d < 6; ++d) {
    const auto i = static_cast<std::size_t>(6 * node + d);
    for (int t = start[i]; t < start[i + 1]; ++t) {
      const Term& term = terms[static_cast<std::size_t>(t)];
      u.row(d) += term.coefficient * u_free.row(term.free);
    }
  }
  return u;
}

}  // namespace tenon::fem
