#include "titop/mode_shapes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "fem/error.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using reduction::ReducedBody;

// Outputs of the constrained model are positions, accelerations, reactions: the rows of ẍ_P are found by name order,
// the free directions port by port.
InvertedModes inverted_modes(const ReducedBody& body, const std::vector<int>& I) {
  const PortModel port = port_model(body);
  const Boundary boundary = boundary_of(port, I);
  const ConstraintBasis basis = constraint_basis(body, boundary);
  const ConstrainedModel model = constrain_by_inversion(body, boundary);
  const Index k = basis.N.cols();
  Index free = 0, first = 0;  // free directions of all ports, and of the ports before P
  for (int p = 0; p < static_cast<int>(boundary.ports.size()); ++p) {
    const auto& fixed = boundary.ports[static_cast<std::size_t>(p)].fixed;
    if (p == body.parent) first = free;
    free += std::count(fixed.begin(), fixed.end(), false);
  }
  const Eigen::EigenSolver<MatrixXd> eigen(model.ss.A.topLeftCorner(2 * k, 2 * k));
  std::vector<Index> order;
  for (Index j = 0; j < 2 * k; ++j)
    if (eigen.eigenvalues()[j].imag() > 0.0) order.push_back(j);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::abs(eigen.eigenvalues()[a]) < std::abs(eigen.eigenvalues()[b]); });

  const auto count = static_cast<Index>(order.size());
  InvertedModes modes{Eigen::VectorXd(count), MatrixXd(body.n(), count), MatrixXd::Zero(6, count), 0.0};
  if (k > 0) modes.largest_real = eigen.eigenvalues().real().cwiseAbs().maxCoeff();
  for (Index j = 0; j < count; ++j) {
    const std::complex<double> pole = eigen.eigenvalues()[order[static_cast<std::size_t>(j)]];
    const VectorXcd v = eigen.eigenvectors().col(order[static_cast<std::size_t>(j)]);
    modes.omega[j] = std::abs(pole);
    const VectorXcd eta = basis.N * v.head(k);
    VectorXcd reference = VectorXcd::Zero(6);
    Index row = free + first;  // of ẍ_P
    for (Index i = 0; i < 6; ++i)
      if (!boundary.ports[static_cast<std::size_t>(body.parent)].fixed[static_cast<std::size_t>(i)])
        reference[i] = (model.ss.C.row(row++).head(2 * k) * v).value() / (pole * pole);
    Index largest = 0;
    eta.cwiseAbs().maxCoeff(&largest);
    modes.eta.col(j) = (eta / eta[largest]).real();
    modes.reference.col(j) = (reference / eta[largest]).real();
  }
  for (Index j = 0; j < count; ++j) {  // qᵀMq = 1
    const auto x = modes.reference.col(j);
    const auto eta = modes.eta.col(j);
    const double mass = x.dot(body.D * x) + 2.0 * eta.dot(body.L * x) + eta.squaredNorm();
    modes.reference.col(j) /= std::sqrt(mass);
    modes.eta.col(j) /= std::sqrt(mass);
  }
  fix_signs(body, modes.reference, modes.eta);
  return modes;
}

MatrixXd node_motions(const ReducedBody& body, const MatrixXd& reference, const MatrixXd& eta) {
  if (body.node_positions.empty())
    throw ModelError(fmt::format("body '{}' keeps no shapes at nodes", body.name),
                     "Reduce it with node shapes, or give the beam samples");
  MatrixXd motion = body.node_shapes * eta;
  for (std::size_t k = 0; k < body.node_positions.size(); ++k)
    motion.middleRows<6>(6 * static_cast<Index>(k)) += fem::tau(body.node_positions[k] - body.reference) * reference;
  return motion;
}

}  // namespace tenon::titop
