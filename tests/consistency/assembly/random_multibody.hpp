#pragma once

#include "assembly/recursion/multibody.hpp"
#include "tests/consistency/assembly/random_network.hpp"
#include "tests/unit/reduction/lumped_body.hpp"

/// Random trees on hinges of every kind, reproducible from a seed.
namespace tenon::assembly::testing {

struct RandomMultibody {
  RandomNetwork random;
  explicit RandomMultibody(unsigned seed) : random(seed) {}

  Eigen::VectorXd vector(Eigen::Index n, double size) { return size * random.matrix(n, 1); }

  /// A body of lumped nodes with the integrals of its shapes: what full deformation needs. Hung by "root", a node of
  /// its own or its reference.
  ReducedBody lumped(const std::string& name);

  /// A copy without springs, dampers and gravity that floats: every root is free.
  static Multibody afloat(Multibody mb) {
    mb.gravity.setZero();
    for (HingedBody& b : mb.bodies) {
      if (b.parent < 0) {
        b.kind = HingeKind::free;
        b.reversed = false;
        b.stiffness = b.damping = b.inertia = Eigen::VectorXd::Zero(6);
      }
    }
    index(mb);
    return mb;
  }

  /// 1 to `most` bodies; a chain or a tree, fixed or free base, hinges of 0 to 6 degrees of freedom on any port.
  Multibody system(int most, Deformation deformation, bool lumped_nodes = false);

  /// Large motion of the hinges, small of the modes.
  MotionState state(const Multibody& mb, double deflection = 0.05);
};

}  // namespace tenon::assembly::testing
