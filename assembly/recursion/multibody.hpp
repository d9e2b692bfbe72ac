#pragma once

#include <memory>
#include <string>
#include <vector>

#include "assembly/network.hpp"
#include "assembly/recursion/hinge.hpp"

/// Bodies on hinges with finite motion: the system of the spatial-operator paper (Jain, Rodriguez), trees and loops.
///
/// Linear first, as everywhere: the paper's 6-vectors have the angular half on top; swapping the halves turns its
/// φ(x, y) into shift_wrench, φ*(x, y) into shift_twist (fem/rigid_motion.hpp). Numbering: parent index < child index
/// (the paper counts tip to base).
namespace tenon::assembly {

/// What deformation does to the inertia and to the places of a body's ports. A body with modes but without shape
/// integrals (analytic beams, files written without them) cannot shift its mass: with `full` its ports move, but M_m
/// stays that of the undeformed body and spin puts no centrifugal load on its modes.
enum class Deformation {
  full,     ///< moves ports, shifts mass
  dropped,  ///< neither: "ruthlessly linearised", eqs (75)–(78)
};

/// A body and the hinge it hangs by. What passive_forces() reads of a hinge with one degree of freedom stands in two
/// cache lines.
struct alignas(64) HingedBody {
  std::shared_ptr<const ReducedBody> body;
  HingeKind kind = HingeKind::weld;
  bool reversed = false;                    ///< the hinge's own inboard side is on this body
  HingeVector stiffness, damping, inertia;  ///< n_r each, on β: springs from rest, dampers, rotors
  std::string name;
  Deformation deformation = Deformation::full;
  int parent = -1;                     ///< −1: the inertial frame
  int inner_port = -1;                 ///< node t of the parent, index into its ports
  int outer_port = -1;                 ///< node d of this body; −1: its reference
  Mat3 inner_axes = Mat3::Identity();  ///< hinge frame in the parent's axes (world axes for roots), undeformed
  Vec3 inner_position = Vec3::Zero();  ///< of the hinge frame in the world [m]; roots only
  Mat3 outer_axes = Mat3::Identity();  ///< hinge frame in this body's axes, undeformed

  int modes() const { return body->n(); }
  int dofs() const { return hinge_dofs(kind); }
};

/// Two ports that a hinge joins though the tree already does: closes a loop. The hinge's own degrees of freedom stay
/// free of force.
struct Closure {
  std::string name;
  PortRef inner, outer;  ///< bodies by their index in the tree; body −1: the inertial frame, where axes are world axes
  Vec3 inner_position = Vec3::Zero();  ///< with body −1 [m]
  HingeKind kind = HingeKind::weld;
  Mat3 inner_axes = Mat3::Identity(), outer_axes = Mat3::Identity();  ///< hinge frames in the bodies' axes
};

struct Multibody {
  std::vector<HingedBody> bodies;  ///< parents before children
  std::vector<Closure> closures;
  Vec3 gravity = Vec3::Zero();  ///< world axes [m/s²]

  // filled by index()
  std::vector<int> q_offset, v_offset;  ///< of each body: η then θ; η̇ then β
  int nq = 0, nv = 0;                   ///< coordinates ϑ and speeds χ, eq (4)
  std::vector<int> root;                ///< of each body: where its tree begins
};

/// Numbers the coordinates after checking that parents come first, that ports exist, that sizes agree and that frames
/// are orthonormal, closures included. Throws ModelError naming the body or the closure.
void index(Multibody& system);

/// Of every closure: its ports exist, its frames are orthonormal, its hinge forbids something. Throws ModelError naming
/// it.
void check_closures(const Multibody& system);

/// Equal links in a row on revolute hinges about z, each by its port 0 on port 1 of the one before, the first on the
/// ground.
Multibody serial_chain(const std::shared_ptr<const ReducedBody>& link, int links, Deformation deformation);

/// ϑ and χ of the whole system.
struct MotionState {
  Eigen::VectorXd q;  ///< nq
  Eigen::VectorXd v;  ///< nv
};

/// Undeformed, all hinges at rest, no speed.
MotionState rest_state(const Multibody& system);

/// q ← q moved by δ (nv displacements), hinge by hinge: attitudes on their group.
void move(const Multibody& system, const Eigen::VectorXd& delta, Eigen::VectorXd& q);

/// A network as a system of bodies on hinges, and where its items went.
struct NetworkMultibody {
  Multibody system;
  std::vector<int> body;     ///< of each body of the network: its index
  std::vector<int> hinge;    ///< of each joint: the body that hangs by it, −1 when it closes a loop
  std::vector<int> closure;  ///< of each joint: its closure, −1 when it is a hinge of the tree
};

/// Placed as the network is placed: at rest every hinge stands at zero, its joint at its angle. Lumped masses become
/// bodies welded to their ports. Joints that close loops, and grounded ports but the first of a piece, become closures.
/// Joints that carry a drive go into the tree first, so that a drive in a closure, which is refused, means that every
/// joint of that loop carries one. Throws ModelError naming the joint, and what place() throws.
NetworkMultibody make_multibody(const Network& network);

}  // namespace tenon::assembly
