#include "assembly/recursion/multibody.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

bool has_port(const ReducedBody& body, int port) { return port >= 0 && port < static_cast<int>(body.ports.size()); }

bool frame(const Mat3& axes) {
  constexpr double round_off = 1e-9;  // of what files and products of rotations bring
  return axes.allFinite() && (axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff() < round_off &&
         axes.determinant() > 0.0;
}

constexpr const char* frame_cure = "Give right-handed, orthonormal axes";

void check(const Multibody& system, std::size_t k) {
  const HingedBody& b = system.bodies[k];
  const auto refuse = [&](const std::string& what, const std::string& cure) {
    throw ModelError(fmt::format("body '{}' {}", b.name, what), cure);
  };
  if (!b.body) refuse("has no data", "Give it a reduced body");
  if (b.parent >= static_cast<int>(k)) refuse("comes before its parent", "List parents before children");
  if (b.parent < -1)
    refuse(fmt::format("hangs on body {}", b.parent), "Name a body listed before it, or -1: the ground");
  if (b.parent >= 0 && !has_port(*system.bodies[static_cast<std::size_t>(b.parent)].body, b.inner_port))
    refuse("hangs on a port that its parent does not have", "Name one of the parent's ports");
  if (b.outer_port >= 0 && !has_port(*b.body, b.outer_port))
    refuse("hangs by a port that it does not have", "Name one of its own ports");
  if (!frame(b.inner_axes) || !frame(b.outer_axes)) refuse("has a hinge frame that is none", frame_cure);
  if (!b.inner_position.allFinite()) refuse("hangs at a place that is no number", "Give finite coordinates");
  for (const HingeVector* values : {&b.stiffness, &b.damping, &b.inertia})
    if (values->size() != b.dofs() || !values->allFinite() || (values->array() < 0.0).any())
      refuse(fmt::format("needs {} non-negative numbers for each of stiffness, damping and inertia of its {} hinge",
                         b.dofs(), name(b.kind)),
             "Give one a degree of freedom");
}

}  // namespace

void check_closures(const Multibody& system) {
  const auto exists = [&](const PortRef& port) {
    return port.body >= 0 && port.body < static_cast<int>(system.bodies.size()) &&
           has_port(*system.bodies[static_cast<std::size_t>(port.body)].body, port.port);
  };
  for (const Closure& c : system.closures) {
    const auto refuse = [&](const std::string& what, const std::string& cure) {
      throw ModelError(fmt::format("closure '{}' {}", c.name, what), cure);
    };
    if (c.inner.body != -1 && !exists(c.inner)) refuse("has an inner port that no body has", "Name body and port");
    if (!exists(c.outer)) refuse("has an outer port that no body has", "Name body and port");
    if (!frame(c.inner_axes) || !frame(c.outer_axes)) refuse("has a hinge frame that is none", frame_cure);
    if (!c.inner_position.allFinite()) refuse("stands at a place that is no number", "Give finite coordinates");
    if (hinge_dofs(c.kind) == 6) refuse("of a free hinge closes nothing", "Leave it out");
  }
}

void index(Multibody& system) {
  system.q_offset.clear();
  system.v_offset.clear();
  system.root.clear();
  system.nq = system.nv = 0;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    HingedBody& b = system.bodies[k];
    for (HingeVector* values : {&b.stiffness, &b.damping, &b.inertia})
      if (values->size() == 0) *values = HingeVector::Zero(b.dofs());
    check(system, k);
    system.q_offset.push_back(system.nq);
    system.v_offset.push_back(system.nv);
    system.root.push_back(b.parent < 0 ? static_cast<int>(k) : system.root[static_cast<std::size_t>(b.parent)]);
    system.nq += b.modes() + hinge_coordinates(b.kind);
    system.nv += b.modes() + b.dofs();
  }
  if (!system.gravity.allFinite()) throw ModelError("gravity is no number", "Give three finite numbers");
  check_closures(system);
}

Multibody serial_chain(const std::shared_ptr<const ReducedBody>& link, int links, Deformation deformation) {
  Multibody chain;
  for (int k = 0; k < links; ++k) {
    HingedBody b;
    b.name = fmt::format("link{}", k + 1);
    b.body = link;
    b.deformation = deformation;
    b.parent = k - 1;
    b.inner_port = k == 0 ? -1 : 1;
    b.outer_port = 0;
    b.kind = HingeKind::revolute;
    chain.bodies.push_back(std::move(b));
  }
  index(chain);
  return chain;
}

MotionState rest_state(const Multibody& system) {
  MotionState state{VectorXd::Zero(system.nq), VectorXd::Zero(system.nv)};
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    rest(system.bodies[k].kind, state.q.data() + system.q_offset[k] + system.bodies[k].modes());
  return state;
}

void move(const Multibody& system, const VectorXd& delta, VectorXd& q) {
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index n = b.modes();
    q.segment(system.q_offset[k], n) += delta.segment(system.v_offset[k], n);
    move(b.kind, delta.data() + system.v_offset[k] + n, q.data() + system.q_offset[k] + n);
  }
}

}  // namespace tenon::assembly
