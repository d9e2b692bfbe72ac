#include "tests/consistency/assembly/random_network.hpp"

#include <Eigen/QR>

namespace tenon::assembly::testing {

Network undamped(Network net) {
  for (ReducedBody& body : net.bodies) {
    body.zeta.setZero();
    body.C.resize(0, 0);
  }
  for (Joint& joint : net.joints) joint.damping = 0.0;
  return net;
}

Mat3 RandomNetwork::rotation() {
  const Eigen::Quaterniond q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  return q.normalized().toRotationMatrix();
}

Eigen::MatrixXd RandomNetwork::matrix(Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(-1.0, 1.0); });
}

Mat3 RandomNetwork::inertia(double size) {
  Mat3 J = Mat3::Zero();
  for (int k = 0; k < 4; ++k) {
    const Mat3 s = fem::skew(vector(1.0));
    J -= size * s * s;
  }
  return J;
}

ReducedBody RandomNetwork::body(const std::string& name, bool free_free, int most_modes) {
  ReducedBody b;
  const int n = chance(0.2) ? 0 : integer(1, most_modes), ports = integer(2, 4);
  const double mass = log_uniform(0.5, 50.0);
  const Vec3 centre = vector(1.0);
  const Mat3 J = inertia(0.2 * mass);
  b.name = name;
  b.omega = Eigen::VectorXd::NullaryExpr(n, [&] { return log_uniform(1.0, 100.0); });
  std::sort(b.omega.data(), b.omega.data() + n);
  b.zeta = Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(0.002, 0.05); });
  if (n > 0 && chance(0.3)) {  // modes coupled by a full damping matrix of rank 1 to n
    const Eigen::MatrixXd E = matrix(integer(1, n), n);
    reduction::set_damping(b, 0.05 * E.transpose() * E);
  }
  for (int p = 0; p < ports; ++p) {
    reduction::BodyPort port;
    port.name = "p" + std::to_string(p);
    port.position = vector(1.5);
    port.axes = rotation();
    port.Phi = matrix(6, n) / std::sqrt(mass);
    b.ports.push_back(port);
  }
  if (free_free) {
    b.kind = ReducedBody::Kind::free_free;
    b.parent = -1;
    b.reference = centre;
    b.L = Eigen::MatrixXd::Zero(n, 6);
  } else {
    b.parent = integer(0, ports - 1);
    b.reference = b.ports[static_cast<std::size_t>(b.parent)].position;
    b.ports[static_cast<std::size_t>(b.parent)].Phi.setZero();
  }
  b.D = fem::rigid_mass(mass, centre - b.reference, J);
  if (!free_free) {
    const Eigen::MatrixXd A = matrix(n, 6);
    const double norm = std::max(1.0, A.norm());  // ≥ spectral norm
    b.L = std::sqrt(0.8) / norm * A * Eigen::MatrixXd(b.D.llt().matrixU());
  }
  return b;
}

PortRef RandomNetwork::port(const Network& network, int body) {
  return {body, integer(0, static_cast<int>(network.bodies[static_cast<std::size_t>(body)].ports.size()) - 1)};
}

Joint RandomNetwork::joint(const std::string& name, PortRef inner, PortRef outer) {
  Joint j;
  j.name = name;
  const bool outward = chance(0.8);
  j.parent = outward ? inner : outer;
  j.child = outward ? outer : inner;
  j.angle = uniform(-3.0, 3.0);
  j.axis = vector(1.0).normalized();
  if (chance(0.6)) {
    j.kind = JointKind::revolute;
    if (chance(0.5)) j.stiffness = log_uniform(1.0, 1e3);
    if (chance(0.5)) j.damping = log_uniform(0.1, 1.0);
    if (chance(0.5)) j.inertia = log_uniform(0.01, 1.0);
  }
  return j;
}

Network RandomNetwork::tree(bool any_port) {
  Network net;
  const int count = integer(2, 8);
  for (int k = 0; k < count; ++k) net.bodies.push_back(body("b" + std::to_string(k), any_port && chance(0.25)));
  for (int k = 1; k < count; ++k) {
    const PortRef outer = any_port ? port(net, k) : PortRef{k, net.bodies[static_cast<std::size_t>(k)].parent};
    net.joints.push_back(joint("j" + std::to_string(k), port(net, integer(0, k - 1)), outer));
  }
  for (int k = integer(0, 3); k > 0; --k)
    net.masses.push_back(
        {"m" + std::to_string(k), port(net, integer(0, count - 1)), log_uniform(0.1, 10.0), inertia(0.1)});
  if (chance(0.4)) {
    const int grounded = any_port ? integer(0, count - 1) : 0;
    net.ground.push_back(any_port ? port(net, grounded) : PortRef{0, net.bodies[0].parent});
  }
  channels(net);
  return net;
}

Network RandomNetwork::scene() {
  Network net = tree(true);
  const int closures = chance(0.3) ? 0 : integer(1, 2), last = static_cast<int>(net.bodies.size()) - 1;
  for (int k = 0; k < closures; ++k) {
    const int a = integer(0, last), b = (a + integer(1, last)) % (last + 1);
    ReducedBody& outer = net.bodies[static_cast<std::size_t>(b)];
    const double mass = outer.D(0, 0);
    const PortRef from = port(net, a);
    Joint j = joint("loop" + std::to_string(k), from, {b, static_cast<int>(outer.ports.size())});
    const bool outward = j.parent.body == a;  // child axes = parent axes · Rot(axis, angle)
    const Placement p = place(net);
    const auto ia = static_cast<std::size_t>(a), ib = static_cast<std::size_t>(b);
    const reduction::BodyPort& inner = net.bodies[ia].ports[static_cast<std::size_t>(from.port)];
    const Mat3 turn = Eigen::AngleAxisd(outward ? j.angle : -j.angle, j.axis).toRotationMatrix();
    outer.ports.push_back({"loop" + std::to_string(k),
                           p.R[ib].transpose() * (p.origin[ia] + p.R[ia] * inner.position - p.origin[ib]),
                           p.R[ib].transpose() * p.R[ia] * inner.axes * turn, matrix(6, outer.n()) / std::sqrt(mass)});
    net.joints.push_back(j);
    if (j.kind != JointKind::revolute) continue;
    net.inputs.push_back({j.name, {}, 0, static_cast<int>(net.joints.size()) - 1});
    net.outputs.push_back({j.name, Quantity::acceleration, {}, 0, static_cast<int>(net.joints.size()) - 1});
  }
  if (chance(0.2)) net.ground.push_back(port(net, integer(0, last)));
  return net;
}

void RandomNetwork::channels(Network& net) {
  for (int k = 0; k < 3; ++k) {
    const PortRef in = port(net, integer(0, static_cast<int>(net.bodies.size()) - 1));
    const PortRef out = port(net, integer(0, static_cast<int>(net.bodies.size()) - 1));
    net.inputs.push_back({"in" + std::to_string(k), in, integer(0, 5), {}});
    net.outputs.push_back({"out" + std::to_string(k), Quantity::acceleration, out, integer(0, 5), {}});
  }
  for (std::size_t j = 0; j < net.joints.size(); ++j) {
    if (net.joints[j].kind != JointKind::revolute) continue;
    net.inputs.push_back({"drive" + std::to_string(j), {}, 0, static_cast<int>(j)});
    net.outputs.push_back({"turn" + std::to_string(j), Quantity::acceleration, {}, 0, static_cast<int>(j)});
  }
}

}  // namespace tenon::assembly::testing
