#pragma once

#include <array>
#include <cmath>
#include <numbers>

/// Jacobi's elliptic functions by descending Landen transformations (Abramowitz, Stegun 16.4); k is the modulus.
namespace tenon::assembly::testing {

struct Jacobi {
  double sn, cn, dn;
};

inline Jacobi jacobi(double u, double k) {
  std::array<double, 32> a{}, c{};
  a[0] = 1.0;
  c[0] = k;
  double b = std::sqrt((1.0 - k) * (1.0 + k));
  int n = 0;
  for (; n < 30 && std::abs(c[static_cast<std::size_t>(n)]) > 1e-17; ++n) {
    const auto i = static_cast<std::size_t>(n);
    a[i + 1] = 0.5 * (a[i] + b);
    c[i + 1] = 0.5 * (a[i] - b);
    b = std::sqrt(a[i] * b);
  }
  double phi = std::ldexp(a[static_cast<std::size_t>(n)] * u, n);
  for (; n > 0; --n) {
    const auto i = static_cast<std::size_t>(n);
    phi = 0.5 * (phi + std::asin(c[i] / a[i] * std::sin(phi)));
  }
  return {std::sin(phi), std::cos(phi), std::sqrt(1.0 - k * k * std::sin(phi) * std::sin(phi))};
}

/// The complete integral of the first kind.
inline double quarter_period(double k) {
  double a = 1.0, b = std::sqrt((1.0 - k) * (1.0 + k));
  for (int n = 0; n < 30; ++n) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.5 * std::numbers::pi / a;
}

}  // namespace tenon::assembly::testing
