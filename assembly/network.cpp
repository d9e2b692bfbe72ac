#include "assembly/network.hpp"

namespace tenon::assembly {

const ReducedBody& body_of(const Network& network, const PortRef& ref) {
  return network.bodies[static_cast<std::size_t>(ref.body)];
}

const reduction::BodyPort& port_of(const Network& network, const PortRef& ref) {
  return body_of(network, ref).ports[static_cast<std::size_t>(ref.port)];
}

std::string name(const Network& network, const PortRef& ref) {
  return body_of(network, ref).name + "." + port_of(network, ref).name;
}

}  // namespace tenon::assembly
