#include "titop/clamped_free.hpp"

#include <cmath>
#include <numbers>

namespace tenon::titop {

// With β = (i − ½)π + δ, cos β cosh β = −1 reads sin δ = s sech β. Newton on δ, whose digits are all its own.
ClampedFreeMode clamped_free_mode(int i) {
  const double s = i % 2 == 1 ? 1.0 : -1.0, centre = (i - 0.5) * std::numbers::pi;
  double delta = 0.0;
  for (int step = 0; step < 50; ++step) {
    const double beta = centre + delta, sech = 1.0 / std::cosh(beta);  // 0 once cosh overflows: δ is then below 1e-300
    const double residual = std::sin(delta) - s * sech;
    const double correction = residual / (std::cos(delta) + s * sech * std::tanh(beta));
    delta -= correction;
    if (std::abs(correction) <= 1e-17 * beta) break;
  }
  const double beta = centre + delta;
  return {beta, std::pow(std::tanh(0.5 * beta), s), 1.0 / (1.0 + s * std::exp(-beta)), s};
}

double ClampedFreeMode::value(double xi) const {
  return s * (-std::cos(beta * xi) + sigma * std::sin(beta * xi) + c * std::exp(-beta * xi)) +
         c * std::exp(-beta * (1.0 - xi));
}

double ClampedFreeMode::slope(double xi) const {
  return beta * (s * (std::sin(beta * xi) + sigma * std::cos(beta * xi) - c * std::exp(-beta * xi)) +
                 c * std::exp(-beta * (1.0 - xi)));
}

}  // namespace tenon::titop
