#include "titop/beam_roots.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace tenon::titop {

namespace {

using std::numbers::pi;

// Root near x of f by Newton's method; f and its derivative in a form without overflow.
template <class F>
double newton(double x, const F& f) {
  for (int step = 0; step < 40; ++step) {
    const auto [value, slope] = f(x);
    const double next = x - value / slope;
    if (std::abs(next - x) <= 1e-16 * x) return next;
    x = next;
  }
  return x;
}

// cos β = ±1/cosh β, about (n − 1/2)π
double cosine_root(double start, double sign) {
  return newton(start, [sign](double x) {
    const double sech = 1.0 / std::cosh(x);
    return std::pair{std::cos(x) - sign * sech, -std::sin(x) + sign * sech * std::tanh(x)};
  });
}

// sin β = ±tanh β cos β, about (n ± 1/4)π
double tangent_root(double start, double sign) {
  return newton(start, [sign](double x) {
    const double t = std::tanh(x);
    return std::pair{std::sin(x) - sign * t * std::cos(x),
                     std::cos(x) + sign * t * std::sin(x) - sign * (1.0 - t * t) * std::cos(x)};
  });
}

}  // namespace

std::vector<double> beam_roots(End left, End right, int count) {
  const auto is = [&](End a, End b) { return (left == a && right == b) || (left == b && right == a); };
  std::vector<double> roots;
  for (int n = 1; n <= count; ++n) {
    if (is(End::pinned, End::pinned) || is(End::sliding, End::sliding)) {
      roots.push_back(n * pi);
    } else if (is(End::pinned, End::sliding)) {
      roots.push_back((n - 0.5) * pi);
    } else if (is(End::clamped, End::free)) {
      roots.push_back(cosine_root(n == 1 ? 1.875 : (n - 0.5) * pi, -1.0));
    } else if (is(End::clamped, End::clamped) || is(End::free, End::free)) {
      roots.push_back(cosine_root((n + 0.5) * pi, 1.0));
    } else if (is(End::clamped, End::pinned) || is(End::free, End::pinned)) {
      roots.push_back(tangent_root((n + 0.25) * pi, 1.0));
    } else {  // clamped or free against sliding
      roots.push_back(tangent_root((n - 0.25) * pi, -1.0));
    }
  }
  return roots;
}

}  // namespace tenon::titop
