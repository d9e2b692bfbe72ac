#include "assembly/integration/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assembly/recursion/port_motion.hpp"
#include "fem/error.hpp"
#include "fem/rotation.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// A port of the network as the system of bodies has it.
PortRef in_system(const Simulation& simulation, const PortRef& port) {
  return {simulation.bodies.body[at(port.body)], port.port};
}

Mat6X scratch(const Multibody& system, const PortRef& port) {
  return system.bodies[at(port.body)].body->ports[at(port.port)].Phi;
}

void set_initial(const Network& network, const InitialMotion& initial, Simulation& simulation) {
  const Multibody& system = simulation.bodies.system;
  if (initial.joint) {
    const auto found = std::find_if(network.joints.begin(), network.joints.end(),
                                    [&](const Joint& j) { return j.name == initial.name; });
    const int body = simulation.bodies.hinge[at(static_cast<int>(found - network.joints.begin()))];
    if (body < 0)
      throw InputError(initial.place, fmt::format("joint '{}' closes a loop: its motion follows", initial.name),
                       "Give the motion of another joint of the loop");
    const int modes = system.bodies[at(body)].modes();
    if (initial.angle) simulation.start.q[system.q_offset[at(body)] + modes] = *initial.angle - found->angle;
    simulation.start.v[system.v_offset[at(body)] + modes] = initial.rate;
    return;
  }
  for (std::size_t k = 0; k < network.bodies.size(); ++k) {
    if (network.bodies[k].name != initial.name) continue;
    const auto b = at(simulation.bodies.body[k]);
    const HingedBody& body = system.bodies[b];
    if (body.kind != HingeKind::free)
      throw InputError(initial.place, fmt::format("body '{}' does not float: its motion follows", initial.name),
                       "Give the motion of its joint");
    const Index first = system.v_offset[b] + body.modes();
    simulation.start.v.segment<3>(first) = initial.velocity;
    simulation.start.v.segment<3>(first + 3) = initial.turning;  // both hinge frames stand along the world's axes
  }
}

// Bodies whose modes do not feel that the body has moved its mass.
std::vector<std::string> missing_integrals(const Multibody& system) {
  std::vector<std::string> notes;
  for (const HingedBody& b : system.bodies)
    if (b.modes() > 0 && b.deformation == Deformation::full && !b.body->shape_integrals)
      notes.push_back(fmt::format(
          "Body '{}' carries no shape integrals: its deformation moves its ports, but does not shift its mass.",
          b.name));
  return notes;
}

// of the mass and the ports alone
std::shared_ptr<const ReducedBody> without_modes(ReducedBody body) {
  body.omega.resize(0);
  body.zeta.resize(0);
  body.C.resize(0, 0);
  body.L.resize(0, 6);
  for (reduction::BodyPort& port : body.ports) port.Phi.resize(6, 0);
  body.node_positions.clear();
  body.node_shapes.resize(0, 0);
  body.shape_integrals.reset();
  body.stiffening.reset();
  return std::make_shared<const ReducedBody>(std::move(body));
}

}  // namespace

Loads make_loads(const Network& network, const Simulation& simulation, const SceneSimulation& scene) {
  struct Drive {
    Signal signal;
    PortRef port{-1, -1};
    int direction = 0, speed = -1;
  };
  std::vector<Drive> drives;
  const Multibody& system = simulation.bodies.system;
  for (const SignalOn& force : scene.forces) {
    const auto input = std::find_if(network.inputs.begin(), network.inputs.end(),
                                    [&](const Input& i) { return i.name == force.input; });
    Drive drive{force.signal, {-1, -1}, input->direction, -1};
    if (input->joint) {
      const int body = simulation.bodies.hinge[at(*input->joint)];
      if (body < 0)
        throw InputError(force.place, fmt::format("input '{}' drives a joint that closes a loop", force.input),
                         "Every joint of that loop is driven: leave one of them without a drive");
      drive.speed = system.v_offset[at(body)] + system.bodies[at(body)].modes();
    } else {
      drive.port = in_system(simulation, *input->at);
    }
    drives.push_back(std::move(drive));
  }
  if (drives.empty()) return {};
  return [drives, &system](double t, const MotionState& state, Sweeps& sweeps, VectorXd& T) {
    for (const Drive& drive : drives) {
      const double size = value(drive.signal, t);
      if (drive.speed >= 0) {
        T[drive.speed] += size;
        continue;
      }
      Vec3 world = Vec3::Zero();
      world[drive.direction % 3] = size;
      Vec6 wrench = Vec6::Zero();
      wrench.segment<3>(drive.direction < 3 ? 0 : 3) = sweeps.bodies[at(drive.port.body)].world.R.transpose() * world;
      apply_wrench(system, state.q, drive.port.body, drive.port.port, wrench, sweeps);
    }
  };
}

Plan plan_motion(const Scene& scene, const SceneSimulation& section) {
  Plan plan = assembly::plan(scene);
  for (BodyPlan& body : plan.bodies) {
    const Flexibility level = section.of(body.body);
    body.options.nonlinear = level == Flexibility::full || level == Flexibility::automatic;
  }
  return plan;
}

Simulation make_simulation(const Network& network, const SceneSimulation& scene) {
  Simulation simulation{make_multibody(network), {}, 0.0, {}};
  Multibody& system = simulation.bodies.system;
  system.gravity = scene.gravity;
  for (HingedBody& body : system.bodies) {
    if (scene.of(body.name) == Flexibility::dropped) body.deformation = Deformation::dropped;
    if (scene.of(body.name) == Flexibility::rigid) body.body = without_modes(*body.body);
  }
  index(system);
  simulation.notes = missing_integrals(system);
  simulation.start = rest_state(system);
  for (const InitialMotion& initial : scene.initial) set_initial(network, initial, simulation);
  if (!system.closures.empty()) {
    Sweeps sweeps = make_sweeps(system);
    ClosureRows rows = make_closure_rows(system);
    const VectorXd asked = simulation.start.v;
    simulation.moved = project(system, sweeps, rows, simulation.start);
    // speeds as of rigid bodies: in the metric of M + K s², which holds modes and springs still
    simulation.start.v = asked;
    set_state(system, simulation.start.q, asked, sweeps);
    closure_rows(system, sweeps, simulation.start.q, asked, rows);
    articulate(system, sweeps, {0.0, 1.0});
    ClosureInertia inertia = closure_inertia(system, sweeps, rows);
    rows.gamma.setZero();
    VectorXd lambda(rows.rows());
    close(rows, inertia, simulation.start.v, lambda);
  }
  return simulation;
}

Recorder::Recorder(const Network& network, const Simulation& simulation)
    : network_(network), simulation_(simulation), column_(simulation.bodies.system.nv), T_(column_.size()) {
  const Multibody& system = simulation.bodies.system;
  const MotionState rest = rest_state(system);
  Sweeps sweeps = make_sweeps(system);
  set_state(system, rest.q, rest.v, sweeps);
  constexpr const char* ports[2][3] = {{"m", "m/s", "m/s2"}, {"rad", "rad/s", "rad/s2"}};
  for (const Output& o : network.outputs) {
    channels_.push_back({o.name, ports[o.joint || o.direction >= 3 ? 1 : 0][static_cast<int>(o.quantity)]});
    rest_.emplace_back();
    if (!o.at) continue;
    const PortRef port = in_system(simulation, *o.at);
    Mat6X Pi = scratch(system, port);
    rest_.back() = port_motion(system, sweeps, rest.q, rest.v, port, Vec3::Zero(), Pi).pose;
  }
  for (const char* kind : {"kinetic", "elastic", "gravity", "total"})
    channels_.push_back({fmt::format("energy.{}", kind), "J"});
  if (sweeps.stiffening)
    channels_.back().note = channels_[channels_.size() - 3].note = "leaves out the work of geometric stiffening";
  for (const char* axis : {"x", "y", "z"}) channels_.push_back({fmt::format("momentum.{}", axis), "kg m/s"});
  for (const char* axis : {"x", "y", "z"}) channels_.push_back({fmt::format("angular_momentum.{}", axis), "kg m2/s"});
  for (const Joint& joint : network.joints)
    for (const char* part : {"fx", "fy", "fz", "tx", "ty", "tz"})
      channels_.push_back({fmt::format("reaction.{}.{}", joint.name, part), part[0] == 'f' ? "N" : "N m"});
  if (!system.closures.empty()) {
    rows_ = make_closure_rows(system);
    closing_ = Mat6X::Zero(6, static_cast<Index>(system.closures.size()));
    channels_.push_back({"closure_gap", "m"});
  }
  turned_.resize(network.outputs.size());
  row_.reserve(channels_.size());
}

// The branch of an angle that is nearest to where the rates of the last sample and of this one lead.
double Recorder::unwrap(std::size_t output, double angle, double rate, double t) {
  constexpr double turn = 2.0 * std::numbers::pi;
  Turned& last = turned_[output];
  if (last.known) {
    const double expected = last.angle + 0.5 * (last.rate + rate) * (t - last.t);
    angle += turn * std::round((expected - angle) / turn);
  }
  last = {true, angle, rate, t};
  return angle;
}

double Recorder::output(const Output& output, const Sample& sample) {
  const Multibody& system = simulation_.bodies.system;
  const Sweeps& sweeps = sample.dynamics.sweeps;
  const auto which = static_cast<int>(output.quantity);
  const auto k = static_cast<std::size_t>(&output - network_.outputs.data());
  if (output.joint) {
    const Joint& joint = network_.joints[at(*output.joint)];
    if (const int body = simulation_.bodies.hinge[at(*output.joint)]; body >= 0) {
      const int modes = system.bodies[at(body)].modes();
      const Index v = system.v_offset[at(body)] + modes;
      if (which == 0) return joint.angle + sample.state.q[system.q_offset[at(body)] + modes];
      return which == 1 ? sample.state.v[v] : sample.v_dot[v];
    }
    const Closure& closure = system.closures[at(simulation_.bodies.closure[at(*output.joint)])];
    Mat6X Pi_a = scratch(system, closure.inner), Pi_b = scratch(system, closure.outer);
    const PortMotion a = port_motion(system, sweeps, sample.state.q, sample.state.v, closure.inner, Vec3::Zero(), Pi_a);
    const PortMotion b = port_motion(system, sweeps, sample.state.q, sample.state.v, closure.outer, Vec3::Zero(), Pi_b);
    const Mat3 inner = a.pose.R * closure.inner_axes, R = inner.transpose() * (b.pose.R * closure.outer_axes);
    const Vec3 z = inner.col(2), relative = (b.V - a.V).tail<3>();
    if (which == 0) return unwrap(k, joint.angle + std::atan2(R(1, 0), R(0, 0)), z.dot(relative), sample.t);
    if (which == 1) return z.dot(relative);
    Vec6 turn = Vec6::Zero();
    turn.tail<3>() = z;
    column_.setZero();
    add_generalised_force(system, sweeps, b, closure.outer, Pi_b, turn, column_);
    turn = -turn;
    add_generalised_force(system, sweeps, a, closure.inner, Pi_a, turn, column_);
    return column_.dot(sample.v_dot) + z.dot((b.bias - a.bias).tail<3>()) + a.V.tail<3>().cross(z).dot(relative);
  }
  const PortRef port = in_system(simulation_, *output.at);
  Mat6X Pi = scratch(system, port);
  const PortMotion motion = port_motion(system, sweeps, sample.state.q, sample.state.v, port, Vec3::Zero(), Pi);
  if (which == 1) return motion.V[output.direction];
  if (which == 2) {  // a = J χ̇ + what is there without
    Vec6 unit = Vec6::Zero();
    unit[output.direction] = 1.0;
    column_.setZero();
    add_generalised_force(system, sweeps, motion, port, Pi, unit, column_);
    return column_.dot(sample.v_dot) + motion.bias[output.direction];
  }
  if (output.direction < 3) return motion.pose.r[output.direction] - rest_[k].r[output.direction];
  return fem::rotation_vector(motion.pose.R * rest_[k].R.transpose())[output.direction - 3];
}

const std::vector<double>& Recorder::record(const Sample& sample) {
  const Multibody& system = simulation_.bodies.system;
  Sweeps& sweeps = sample.dynamics.sweeps;
  row_.clear();
  for (const Output& o : network_.outputs) row_.push_back(output(o, sample));
  const Energy e = energy(system, sweeps, sample.state.q, sample.state.v);
  row_.insert(row_.end(), {e.kinetic, e.elastic, e.gravity, e.total()});
  const Vec6 p = momentum(system, sweeps, sample.state.v);
  row_.insert(row_.end(), p.begin(), p.end());
  if (!system.closures.empty()) closure_rows(system, sweeps, sample.state.q, sample.state.v, rows_);
  reactions(sample);
  if (!system.closures.empty()) row_.push_back(rows_.gap.cwiseAbs().maxCoeff());
  return row_;
}

void Recorder::reactions(const Sample& sample) {
  const Multibody& system = simulation_.bodies.system;
  Sweeps& sweeps = sample.dynamics.sweeps;
  const auto port_at = [&](const PortRef& port, const Vec3& place) {
    Mat6X Pi = port.body < 0 ? Mat6X() : scratch(system, port);
    return port_motion(system, sweeps, sample.state.q, sample.state.v, port, place, Pi).pose;
  };
  const auto load = [&](const PortRef& port, const Vec6& world) {
    if (port.body < 0) return;
    const Mat3& R = sweeps.bodies[at(port.body)].world.R;
    Vec6 wrench;
    wrench << R.transpose() * world.head<3>(), R.transpose() * world.tail<3>();
    apply_wrench(system, sample.state.q, port.body, port.port, wrench, sweeps);
  };
  Index row = 0;
  for (std::size_t c = 0; c < system.closures.size(); ++c) {  // loads like any others on the tree
    const Closure& closure = system.closures[c];
    const Index count = 6 - hinge_dofs(closure.kind);
    auto wrench = closing_.col(static_cast<Index>(c));
    wrench = rows_.on_outer.middleCols(row, count) * sample.dynamics.lambda.segment(row, count);
    row += count;
    load(closure.outer, wrench);
    const Vec3 r = port_at(closure.outer, Vec3::Zero()).r - port_at(closure.inner, closure.inner_position).r;
    load(closure.inner, -fem::shift_wrench(Vec6(wrench), r));
  }
  inverse_dynamics(system, sweeps, sample.v_dot, T_);  // leaves in z_r what each hinge passes on, about F_k
  for (std::size_t j = 0; j < network_.joints.size(); ++j) {
    const int body = simulation_.bodies.hinge[j];
    Vec6 f;
    if (body >= 0) {
      const BodySweep& s = sweeps.bodies[at(body)];
      const HingedBody& b = system.bodies[at(body)];
      const Vec3 place = port_at({body, b.outer_port}, Vec3::Zero()).r;
      f.head<3>() = s.world.R * s.z_r.head<3>();
      f.tail<3>() = s.world.R * s.z_r.tail<3>() - (place - s.world.r).cross(Vec3(f.head<3>()));
      if (b.reversed) f = -f;  // on the child of the scene's joint
    } else {
      f = closing_.col(simulation_.bodies.closure[j]);
    }
    row_.insert(row_.end(), f.begin(), f.end());
  }
}

}  // namespace tenon::assembly
