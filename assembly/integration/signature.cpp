#include "assembly/integration/signature.hpp"

#include <fmt/format.h>

#include <cmath>

#include "reduction/geometric_stiffness.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::assembly {

namespace {

struct Sum {
  double sum = 0.0, size = 0.0;
  long count = 0;
  Sum& operator<<(double x) {
    constexpr double golden = 0.6180339887498949;  // weights 1 to 2, no two alike
    const double weight = 1.0 + std::fmod(static_cast<double>(++count) * golden, 1.0);
    sum += weight * x;
    size += weight * std::abs(x);
    return *this;
  }
  template <class Derived>
  Sum& operator<<(const Eigen::DenseBase<Derived>& x) {
    for (Eigen::Index j = 0; j < x.cols(); ++j)
      for (Eigen::Index i = 0; i < x.rows(); ++i) *this << x(i, j);
    return *this;
  }
};

}  // namespace

bool same(const Trait& a, const Trait& b) {
  return a.of == b.of && a.what == b.what && std::abs(a.sum - b.sum) <= 1e-7 * std::max(a.size, b.size);
}

Signature signature(const Multibody& system) {
  Signature s;
  const auto add = [&](const std::string& of, const char* what, const Sum& sum) {
    s.traits.push_back({of, what, sum.sum, sum.size});
  };
  for (const HingedBody& b : system.bodies) {
    const ReducedBody& body = *b.body;
    s.structure.push_back(fmt::format("{} {} {} {} {}", b.name, name(b.kind), b.modes(), b.parent,
                                      b.deformation == Deformation::full ? "full" : "dropped"));
    const std::string of = fmt::format("body '{}'", b.name);
    add(of, "mass matrix", Sum{} << body.D);
    add(of, "frequencies", Sum{} << body.omega);
    add(of, "damping", Sum{} << body.zeta << body.C);
    add(of, "participation", Sum{} << body.L);
    Sum ports, places;
    for (const reduction::BodyPort& port : body.ports) {
      places << Vec3(port.position - body.reference);
      ports << port.Phi;
    }
    add(of, "places of ports", places);
    add(of, "shapes at ports", ports);
    Sum integrals, stiffening;
    if (body.shape_integrals)
      integrals << body.shape_integrals->J1 << body.shape_integrals->J2 << body.shape_integrals->C1
                << body.shape_integrals->nodes.C0;
    if (body.stiffening) stiffening << body.stiffening->K;
    add(of, "shape integrals", integrals);
    add(of, "geometric stiffening", stiffening);
    add(of, "joint frame", Sum{} << b.inner_axes << b.outer_axes << b.inner_position);
    add(of, "joint spring, damper or rotor", Sum{} << b.stiffness << b.damping << b.inertia);
  }
  for (const Closure& c : system.closures) {
    s.structure.push_back(fmt::format("{} closure {} {} {}", c.name, name(c.kind), c.inner.body, c.outer.body));
    add(fmt::format("closure '{}'", c.name), "joint frame", Sum{} << c.inner_axes << c.outer_axes << c.inner_position);
  }
  add("the system", "gravity", Sum{} << system.gravity);
  return s;
}

}  // namespace tenon::assembly
