#pragma once

#include "assembly/recursion/sweeps.hpp"

/// Floating-point operations of forward dynamics as the spatial-operator paper counts them (section 8): serial chains
/// of ruthlessly linearised bodies with n_m free-free modes each on one-axis rotary hinges.
namespace tenon::assembly {

struct Flops {
  double multiplications = 0.0, additions = 0.0;
  double total() const { return multiplications + additions; }
};

/// N bodies of n_m modes; 𝓝 = N (n_m + 1). O(𝓝³).
Flops composite_flops(int bodies, int modes);

/// The same by articulated bodies, O(N n_m²): D_f⁻¹ explicitly up to seven modes, by eq (77) from eight on.
Flops articulated_flops(int bodies, int modes);

/// Seconds that one forward dynamics of the system takes by each algorithm at rest, the best of several on this
/// machine.
struct MeasuredCost {
  double composite = 0.0, articulated = 0.0;
  bool articulated_is_cheaper() const { return articulated <= composite; }
};
MeasuredCost measure_cost(const Multibody& system);
/// "articulated bodies, 4.1 times faster than composite bodies": what is cheaper for the system, and by how much.
std::string cheaper(const MeasuredCost& cost);

/// As many bodies and modes as in the paper's counts, but less work than is counted: equal beams with `modes`
/// cantilever bending modes each, deformation dropped, on revolute hinges, fixed at one end. Hung by the clamped port
/// they have no Π_F (the paper's free-free modes do), and their hinges turn about axes that stay.
Multibody beam_chain(int bodies, int modes);

/// χ̇ by the composite-body mass matrix and its Cholesky factors, eqs (46), (50): what articulated bodies spare.
void composite_forward_dynamics(const Multibody& system, Sweeps& sweeps, const Eigen::VectorXd& T,
                                Eigen::MatrixXd& mass, Eigen::VectorXd& v_dot);

}  // namespace tenon::assembly
