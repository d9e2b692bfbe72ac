#include "titop/beam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fem/error.hpp"
#include "titop/bending_basis.hpp"
#include "titop/clamped_free.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::Vec3;
using reduction::ReducedBody;

namespace {

// Modes of one plane or direction, in the twelve directions of the body.
struct Part {
  VectorXd omega;   // [rad/s]
  MatrixXd L;       // n×6
  MatrixXd Phi;     // 6×n
  MatrixXd shapes;  // 6N×n
};

void require(bool sound, const std::string& name, const char* symbol, double value, const char* what) {
  if (!sound)
    throw ModelError(
        fmt::format("beam '{}': {} = {} is not {}", name, symbol, value, what),
        "Give the section and the material in SI units, or switch the direction off that does not need it");
}

void validate(const std::string& name, const BeamProperties& b, const BeamOptions& o) {
  const auto positive = [&](const char* symbol, double value, bool needed) {
    const bool sound = std::isfinite(value) && (needed ? value > 0.0 : value >= 0.0);
    require(sound, name, symbol, value, needed ? "a positive number" : "a number ≥ 0");
  };
  positive("length", b.length, true);
  positive("rho", b.rho, true);
  positive("A", b.A, true);
  positive("E", b.E, o.bend_xy || o.bend_xz || o.traction);
  positive("Iz", b.Iz, o.bend_xy);
  positive("Iy", b.Iy, o.bend_xz);
  positive("G", b.G, o.torsion);
  positive("J", b.J, o.torsion);
  positive("Ip", b.Ip, o.torsion);
  require(std::isfinite(o.zeta) && o.zeta >= 0.0, name, "zeta", o.zeta, "a damping ratio ≥ 0");
  require(o.samples == 0 || o.samples >= 2, name, "samples", o.samples, "0 or at least 2, for both ends");
  if (o.model == BeamModel::clamped_free && (o.bend_xy || o.bend_xz) && (o.modes < 1 || o.modes > most_beam_modes))
    throw ModelError(fmt::format("beam '{}': modes = {} is not between 1 and {}", name, o.modes, most_beam_modes),
                     "Cut the beam into a chain of shorter ones when it needs more");
}

// Directions of (v, α) in a twist: v = u_y, α = v′ = θ_z in the plane xy; v = u_z, α = v′ = −θ_y in the plane xz.
struct Plane {
  int v, alpha;
  double sign;
};
constexpr Plane plane_xy{1, 5, 1.0}, plane_xz{2, 4, -1.0};

Part bending(const BendingBasis& basis, const Plane& plane, double mass, double length, double EI) {
  const Index n = basis.omega.size(), N = basis.shapes.rows() / 2;
  const double root = std::sqrt(mass), turn = plane.sign / length;
  Part part{basis.omega * std::sqrt(EI / (mass * length)) / length, MatrixXd::Zero(n, 6), MatrixXd::Zero(6, n),
            MatrixXd::Zero(6 * N, n)};
  part.L.col(plane.v) = basis.L.col(0) * root;
  part.L.col(plane.alpha) = basis.L.col(1) * (root * length * plane.sign);
  part.Phi.row(plane.v) = basis.Phi.row(0) / root;
  part.Phi.row(plane.alpha) = basis.Phi.row(1) * (turn / root);
  for (Index k = 0; k < N; ++k) {
    part.shapes.row(6 * k + plane.v) = basis.shapes.row(2 * k) / root;
    part.shapes.row(6 * k + plane.alpha) = basis.shapes.row(2 * k + 1) * (turn / root);
  }
  return part;
}

// u(x) = u_P + (x/l) δ, section 3.2: M_x = m [1 1/2; 1/2 1/3], K_x = diag(0, k); δ = √(3/m) η. In torsion m is ρ I_p l.
Part linear(int direction, double m, double k, const VectorXd& xi) {
  const double root = std::sqrt(m), phi = std::sqrt(3.0) / root;
  Part part{VectorXd::Constant(1, std::sqrt(3.0 * k / m)), MatrixXd::Zero(1, 6), MatrixXd::Zero(6, 1),
            MatrixXd::Zero(6 * xi.size(), 1)};
  part.L(0, direction) = 0.5 * std::sqrt(3.0) * root;
  part.Phi(direction, 0) = phi;
  for (Index i = 0; i < xi.size(); ++i) part.shapes(6 * i + direction, 0) = phi * xi[i];
  return part;
}

// All parts side by side, frequencies ascending.
void gather(ReducedBody& body, const std::vector<Part>& parts) {
  std::vector<std::pair<const Part*, Index>> columns;
  for (const Part& part : parts)
    for (Index j = 0; j < part.omega.size(); ++j) columns.emplace_back(&part, j);
  std::stable_sort(columns.begin(), columns.end(),
                   [](const auto& a, const auto& b) { return a.first->omega[a.second] < b.first->omega[b.second]; });
  const auto n = static_cast<Index>(columns.size());
  body.omega.resize(n);
  body.L = MatrixXd::Zero(n, 6);
  body.ports[0].Phi = fem::Mat6X::Zero(6, n);
  body.ports[1].Phi = fem::Mat6X::Zero(6, n);
  body.node_shapes.resize(6 * static_cast<Index>(body.node_positions.size()), n);
  for (Index j = 0; j < n; ++j) {
    const auto& [part, k] = columns[static_cast<std::size_t>(j)];
    body.omega[j] = part->omega[k];
    body.L.row(j) = part->L.row(k);
    body.ports[1].Phi.col(j) = part->Phi.col(k);
    body.node_shapes.col(j) = part->shapes.col(k);
  }
}

// What the basis leaves out; valid_below is the first exact clamped-free frequency that the body does not have.
void certify(ReducedBody& body, const BeamProperties& b, const BeamOptions& o, double mass) {
  reduction::Certificate& c = body.certificate;
  const bool quintic = o.model == BeamModel::polynomial;
  c.source = "uniform Euler-Bernoulli beam";
  c.basis = quintic ? "quintic polynomials" : fmt::format("{} clamped-free modes per plane", o.modes);
  if (o.traction || o.torsion) c.basis += ", linear traction and torsion";
  c.modes_found = body.n();
  double first = std::numeric_limits<double>::infinity();
  const double beta = clamped_free_mode((quintic ? 2 : o.modes) + 1).beta;
  for (const double EI : {o.bend_xy ? b.E * b.Iz : 0.0, o.bend_xz ? b.E * b.Iy : 0.0})
    if (EI > 0.0) first = std::min(first, beta * beta * std::sqrt(EI / (mass * b.length)) / b.length);
  const double second_rod_mode = 1.5 * std::numbers::pi / b.length;  // of the clamped-free rod, over its wave speed
  if (o.traction) first = std::min(first, second_rod_mode * std::sqrt(b.E / b.rho));
  if (o.torsion) first = std::min(first, second_rod_mode * std::sqrt(b.G * b.J / (b.rho * b.Ip)));
  c.valid_below = std::isfinite(first) ? first : 0.0;
  c.left_out.push_back("shear deformation and rotary inertia of bending");
  const std::pair<bool, const char*> directions[] = {{o.bend_xy, "bending in the plane x-y"},
                                                     {o.bend_xz, "bending in the plane x-z"},
                                                     {o.traction, "traction"},
                                                     {o.torsion, "torsion"}};
  for (const auto& [kept, what] : directions)
    if (!kept) c.left_out.push_back(fmt::format("{}: rigid", what));
}

}  // namespace

ReducedBody beam_body(std::string name, const BeamProperties& b, const BeamOptions& o) {
  validate(name, b, o);
  const double mass = b.rho * b.A * b.length, l = b.length, polar = b.rho * b.Ip * l;
  const VectorXd xi = o.samples > 0 ? VectorXd::LinSpaced(o.samples, 0.0, 1.0) : VectorXd();

  ReducedBody body;
  body.name = std::move(name);
  body.ports = {{"P", Vec3::Zero(), fem::Mat3::Identity(), {}}, {"C", {l, 0.0, 0.0}, fem::Mat3::Identity(), {}}};
  for (const double x : xi) body.node_positions.push_back({x * l, 0.0, 0.0});
  const double slender = mass * l * l / 12.0;
  body.D = fem::rigid_mass(mass, {0.5 * l, 0.0, 0.0}, Vec3(polar, slender, slender).asDiagonal());

  std::vector<Part> parts;
  if (o.bend_xy || o.bend_xz) {
    const BendingBasis basis = o.model == BeamModel::polynomial ? quintic_basis(xi) : clamped_free_basis(o.modes, xi);
    if (o.bend_xy) parts.push_back(bending(basis, plane_xy, mass, l, b.E * b.Iz));
    if (o.bend_xz) parts.push_back(bending(basis, plane_xz, mass, l, b.E * b.Iy));
  }
  if (o.traction) parts.push_back(linear(0, mass, b.E * b.A / l, xi));
  if (o.torsion) parts.push_back(linear(3, polar, b.G * b.J / l, xi));
  gather(body, parts);
  body.zeta = VectorXd::Constant(body.n(), o.zeta);
  certify(body, b, o, mass);
  reduction::check(body);
  return body;
}

}  // namespace tenon::titop
