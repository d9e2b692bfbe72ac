#include "reduction/reduce.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "fem/error.hpp"
#include "fem/rigid_forces.hpp"
#include "reduction/dense.hpp"
#include "reduction/eq1.hpp"
#include "reduction/partition.hpp"
#include "reduction/shape_integrals.hpp"
#include "reduction/sparse.hpp"
#include "reduction/subspace.hpp"

namespace tenon::reduction {

namespace {

// rows of T V at a port, zero where its node has no such dof
Mat6X port_shapes(const std::array<int, 6>& rows, const Eigen::MatrixXd& T, const Eigen::MatrixXd& V) {
  Mat6X at_port = Mat6X::Zero(6, T.cols());
  for (int d = 0; d < 6; ++d)
    if (const int row = rows[static_cast<std::size_t>(d)]; row >= 0) at_port.row(d) = T.row(row);
  return at_port * V;
}

bool children_free(Basis basis) {
  return basis == Basis::clamped_free || basis == Basis::clamped_free_static || basis == Basis::rubin;
}

const char* mode_kind(Basis basis) {
  return basis == Basis::rubin ? "free-free" : children_free(basis) ? "clamped" : "fixed-interface";
}

// inertia of the rigid motions M R, wrenches at the child ports, or nothing
Loads loads(const fem::Structure& structure, const Partition& parts, const Eigen::MatrixXd& MR, const Basis basis,
            bool all_modes) {
  if (basis == Basis::craig_bampton_inertia_relief && !all_modes) {
    Loads inertia{MR, {}};
    for (const char* direction : directions) inertia.names.push_back(fmt::format("inertia along {}", direction));
    return inertia;
  }
  if (basis == Basis::clamped_free_static) return unit_loads(structure, parts, parts.parent);
  return {Eigen::MatrixXd(structure.n(), 0), {}};
}

// certificate.basis
std::string contents(const Partition& parts, const Subspace& space, Basis basis, const std::string& parent) {
  const auto modes = space.modes.lambda.size();
  switch (basis) {
    case Basis::craig_bampton:
      return fmt::format("craig-bampton, {} fixed-interface modes and {} constraint modes", modes,
                         parts.children.size());
    case Basis::craig_bampton_inertia_relief:
      return fmt::format(
          "craig-bampton with inertia relief, {} fixed-interface modes, {} constraint modes and {} inertia-relief "
          "shapes",
          modes, parts.children.size(), space.statics);
    case Basis::clamped_free:
      return fmt::format("clamped-free, {} modes clamped at '{}'", modes, parent);
    case Basis::clamped_free_static:
      return fmt::format("clamped-free with statics, {} modes clamped at '{}' and {} residual static shapes", modes,
                         parent, space.statics);
    case Basis::rubin:
      break;
  }
  return fmt::format("rubin, {} free-free modes and {} residual inertia-relief attachment modes", modes, space.statics);
}

std::vector<std::string> sentences(const fem::Structure& structure, const Partition& parts, const Subspace& space,
                                   const ModalForm& modal, Basis basis) {
  std::vector<std::string> said;
  const double next = std::sqrt(std::max(space.modes.next_lambda, 0.0));
  if (next > 0.0)
    said.push_back(fmt::format("{} modes from {:.6g} Hz on", mode_kind(basis), next / (2.0 * std::numbers::pi)));
  if (!space.dropped.empty())
    said.push_back(fmt::format("static shapes of {}: nothing beyond rounding that the other shapes do not hold",
                               fmt::join(space.dropped, ", ")));
  if (modal.massless > 0)
    said.push_back(
        fmt::format("inertia of {} massless static shape(s), carried as modes at {:.6g} Hz ({:g} times the "
                    "highest other one): static flexibility exact, dynamic error below (f/{:.3g} Hz)²",
                    modal.massless, modal.omega[modal.omega.size() - 1] / (2.0 * std::numbers::pi), massless_frequency,
                    modal.omega[modal.omega.size() - 1] / (2.0 * std::numbers::pi)));
  for (std::size_t k = 0; k < parts.ports.size(); ++k) {
    std::string missing;
    for (std::size_t d = 0; d < 6; ++d)
      if (parts.ports[k][d] < 0) missing += std::string(missing.empty() ? "" : " ") + directions[d];
    if (!missing.empty())
      said.push_back(fmt::format("port '{}' has no stiffness or mass in {}: there it follows the reference rigidly",
                                 structure.ports[k].name, missing));
  }
  return said;
}

}  // namespace

ReducedBody reduce(const fem::Structure& structure, const std::string& parent, const ReduceOptions& options) {
  const auto progress = [&](double fraction, const char* step) {
    if (options.progress) options.progress(fraction, step);
  };
  progress(0.0, "checks");
  const Basis basis = options.basis;
  const Partition parts = partition(structure, parent, children_free(basis));
  require_stiffness_path(structure, parts);
  const fem::Port& hung = structure.ports[static_cast<std::size_t>(parts.parent)];
  const Vec3 reference = structure.nodes[static_cast<std::size_t>(hung.node)];
  const Eigen::MatrixXd R = fem::rigid_motions(structure, reference);
  const double rigid_force = require_free_body(structure, R);

  progress(0.1, "component modes");
  const int count = options.all_modes ? static_cast<int>(parts.interior.size()) : options.modes;
  const std::optional<double> band = options.all_modes ? std::nullopt : options.band;
  const ModesOptions wanted{.count = count, .band = band, .progress = options.progress};
  const Eigen::MatrixXd MR = symmetric_product(structure.M, R);
  const Subspace space =
      basis == Basis::rubin
          ? free_modes(structure, parts, R, wanted)
          : component_modes(structure, parts, loads(structure, parts, MR, basis, options.all_modes), wanted);

  progress(0.9, "eq (1)");
  // u = R x_P + T z: M_zz = TᵀMT, M_zP = TᵀMR, D = RᵀMR; K R = 0 leaves K_zz = TᵀKT alone
  const Eigen::MatrixXd MT = symmetric_product(structure.M, space.T);
  RelativeForm relative{space.K_zz, transposed_product(space.T, MT), transposed_product(space.T, MR)};
  relative.M_zz = 0.5 * (relative.M_zz + relative.M_zz.transpose()).eval();
  const ModalForm modal = modal_form(relative);

  ReducedBody body;
  body.reference = reference;
  body.parent = parts.parent;
  body.omega = modal.omega;
  body.zeta = Eigen::VectorXd::Constant(modal.omega.size(), options.zeta);
  body.L = modal.L;
  const Eigen::MatrixXd D = transposed_product(R, MR);
  body.D = 0.5 * (D + D.transpose());
  for (std::size_t k = 0; k < structure.ports.size(); ++k) {
    const fem::Port& port = structure.ports[k];
    body.ports.push_back({port.name, structure.nodes[static_cast<std::size_t>(port.node)], port.axes,
                          port_shapes(parts.ports[k], space.T, modal.V)});
  }
  if (options.keep_shapes || options.nonlinear) {
    const Eigen::MatrixXd shapes = product(space.T, modal.V);
    if (options.keep_shapes) {
      body.node_positions = structure.nodes;
      body.node_shapes = structure.dofs.expand(shapes);
    }
    if (options.nonlinear)
      body.shape_integrals = std::make_shared<const ShapeIntegrals>(shape_integrals(structure, shapes, reference));
  }
  Certificate& c = body.certificate;
  c.basis = contents(parts, space, basis, parent);
  c.nodes = static_cast<int>(structure.nodes.size());
  c.dofs = structure.n();
  c.modes_found = space.modes.found;
  c.modes_counted = space.modes.counted;
  c.count_shift = space.modes.count_shift;
  c.max_residual = space.modes.max_residual;
  c.max_orthogonality = space.modes.max_orthogonality;
  c.valid_below = std::sqrt(std::max(space.modes.next_lambda, 0.0));
  c.left_out = sentences(structure, parts, space, modal, basis);
  if (rigid_force > fem::rigid_limit::unsaid)
    c.left_out.push_back(
        fmt::format("forces of K on rigid motions, {:.1e} of what cancels in them: taken as the "
                    "rounding of its numbers, so a tie to the ground that soft is not seen",
                    rigid_force));
  check(body);
  progress(1.0, "reduced");
  return body;
}

}  // namespace tenon::reduction
