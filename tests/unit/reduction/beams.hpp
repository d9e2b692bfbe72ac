#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/reduced_body.hpp"

/// Straight beams by the project's own elements, with ports where a test wants them.
namespace tenon::tests {

struct BeamData {
  double length = 2.0;
  int elements = 24;
  fem::Material material{.name = "steel", .E = 2e11, .G = 8e10, .nu = 0.25, .rho = 7800.0};
  fem::BeamSection section{.name = "box", .A = 4e-4, .Iy = 3e-8, .Iz = 7e-8, .J = 5e-8};  // κ = 0: Euler-Bernoulli
  fem::BeamMass mass = fem::BeamMass::consistent;

  double mass_total() const { return material.rho * section.A * length; }
  /// √(EI/(ρA)) / L²: a frequency is this times (βL)².
  double bending(double I) const { return std::sqrt(material.E * I / (material.rho * section.A)) / (length * length); }
};

/// Along x from the origin; ports name → node.
fem::Model beam(const BeamData& data, const std::vector<std::pair<std::string, int>>& ports);

/// M and K of eq (1): [D Lᵀ; L 1], diag(0, Ω²).
struct FreeBody {
  Eigen::MatrixXd M, K;
};
FreeBody free_body(const reduction::ReducedBody& body);

/// [τ Φ] of a port: its motion from (x_ref, η).
Eigen::MatrixXd port_rows(const reduction::ReducedBody& body, int port);

/// Frequencies ω [rad/s] of the body with the ports `held`, by the null space of their motion.
Eigen::VectorXd frequencies(const reduction::ReducedBody& body, const std::vector<int>& held);

/// Motion of port `to` per wrench at port `from`, free body, at ω: [τ Φ](K − ω²M)⁻¹[τ Φ]ᵀ.
Eigen::MatrixXd receptance(const reduction::ReducedBody& body, int to, int from, double omega);

}  // namespace tenon::tests
