#include "reduction/reduced_body.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"
#include "fem/mesh.hpp"

namespace tenon::reduction {

int port_index(const ReducedBody& body, const std::string& port) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < body.ports.size(); ++k) {
    if (body.ports[k].name == port) return static_cast<int>(k);
    names.push_back(body.ports[k].name);
  }
  const std::string near = fem::near_miss(port, names);
  throw ModelError(fmt::format("body '{}' has no port '{}'", body.name, port),
                   near.empty() ? fmt::format("Its ports are: {}", fmt::join(names, ", "))
                                : fmt::format("Did you mean '{}'?", near));
}

ReducedBody rigid_body(std::string name, double mass, const Vec3& centre, const Mat3& inertia,
                       std::vector<BodyPort> ports) {
  ReducedBody body;
  body.name = std::move(name);
  body.ports = std::move(ports);
  body.reference = body.ports.empty() ? Vec3::Zero() : body.ports.front().position;
  for (BodyPort& port : body.ports) port.Phi = Mat6X::Zero(6, 0);
  body.L.resize(0, 6);
  body.D = fem::rigid_mass(mass, centre - body.reference, inertia);
  body.certificate.basis = "rigid";
  return body;
}

Eigen::MatrixXd damping(const ReducedBody& body) {
  if (body.C.size() > 0) return body.C;
  return Eigen::VectorXd(2.0 * body.zeta.cwiseProduct(body.omega)).asDiagonal();
}

void set_damping(ReducedBody& body, const Eigen::MatrixXd& C) {
  body.C = 0.5 * (C + C.transpose());
  for (Eigen::Index j = 0; j < body.omega.size(); ++j)
    body.zeta[j] = body.omega[j] > 0.0 ? 0.5 * body.C(j, j) / body.omega[j] : 0.0;
}

EffectiveMass effective_mass(const ReducedBody& body) {
  EffectiveMass table;
  table.per_mode = body.L.cwiseAbs2();
  table.total = table.per_mode.colwise().sum().transpose();
  table.remainder = body.D.diagonal() - table.total;
  return table;
}

}  // namespace tenon::reduction
