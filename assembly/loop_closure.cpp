#include "assembly/loop_closure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "assembly/kinematics.hpp"
#include "assembly/loop_kinematics.hpp"
#include "assembly/rank.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::Mat6;
using fem::Mat6X;
using titop::StateSpace;

namespace {

constexpr double nothing = 1e-12;  // motion in natural sizes, or of its sides when relative: none but round-off

// Axes of a cut: columns; the third is that of a revolute joint.
Mat6 axes_of(const Network& network, const PortTree& tree, const Cut& cut) {
  Mat6 axes = Mat6::Identity();
  if (cut.joint < 0) return axes;
  const Joint& joint = network.joints[static_cast<std::size_t>(cut.joint)];
  if (joint.kind != JointKind::revolute) return axes;
  const Vec3 axis = joint_axis(network, tree.placement, joint), e1 = axis.unitOrthogonal();
  axes.bottomRightCorner<3, 3>() << e1, axis.cross(e1), axis;
  return axes;
}

bool revolute(const Network& network, const Cut& cut) {
  return cut.joint >= 0 && network.joints[static_cast<std::size_t>(cut.joint)].kind == JointKind::revolute;
}

std::string cut_name(const Network& network, const Cut& cut) {
  return cut.joint >= 0 ? fmt::format("joint '{}'", network.joints[static_cast<std::size_t>(cut.joint)].name)
                        : "ground of " + name(network, cut.ground);
}

// The open tree with inputs and outputs of the closed network, then six wrench channels of each cut (on its child side,
// reaction on the other) and six relative accelerations.
StateSpace with_cuts(const Network& network, const OpenLoops& open, const PortTree& tree) {
  const auto cuts = static_cast<Index>(open.cuts.size());
  const auto nu = static_cast<Index>(network.inputs.size()), ny = static_cast<Index>(network.outputs.size());
  MatrixXd Ru = MatrixXd::Zero(tree.ss.D.cols(), nu + 6 * cuts), Ly = MatrixXd::Zero(ny + 6 * cuts, tree.ss.D.rows());
  for (std::size_t k = 0; k < open.inputs.size(); ++k) Ru(static_cast<Index>(k), open.inputs[k]) = 1.0;
  for (std::size_t k = 0; k < open.outputs.size(); ++k) Ly(open.outputs[k], static_cast<Index>(k)) = 1.0;
  auto u = static_cast<Index>(open.inputs.size()), y = static_cast<Index>(open.outputs.size());
  std::vector<titop::Channel> in, out;
  for (const Input& input : network.inputs) in.push_back(channel(input));
  for (const Output& output : network.outputs) out.push_back(channel(output));
  for (Index k = 0; k < cuts; ++k) {
    const Cut& cut = open.cuts[static_cast<std::size_t>(k)];
    const Mat6 axes = axes_of(network, tree, cut);
    Ru.block<6, 6>(u, nu + 6 * k) = axes;
    Ly.block<6, 6>(ny + 6 * k, y) = axes.transpose();
    u += 6, y += 6;
    if (cut.joint >= 0) {
      Ru.block<6, 6>(u, nu + 6 * k) = -axes;
      Ly.block<6, 6>(ny + 6 * k, y) = -axes.transpose();
      u += 6, y += 6;
    }
    const bool turns = revolute(network, cut);
    for (int d = 0; d < 6; ++d) {
      const std::string what = turns && d == 5   ? "rotation about the axis"
                               : turns && d == 4 ? "second rotation across the axis"
                               : turns && d == 3 ? "rotation across the axis"
                                                 : direction_names[static_cast<std::size_t>(d)];
      in.push_back({fmt::format("{}, {}", cut_name(network, cut), what), d < 3 ? "N" : "N m"});
      out.push_back({in.back().name, d < 3 ? "m/s²" : "rad/s²"});
    }
    if (!turns) continue;  // what works on the angle of the cut itself
    for (std::size_t i = 0; i < network.inputs.size(); ++i)
      if (network.inputs[i].joint == cut.joint) Ru.col(static_cast<Index>(i)) += Ru.col(nu + 6 * k + 5);
    for (std::size_t i = 0; i < network.outputs.size(); ++i)
      if (network.outputs[i].joint == cut.joint) Ly.row(static_cast<Index>(i)) += Ly.row(ny + 6 * k + 5);
  }
  return titop::gains(Ly, tree.ss, Ru, std::move(out), std::move(in));
}

// The spring, damper and rotor of a revolute cut: torque −k δθ − f δθ̇ − j δθ̈ about its axis.
StateSpace with_drive(const StateSpace& ss, const Joint& joint, Index in, Index out) {
  const StateSpace drive = drive_states(joint);
  const Index states = drive.A.rows(), nu = ss.D.cols(), ny = ss.D.rows();
  if (states == 0 && joint.inertia == 0.0) return ss;
  const StateSpace all = titop::append({ss, drive});
  titop::Wiring w{MatrixXd::Zero(all.D.cols(), all.D.rows()),
                  MatrixXd::Identity(all.D.cols(), nu),
                  MatrixXd::Identity(ny, all.D.rows()),
                  MatrixXd::Zero(ny, nu),
                  ss.inputs,
                  ss.outputs};
  w.F(in, out) = -joint.inertia;
  if (states > 0) {
    w.F(in, ny + states - 1) = -joint.damping;
    if (states > 1) w.F(in, ny) = -joint.stiffness;
    w.F(nu, out) = 1.0;
  }
  return titop::connect(all, w).ss;
}

// Motions of the two sides of a cut over the coordinates, in its axes; the ground's is zero.
struct Sides {
  Mat6X child, parent;
};
Sides sides_of(const Network& network, const PortTree& tree, const LoopMotions& motions, const Cut& cut) {
  if (cut.joint < 0) {
    const Mat6X child = motions.port(cut.ground);
    return {child, Mat6X::Zero(6, child.cols())};
  }
  const Joint& joint = network.joints[static_cast<std::size_t>(cut.joint)];
  const Mat6 turn = axes_of(network, tree, cut).transpose();
  return {turn * motions.port(joint.child), turn * motions.port(joint.parent)};
}

// Orthonormal basis of the motions of the coordinates `kept` that the closure rows allow when all the other coordinates
// follow freely: null(N J_kept) with N J_free = 0.
MatrixXd allowed(const MatrixXd& J, const std::vector<int>& kept) {
  std::vector<int> free;
  const double largest = J.size() > 0 ? J.cwiseAbs().maxCoeff() : 0.0;
  for (int c = 0; c < J.cols(); ++c)
    if (std::find(kept.begin(), kept.end(), c) == kept.end() && J.col(c).norm() > nothing * largest) free.push_back(c);
  MatrixXd rows = J(Eigen::all, kept);
  if (rows.size() == 0) return MatrixXd::Identity(rows.cols(), rows.cols());
  VectorXd lengths = J.rowwise().norm();
  if (!free.empty()) {
    const MatrixXd F = J(Eigen::all, free).transpose();
    rows = row_space(F, F.rowwise().norm(), "the closure of the loops").null.transpose() * rows;
    lengths = VectorXd::Constant(rows.rows(), largest);
  }
  if (rows.rows() == 0) return MatrixXd::Identity(rows.cols(), rows.cols());
  return row_space(rows, lengths, "the closure of the loops").null;
}

// The channels of the cuts that are held, and the closure rows over the coordinates (rotations times the length).
struct Held {
  std::vector<int> channels;
  MatrixXd J;
};

// Decided on the kinematics, in natural sizes: a direct transmission of nothing but round-off looks like any other.
Held held_rows(const Network& network, const OpenLoops& open, const PortTree& tree, const StateSpace& ss,
               const LoopCoordinates& c) {
  const auto ny = network.outputs.size();
  const double length = natural_length(tree.placement);
  const LoopMotions motions(open.network, tree, c);
  Held held{{}, MatrixXd::Zero(6 * static_cast<Index>(open.cuts.size()), c.size)};
  Index rows = 0;
  std::vector<std::string> redundant;
  double apart = 0.0;
  for (std::size_t k = 0; k < open.cuts.size(); ++k) {
    Sides sides = sides_of(network, tree, motions, open.cuts[k]);
    for (Mat6X* side : {&sides.child, &sides.parent}) {
      *side *= c.scale.asDiagonal();
      side->bottomRows<3>() *= length;
    }
    const Mat6X relative = sides.child - sides.parent;
    for (int d = 0; d < 6; ++d) {
      const int channel = 6 * static_cast<int>(k) + d;
      const double moves = std::max(sides.child.row(d).norm(), sides.parent.row(d).norm());
      if (d == 5 && revolute(network, open.cuts[k])) {  // its angle: δθ = relative rotation
        held.J.row(rows) = relative.row(d);
        held.J(rows++, c.cut[k]) = -length * c.scale[c.cut[k]];
      } else if (relative.row(d).norm() > nothing * moves && moves > nothing) {
        held.channels.push_back(channel);
        held.J.row(rows++) = relative.row(d);
      } else if (moves > nothing) {
        redundant.push_back("'" + ss.outputs[ny + static_cast<std::size_t>(channel)].name + "'");
        apart = std::max(apart, relative.row(d).norm() / moves);
      }
    }
  }
  if (!redundant.empty())
    throw NumericalError(
        fmt::format("closure rows are redundant, the sides of the cut move there but never apart: {}; relative motion "
                    "against their own",
                    fmt::join(redundant, ", ")),
        apart, "Use the second-order route, which takes redundant rows, or let one side give way there");
  held.J.conservativeResize(rows, Eigen::NoChange);
  return held;
}

std::vector<int> from(int first, std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

// Inverts the held channels and leaves the network's own: the relative accelerations that are inputs then are zero.
titop::Inversion hold(const StateSpace& ss, const std::vector<int>& channels, std::size_t nu, std::size_t ny) {
  std::vector<int> in, out;  // the held ones first, in inputs and outputs alike
  for (const int channel : channels) {
    in.push_back(static_cast<int>(nu) + channel);
    out.push_back(static_cast<int>(ny) + channel);
  }
  for (const int k : from(0, nu)) in.push_back(k);
  for (const int k : from(0, ny)) out.push_back(k);
  const StateSpace ordered = titop::subsystem(ss, out, in);
  titop::Inversion inverse =
      channels.empty() ? titop::Inversion{ordered} : titop::invert_channels(ordered, from(0, channels.size()));
  const auto first = static_cast<int>(channels.size());
  inverse.ss = titop::subsystem(inverse.ss, from(first, ny), from(first, nu));
  return inverse;
}

// x = S Z z: S scales coordinates to states, Z spans what the loops allow of positions and of rates.
StateSpace confined(StateSpace ss, const std::vector<PortState>& states, const LoopCoordinates& c, const MatrixXd& J) {
  const auto coordinate = [&](const PortState& s) {
    if (s.body >= 0) return c.body[static_cast<std::size_t>(s.body)] + s.mode;
    const auto j = static_cast<std::size_t>(s.joint);
    return j < c.joint.size() ? c.joint[j] : c.cut[j - c.joint.size()];
  };
  std::vector<int> at[2], kept[2];  // positions, rates: states and their coordinates
  VectorXd S(ss.A.rows());
  for (std::size_t s = 0; s < states.size(); ++s) {
    at[states[s].rate].push_back(static_cast<int>(s));
    kept[states[s].rate].push_back(coordinate(states[s]));
    S[static_cast<Index>(s)] = states[s].scale * c.scale[kept[states[s].rate].back()];
  }
  const MatrixXd Z0 = allowed(J, kept[0]), Z1 = allowed(J, kept[1]);
  MatrixXd Z = MatrixXd::Zero(ss.A.rows(), Z0.cols() + Z1.cols());
  Z(at[0], Eigen::seqN(0, Z0.cols())) = Z0;
  Z(at[1], Eigen::seqN(Z0.cols(), Z1.cols())) = Z1;
  const MatrixXd out = Z.transpose() * S.cwiseInverse().asDiagonal(), in = S.asDiagonal() * Z;
  ss.A = (out * ss.A * in).eval();
  ss.B = (out * ss.B).eval();
  ss.C = (ss.C * in).eval();
  return ss;
}

}  // namespace

OpenLoops open_loops(const Network& network) {
  const Placement placement = place(network);
  OpenLoops open{network, {}, {}, {}};
  Network& tree = open.network;
  // the pieces: bodies joined, each named by its first
  std::vector<int> piece(network.bodies.size());
  std::iota(piece.begin(), piece.end(), 0);
  for (const int k : placement.order)
    if (const int j = placement.tree_joint[static_cast<std::size_t>(k)]; j >= 0) {
      const Joint& joint = network.joints[static_cast<std::size_t>(j)];
      const int inner = joint.parent.body == k ? joint.child.body : joint.parent.body;
      piece[static_cast<std::size_t>(k)] = piece[static_cast<std::size_t>(inner)];
    }
  tree.ground.clear();
  std::vector<const PortRef*> first(network.bodies.size(), nullptr);
  for (const PortRef& ref : network.ground) {
    const PortRef*& held = first[static_cast<std::size_t>(piece[static_cast<std::size_t>(ref.body)])];
    if (!held) {
      held = &ref;
      tree.ground.push_back(ref);
    } else if (held->body != ref.body || held->port != ref.port) {
      open.cuts.push_back({-1, ref});
    }
  }
  for (const int j : placement.closing_joints) open.cuts.push_back({j, {}});
  if (open.cuts.empty()) return open;

  std::vector<int> place_of(network.joints.size(), -1);  // of each joint in the open network
  tree.joints.clear();
  for (std::size_t j = 0; j < network.joints.size(); ++j) {
    if (std::find(placement.closing_joints.begin(), placement.closing_joints.end(), static_cast<int>(j)) !=
        placement.closing_joints.end())
      continue;
    place_of[j] = static_cast<int>(tree.joints.size());
    tree.joints.push_back(network.joints[j]);
  }
  const auto keep = [&](const auto& all, auto& kept, std::vector<int>& numbers) {
    kept.clear();
    for (std::size_t i = 0; i < all.size(); ++i) {
      auto item = all[i];
      if (item.joint && place_of[static_cast<std::size_t>(*item.joint)] < 0) continue;
      if (item.joint) item.joint = place_of[static_cast<std::size_t>(*item.joint)];
      numbers.push_back(static_cast<int>(i));
      kept.push_back(std::move(item));
    }
  };
  keep(network.inputs, tree.inputs, open.inputs);
  keep(network.outputs, tree.outputs, open.outputs);
  const auto probe = [&tree](const PortRef& at) {
    for (int d = 0; d < 6; ++d) {
      tree.inputs.push_back({.name = "cut", .at = at, .direction = d, .joint = {}});
      tree.outputs.push_back(
          {.name = "cut", .quantity = Quantity::acceleration, .at = at, .direction = d, .joint = {}});
    }
  };
  for (const Cut& cut : open.cuts) {
    if (cut.joint < 0) {
      probe(cut.ground);
      continue;
    }
    const Joint& joint = network.joints[static_cast<std::size_t>(cut.joint)];
    probe(joint.child);
    probe(joint.parent);
  }
  return open;
}

PortAlgebra close_loops(const Network& network, const OpenLoops& open, const PortTree& tree) {
  const auto nu = network.inputs.size(), ny = network.outputs.size();
  StateSpace ss = with_cuts(network, open, tree);
  const LoopCoordinates c = loop_coordinates(network, open, tree);
  const Held held = held_rows(network, open, tree, ss, c);
  std::vector<PortState> states = tree.states;
  for (std::size_t k = 0; k < open.cuts.size(); ++k) {
    if (!revolute(network, open.cuts[k])) continue;
    const Index before = ss.A.rows();
    const auto axis = static_cast<Index>(6 * k + 5);
    ss = with_drive(ss, network.joints[static_cast<std::size_t>(open.cuts[k].joint)], static_cast<Index>(nu) + axis,
                    static_cast<Index>(ny) + axis);
    for (Index s = before; s < ss.A.rows(); ++s)
      states.push_back({-1, static_cast<int>(open.network.joints.size() + k), 0, s + 1 == ss.A.rows(), 1.0});
  }
  titop::Inversion inverse = hold(ss, held.channels, nu, ny);
  return {confined(std::move(inverse.ss), states, c, held.J), std::max(tree.worst_condition, inverse.condition)};
}

}  // namespace tenon::assembly
