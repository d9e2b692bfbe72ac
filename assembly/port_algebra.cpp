#include "assembly/port_algebra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "assembly/loop_closure.hpp"
#include "assembly/port_tree.hpp"
#include "fem/error.hpp"
#include "titop/poles_zeros.hpp"

namespace tenon::assembly {

using Eigen::Index;

PortAlgebra port_algebra(const Network& network) {
  for (const Output& output : network.outputs)
    if (output.quantity != Quantity::acceleration)
      throw ModelError(
          fmt::format("output '{}' is a position or velocity, port algebra gives accelerations", output.name),
          "Use the second-order route, or ask for the acceleration");
  const OpenLoops open = open_loops(network);
  PortTree tree = port_tree(open.network);
  if (open.cuts.empty()) return {std::move(tree.ss), tree.worst_condition};
  return close_loops(network, open, tree);
}

Eigen::VectorXd frequencies(const PortAlgebra& system) {
  std::vector<double> omega;
  for (const std::complex<double>& pole : titop::poles(system.ss))
    if (pole.imag() > 0.0) omega.push_back(std::abs(pole));
  std::sort(omega.begin(), omega.end());
  return Eigen::Map<Eigen::VectorXd>(omega.data(), static_cast<Index>(omega.size()));
}

}  // namespace tenon::assembly
