#include "assembly/port_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "assembly/kinematics.hpp"
#include "assembly/spanning_tree.hpp"
#include "fem/error.hpp"
#include "titop/port_model.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using titop::Channel;
using titop::StateSpace;
using titop::Wiring;

namespace {

// A body with all that hangs on it, in world axes: inputs [ẍ_P; external], outputs [W; external], where W is the wrench
// it passes inboard. The external channels are numbers of the network's inputs and outputs.
struct Part {
  StateSpace ss;
  std::vector<int> inputs, outputs;
  std::vector<PortState> states;
};

// A wiring of zeros with room for named channels.
Wiring wiring(Index u, Index y, std::vector<Channel> inputs, std::vector<Channel> outputs) {
  const auto v = static_cast<Index>(inputs.size()), z = static_cast<Index>(outputs.size());
  return {MatrixXd::Zero(u, y), MatrixXd::Zero(u, v), MatrixXd::Zero(z, y),
          MatrixXd::Zero(z, v), std::move(inputs),    std::move(outputs)};
}

struct PortTreeBuilder {
  const Network& network;
  Placement placement;
  std::vector<Branch> branches;
  double worst_condition = 1.0;

  const ReducedBody& body(const Branch& b) const { return network.bodies[static_cast<std::size_t>(b.body)]; }
  StateSpace note(titop::Connection c) { return worst_condition = std::max(worst_condition, c.condition), c.ss; }
  StateSpace note(titop::Inversion i) { return worst_condition = std::max(worst_condition, i.condition), i.ss; }
  std::vector<ReducedBody> reference = {};  // each body in the form that hangs by its branch's outer port
  Part assemble(const Branch& branch, const std::vector<Part>& hanging, const std::vector<int>& inner_ports);
  Part through_joint(const Branch& branch, const Part& part);
};

// The body in the form that hangs by the branch's outer port; a free root keeps its own parent port.
ReducedBody hung(const ReducedBody& body, const Branch& branch) {
  const bool cantilever = body.kind == ReducedBody::Kind::cantilever;
  if (cantilever && (branch.outer_port < 0 || branch.outer_port == body.parent)) return body;
  if (body.ports.empty())
    throw ModelError(fmt::format("free-free body '{}' has no port to hang by", body.name),
                     "Give it a port, or use the second-order route");
  return reduction::rebase(body, std::max(branch.outer_port, 0));
}

// Port channels to world axes by the augmented direction cosine matrix P^a = diag(R, R), states to ω_j η_j, η̇_j.
StateSpace in_world_axes(const titop::PortModel& model, const ReducedBody& body, const Mat3& R) {
  const Index blocks = model.ss.D.rows() / 6, n = body.n();
  MatrixXd P = MatrixXd::Zero(6 * blocks, 6 * blocks);
  for (Index k = 0; k < blocks; ++k) P.block<6, 6>(6 * k, 6 * k) = fem::rotation6(R);
  StateSpace ss = titop::gains(P, model.ss, P.transpose(), model.ss.outputs, model.ss.inputs);
  for (Index j = 0; j < n; ++j)
    if (const double omega = body.omega[j]; omega > 0.0) {
      ss.A.row(j) *= omega, ss.B.row(j) *= omega;
      ss.A.col(j) /= omega, ss.C.col(j) /= omega;
    }
  return ss;
}

template <typename Item>
std::vector<int> at_body(const std::vector<Item>& items, int body) {
  std::vector<int> found;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].at && items[i].at->body == body) found.push_back(static_cast<int>(i));
  return found;
}

template <typename Item>
std::vector<int> at_joint(const std::vector<Item>& items, int joint) {
  std::vector<int> found;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].joint == joint) found.push_back(static_cast<int>(i));
  return found;
}

// Connects a body with the parts that hang on it: ẍ of each hanging part is that of the port, the wrench it passes and
// the force −M ẍ of a lumped mass act on the port. What is at P itself adds to the wrench that passes inboard.
Part PortTreeBuilder::assemble(const Branch& branch, const std::vector<Part>& hanging,
                               const std::vector<int>& inner_ports) {
  const ReducedBody cantilever = hung(body(branch), branch);
  const std::vector<int> own_inputs = at_body(network.inputs, branch.body);
  const std::vector<int> own_outputs = at_body(network.outputs, branch.body);
  const auto input = [&](int i) -> const Input& { return network.inputs[static_cast<std::size_t>(i)]; };
  const auto output = [&](int i) -> const Output& { return network.outputs[static_cast<std::size_t>(i)]; };

  std::map<int, Index> block;  // first channel of each child port in use
  const auto use = [&](int port) {
    if (port != cantilever.parent) block.emplace(port, 0);
  };
  for (const int port : inner_ports) use(port);
  for (const LumpedMass& lump : network.masses)
    if (lump.at.body == branch.body) use(lump.at.port);
  for (const int i : own_inputs) use(input(i).at->port);
  for (const int i : own_outputs) use(output(i).at->port);
  std::vector<int> children;
  for (auto& [port, first] : block) {
    first = 6 * static_cast<Index>(children.size());
    children.push_back(port);
  }
  const titop::PortModel model = titop::port_model(cantilever, children);
  reference[static_cast<std::size_t>(branch.body)] = cantilever;
  const Index P = 6 * static_cast<Index>(children.size());

  std::vector<StateSpace> systems{in_world_axes(model, cantilever, placement.R[static_cast<std::size_t>(branch.body)])};
  Part result;
  for (const bool rate : {false, true})
    for (int j = 0; j < cantilever.n(); ++j)
      result.states.push_back(
          {branch.body, -1, j, rate, rate || cantilever.omega[j] == 0.0 ? 1.0 : cantilever.omega[j]});
  std::vector<Channel> in(systems[0].inputs.begin() + P, systems[0].inputs.end());
  std::vector<Channel> out(systems[0].outputs.begin() + P, systems[0].outputs.end());
  const auto add_input = [&](int i) { result.inputs.push_back(i), in.push_back(channel(input(i))); };
  const auto add_output = [&](int i) { result.outputs.push_back(i), out.push_back(channel(output(i))); };
  std::for_each(own_inputs.begin(), own_inputs.end(), add_input);
  std::for_each(own_outputs.begin(), own_outputs.end(), add_output);
  for (const Part& part : hanging) {
    systems.push_back(part.ss);
    result.states.insert(result.states.end(), part.states.begin(), part.states.end());
    std::for_each(part.inputs.begin(), part.inputs.end(), add_input);
    std::for_each(part.outputs.begin(), part.outputs.end(), add_output);
  }
  const StateSpace all = titop::append(systems);
  Wiring w = wiring(all.D.cols(), all.D.rows(), in, out);
  w.E.block<6, 6>(P, 0).setIdentity();
  w.H.block<6, 6>(0, P).setIdentity();
  for (const LumpedMass& lump : network.masses) {
    if (lump.at.body != branch.body) continue;
    const fem::Mat6 M = lumped_mass(lump, placement.R[static_cast<std::size_t>(branch.body)]);
    if (lump.at.port == cantilever.parent)
      w.J.block<6, 6>(0, 0) -= M;
    else
      w.F.block<6, 6>(block.at(lump.at.port), block.at(lump.at.port)) -= M;
  }
  Index v = 6, z = 6;
  for (const int i : own_inputs) {
    const Index direction = input(i).direction;
    const int port = input(i).at->port;
    (port == cantilever.parent ? w.J(direction, v) : w.E(block.at(port) + direction, v)) = 1.0;
    ++v;
  }
  for (const int i : own_outputs) {
    const Index direction = output(i).direction;
    const int port = output(i).at->port;
    (port == cantilever.parent ? w.J(z, direction) : w.H(z, block.at(port) + direction)) = 1.0;
    ++z;
  }
  Index u = P + 6, y = P + 6;  // first channels of the hanging part in `all`
  for (std::size_t k = 0; k < hanging.size(); ++k) {
    if (inner_ports[k] == cantilever.parent) {
      w.E.block<6, 6>(u, 0).setIdentity();
      w.H.block<6, 6>(0, y).setIdentity();
    } else {
      w.F.block<6, 6>(u, block.at(inner_ports[k])).setIdentity();
      w.F.block<6, 6>(block.at(inner_ports[k]), y).setIdentity();
    }
    const auto inputs = static_cast<Index>(hanging[k].inputs.size());
    const auto outputs = static_cast<Index>(hanging[k].outputs.size());
    w.E.block(u + 6, v, inputs, inputs).setIdentity();
    w.H.block(z, y + 6, outputs, outputs).setIdentity();
    u += 6 + inputs, v += inputs, y += 6 + outputs, z += outputs;
  }
  result.ss = note(titop::connect(all, w));
  return result;
}

}  // namespace

StateSpace drive_states(const Joint& joint) {
  StateSpace ss;
  const Index n = joint.stiffness > 0.0 ? 2 : (joint.damping > 0.0 ? 1 : 0);
  ss.A = MatrixXd::Zero(n, n);
  if (n == 2) ss.A(0, 1) = 1.0;
  ss.B = MatrixXd::Zero(n, n > 0);
  if (n > 0) ss.B(n - 1, 0) = 1.0;
  ss.C = MatrixXd::Identity(n, n);
  ss.D = MatrixXd::Zero(n, n > 0);
  if (n > 0) ss.inputs = {{joint.name + ".acceleration", "rad/s²"}};
  if (n > 1) ss.outputs.push_back({joint.name + ".angle", "rad"});
  if (n > 0) ss.outputs.push_back({joint.name + ".rate", "rad/s"});
  return ss;
}

namespace {

// A revolute joint seen from its parent. The rotation about the axis (channel 5 of the joint axes) is inverted: the
// torque passed inboard is −u + k δθ + f δθ̇ + j δθ̈ with δθ̈ = α_child − α_parent, section 2.2 of the TITOP paper.
Part PortTreeBuilder::through_joint(const Branch& branch, const Part& part) {
  if (branch.joint < 0) return part;
  const Joint& joint = network.joints[static_cast<std::size_t>(branch.joint)];
  if (joint.kind == JointKind::weld) return part;

  const Vec3 axis = (branch.outward ? 1.0 : -1.0) * joint_axis(network, placement, joint), e1 = axis.unitOrthogonal();
  const Index nu = part.ss.D.cols(), ny = part.ss.D.rows();
  MatrixXd in_axes = MatrixXd::Identity(nu, nu), out_axes = MatrixXd::Identity(ny, ny);  // joint axes → world axes
  in_axes.block<3, 3>(3, 3) << e1, axis.cross(e1), axis;
  out_axes.block<3, 3>(3, 3) = in_axes.block<3, 3>(3, 3);
  constexpr Index turn = 5;
  StateSpace ss = titop::gains(out_axes.transpose(), part.ss, in_axes, part.ss.outputs, part.ss.inputs);
  ss.inputs[turn].name = fmt::format("{} about the axis of joint '{}'", body(branch).name, joint.name);
  // an inertia that is round-off beside those about the other axes is none: the inversion then refuses it by name
  if (std::abs(ss.D(turn, turn)) <= 1e-13 * ss.D.block<3, 3>(3, 3).cwiseAbs().maxCoeff()) ss.D(turn, turn) = 0.0;
  const StateSpace drive = drive_states(joint);
  const StateSpace all = titop::append({note(titop::invert_channels(ss, {turn})), drive});

  Part result = part;
  std::vector<Channel> in = part.ss.inputs, out = part.ss.outputs;
  for (const int i : at_joint(network.inputs, branch.joint)) {
    result.inputs.push_back(i);
    in.push_back(channel(network.inputs[static_cast<std::size_t>(i)]));
  }
  for (const int i : at_joint(network.outputs, branch.joint)) {
    result.outputs.push_back(i);
    out.push_back(channel(network.outputs[static_cast<std::size_t>(i)]));
  }
  Wiring w = wiring(all.D.cols(), all.D.rows(), in, out);
  w.E.topLeftCorner(nu, nu).setIdentity();
  w.H.topLeftCorner(ny, ny).setIdentity();
  w.E.row(turn).setZero();
  w.E.row(turn).tail(w.E.cols() - nu).setConstant(-1.0);  // −u
  w.F(turn, turn) = joint.inertia;                        // j (α_child − α_parent)
  w.E(turn, turn) = -joint.inertia;
  const Index states = drive.A.rows();
  for (Index k = 0; k < states; ++k) result.states.push_back({-1, branch.joint, 0, k + 1 == states, 1.0});
  if (states > 0) {
    w.F(turn, ny + states - 1) = joint.damping;       // f δθ̇
    if (states > 1) w.F(turn, ny) = joint.stiffness;  // k δθ
    w.F(nu, turn) = 1.0;                              // δθ̈
    w.E(nu, turn) = -1.0;
  }
  w.H.row(turn) = w.F.row(turn);  // the torque passed inboard is the input of the inverted channel
  w.J.row(turn) = w.E.row(turn);
  for (Index z = ny; z < w.H.rows(); ++z) {
    w.H(z, turn) = 1.0;
    w.J(z, turn) = -1.0;
  }
  ss = note(titop::connect(all, w));
  MatrixXd back_in = MatrixXd::Identity(ss.D.cols(), ss.D.cols()),
           back_out = MatrixXd::Identity(ss.D.rows(), ss.D.rows());
  back_in.block<3, 3>(3, 3) = in_axes.block<3, 3>(3, 3).transpose();
  back_out.block<3, 3>(3, 3) = out_axes.block<3, 3>(3, 3);
  result.ss = titop::gains(back_out, ss, back_in, ss.outputs, ss.inputs);
  return result;
}

}  // namespace

PortTree port_tree(const Network& network) {
  PortTreeBuilder b{network, place(network), {}};
  b.reference.resize(network.bodies.size());
  b.branches = spanning_tree(network, b.placement, "port algebra");
  std::vector<std::vector<Part>> hanging(b.branches.size());
  std::vector<std::vector<int>> inner_ports(b.branches.size());
  std::vector<StateSpace> roots;
  std::vector<PortState> states;
  std::vector<int> input_at(network.inputs.size()), output_at(network.outputs.size());
  int first_input = 0, first_output = 0;
  for (std::size_t k = b.branches.size(); k-- > 0;) {  // tips to root
    const Branch& branch = b.branches[k];
    Part part = b.through_joint(branch, b.assemble(branch, hanging[k], inner_ports[k]));
    if (branch.parent >= 0) {
      hanging[static_cast<std::size_t>(branch.parent)].push_back(std::move(part));
      inner_ports[static_cast<std::size_t>(branch.parent)].push_back(branch.inner_port);
      continue;
    }
    std::vector<int> outer_in(part.inputs.size()), outer_out(part.outputs.size());
    std::iota(outer_in.begin(), outer_in.end(), 6);
    std::iota(outer_out.begin(), outer_out.end(), 6);
    // free root: W_P = 0 is the input after inversion; fixed root: ẍ_P = 0
    if (branch.outer_port < 0) part.ss = b.note(titop::invert_channels(part.ss, {0, 1, 2, 3, 4, 5}));
    roots.push_back(titop::subsystem(part.ss, outer_out, outer_in));
    states.insert(states.end(), part.states.begin(), part.states.end());
    for (const int i : part.inputs) input_at[static_cast<std::size_t>(i)] = first_input++;
    for (const int i : part.outputs) output_at[static_cast<std::size_t>(i)] = first_output++;
  }
  return {.ss = titop::subsystem(titop::append(roots), output_at, input_at),
          .states = std::move(states),
          .branches = std::move(b.branches),
          .bodies = std::move(b.reference),
          .placement = std::move(b.placement),
          .worst_condition = b.worst_condition};
}

}  // namespace tenon::assembly
