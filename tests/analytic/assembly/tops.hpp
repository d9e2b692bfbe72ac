#pragma once

#include "assembly/recursion/multibody.hpp"
#include "tests/analytic/assembly/elliptic.hpp"

/// Rigid bodies whose motion is known in closed form.
namespace tenon::assembly::testing {

inline HingedBody rigid_on(HingeKind kind, const std::string& name, double mass, const Vec3& centre,
                           const Mat3& inertia) {
  HingedBody b;
  b.name = name;
  b.body = std::make_shared<const ReducedBody>(
      reduction::rigid_body(name, mass, centre, inertia, {{"pivot", Vec3::Zero(), Mat3::Identity(), {}}}));
  b.kind = kind;
  b.outer_port = 0;
  return b;
}

/// Falls along z from a height: z = height − g t²/2.
struct FallingWeight {
  double height = 2.0, g = 9.81;

  Multibody system() const {
    Multibody mb;
    mb.gravity = {0.0, 0.0, -g};
    mb.bodies.push_back(rigid_on(HingeKind::prismatic, "weight", 2.0, Vec3::Zero(), Mat3::Identity()));
    index(mb);
    return mb;
  }
  MotionState start(const Multibody& mb) const {
    MotionState s = rest_state(mb);
    s.q[0] = height;
    return s;
  }
  double passes(double z) const { return std::sqrt(2.0 * (height - z) / g); }
};

/// Turns freely about its mass centre (Euler). Start: ω = (ω₁, 0, ω₃) with L² > 2E I₂, I₁ < I₂ < I₃.
struct FreeTop {
  Vec3 I{1.0, 2.0, 3.0};
  double w1 = 2.0, w3 = 1.2;  // of a body that tumbles: Dzhanibekov

  Multibody system() const {
    Multibody mb;
    mb.bodies.push_back(rigid_on(HingeKind::free, "top", 5.0, Vec3::Zero(), I.asDiagonal()));
    index(mb);
    return mb;
  }
  MotionState start(const Multibody& mb) const {
    MotionState s = rest_state(mb);
    s.v.tail<3>() = rates(0.0);
    return s;
  }
  /// Landau, Lifshitz, Mechanics, section 37.
  Vec3 rates(double t) const {
    const double twoE = I[0] * w1 * w1 + I[2] * w3 * w3, L2 = I[0] * I[0] * w1 * w1 + I[2] * I[2] * w3 * w3;
    const double k = std::sqrt((I[1] - I[0]) * (twoE * I[2] - L2) / ((I[2] - I[1]) * (L2 - twoE * I[0])));
    const Jacobi j = jacobi(t * std::sqrt((I[2] - I[1]) * (L2 - twoE * I[0]) / (I[0] * I[1] * I[2])), k);
    return {w1 * j.cn, std::sqrt((twoE * I[2] - L2) / (I[1] * (I[2] - I[1]))) * j.sn, w3 * j.dn};
  }
};

/// Lagrange's top: a symmetric body on a fixed point under gravity, let go at the inclination θ₀ without nutation rate.
struct LagrangeTop {
  double mass = 0.5, l = 0.2, I1 = 0.025, I3 = 0.004, g = 9.81;  // inertia about the fixed point
  double theta0 = 0.6, spin = 60.0, precession = 1.5;

  Multibody system() const {
    Multibody mb;
    mb.gravity = {0.0, 0.0, -g};
    const double I = I1 - mass * l * l;
    mb.bodies.push_back(
        rigid_on(HingeKind::spherical, "top", mass, {0.0, 0.0, l}, Vec3(I, I, I3).asDiagonal().toDenseMatrix()));
    index(mb);
    return mb;
  }
  MotionState start(const Multibody& mb) const {
    MotionState s = rest_state(mb);
    s.q << std::sin(0.5 * theta0), 0.0, 0.0, std::cos(0.5 * theta0);  // about x
    s.v << 0.0, precession * std::sin(theta0), spin;                  // ω in body axes, ω₃ = spin
    return s;
  }
  /// cos θ = u₁ + (u₂ − u₁) sn²(½ √(β (u₃ − u₁)) t + phase): u̇² = (1 − u²)(α − βu) − (b − au)².
  double cosine(double t) const {
    const double u0 = std::cos(theta0), s2 = 1.0 - u0 * u0;
    const double a = I3 * spin / I1, b = precession * s2 + a * u0, beta = 2.0 * mass * g * l / I1;
    const double alpha = precession * precession * s2 + beta * u0;
    // the cubic β u³ − (α + a²) u² + (2ab − β) u + α − b² has the root u₀: the other two from the quadratic
    const double p = (alpha + a * a) / beta - u0;           // sum of the others
    const double r = (2.0 * a * b - beta) / beta - u0 * p;  // their product
    const double root = std::sqrt(0.25 * p * p - r);
    const double other = 0.5 * p - root, u3 = 0.5 * p + root;
    const double u1 = std::min(u0, other), u2 = std::max(u0, other), k = std::sqrt((u2 - u1) / (u3 - u1));
    const double phase = u0 < other ? 0.0 : quarter_period(k);
    const double sn = jacobi(0.5 * std::sqrt(beta * (u3 - u1)) * t + phase, k).sn;
    return u1 + (u2 - u1) * sn * sn;
  }
  /// cos θ of a state: the body's z axis along the vertical.
  static double cosine(const MotionState& s) { return Eigen::Quaterniond(s.q.data()).toRotationMatrix()(2, 2); }
};

}  // namespace tenon::assembly::testing
