#pragma once

#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

/// A node of a body as deformation leaves it, in the body's axes about its reference.
struct DeformedNode {
  Vec3 position = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
  Vec3 slide = Vec3::Zero();      ///< ψ η̇
  Vec3 turn = Vec3::Zero();       ///< T θ η̇, T the tangent of the rotation θ η
  Vec3 turn_rate = Vec3::Zero();  ///< Ṫ (θ η̇)
};

/// Writes the shapes of the node as they are felt now, [ψ; T θ], into Pi (6×n). With deformation dropped Pi is left as
/// it is (constant) and the node stays where it was. No allocation.
DeformedNode deformed_node(const HingedBody& body, int port, const double* eta, const double* eta_dot,
                           Eigen::Ref<Mat6X> Pi);

/// Shapes Π of a node to Π_F = φ*(node, F) Π, as felt at the reference F; `to_node` from there.
void to_reference(const Vec3& to_node, Eigen::Ref<Mat6X> Pi);

/// Motion of a port in the world: pose of its body-fixed frame, twist and the part of its acceleration that is there
/// without χ̇ and gravity, at the port, world axes.
struct PortMotion {
  RigidMotion pose;  ///< columns of R: the body's axes, turned by the deformation at the port
  Vec6 V = Vec6::Zero(), bias = Vec6::Zero();
};

/// After set_state(). Body −1 is the inertial frame (`place` there). `Pi` is scratch, 6×n of the body.
PortMotion port_motion(const Multibody& system, const Sweeps& sweeps, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& v, const PortRef& port, const Vec3& place, Mat6X& Pi);

/// column += 𝓗Φ [Πᵀ; φ] w: generalised forces of a wrench at a port (world axes, about the port); its transpose gives
/// the port's twist from χ. Walks from the body to the root. Returns the sum of squares of what each product could have
/// been by the sizes of its factors: a column far below its root is round-off.
double add_generalised_force(const Multibody& system, const Sweeps& sweeps, const PortMotion& motion,
                             const PortRef& port, const Mat6X& Pi, const Vec6& wrench,
                             Eigen::Ref<Eigen::VectorXd> column);

}  // namespace tenon::assembly
