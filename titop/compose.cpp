#include "titop/compose.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::titop {

namespace {

void require_fit(const std::vector<Channel>& a, const std::vector<Channel>& b, const char* how) {
  if (a.size() != b.size())
    throw ModelError(fmt::format("{} channels are to be {} {}", a.size(), how, b.size()),
                     "Take a subsystem with as many channels first");
  for (std::size_t k = 0; k < a.size(); ++k)
    if (!a[k].unit.empty() && !b[k].unit.empty() && a[k].unit != b[k].unit)
      throw ModelError(
          fmt::format("'{}' in {} is to be {} '{}' in {}", a[k].name, a[k].unit, how, b[k].name, b[k].unit),
          "Order the channels alike, or put gains between them");
}

}  // namespace

// ẋ₂ = A₂x₂ + B₂(C₁x₁ + D₁u), y = C₂x₂ + D₂(C₁x₁ + D₁u)
StateSpace series(const StateSpace& first, const StateSpace& second) {
  check(first);
  check(second);
  require_fit(first.outputs, second.inputs, "connected to");
  StateSpace all = append({first, second});
  const auto n1 = first.A.rows(), n2 = second.A.rows(), n = n1 + n2;
  all.A.bottomLeftCorner(n2, n1) = second.B * first.C;
  StateSpace chain{std::move(all.A),
                   Eigen::MatrixXd(n, first.D.cols()),
                   Eigen::MatrixXd(second.D.rows(), n),
                   second.D * first.D,
                   first.inputs,
                   second.outputs};
  chain.B << first.B, second.B * first.D;
  chain.C << second.D * first.C, second.C;
  return chain;
}

StateSpace parallel(const StateSpace& first, const StateSpace& second) {
  check(first);
  check(second);
  require_fit(first.inputs, second.inputs, "driven together with");
  require_fit(first.outputs, second.outputs, "added to");
  StateSpace all = append({first, second});
  const auto n = all.A.rows();
  StateSpace sum{std::move(all.A),
                 Eigen::MatrixXd(n, first.D.cols()),
                 Eigen::MatrixXd(first.D.rows(), n),
                 first.D + second.D,
                 first.inputs,
                 first.outputs};
  sum.B << first.B, second.B;
  sum.C << first.C, second.C;
  return sum;
}

}  // namespace tenon::titop
