#include "assembly/frequency_response.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::assembly {

std::vector<double> response_grid(const SystemModes& modes, double low, double high, int points) {
  std::vector<double> grid;
  const double ratio = std::log(high / low);
  for (int k = 0; k < points; ++k) grid.push_back(low * std::exp(ratio * k / std::max(points - 1, 1)));
  grid.back() = high;                // without round-off
  constexpr double undamped = 1e-4;  // half width of the cluster around an undamped peak, which is infinite
  constexpr int side = 12;
  for (Eigen::Index j = modes.rigid; j < modes.omega.size(); ++j) {
    const double omega = modes.omega[j];
    if (!(omega > low && omega < high)) continue;
    const double half_width = std::max(modes.zeta[j], undamped) * omega;
    for (int k = -side; k <= side; ++k) {
      // 0, ±¼, ±½ .. near the peak, then wider: sinh spacing out to about ±10 half widths
      const double at = omega + half_width * std::sinh(3.0 * k / side);
      if (at > low && at < high && !(k == 0 && modes.zeta[j] == 0.0)) grid.push_back(at);
    }
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return grid;
}

std::vector<FrequencyResponse> frequency_responses(const SecondOrderSystem& system, const std::vector<int>& outputs,
                                                   int input, const std::vector<double>& omega) {
  std::vector<FrequencyResponse> responses(outputs.size());
  for (const double w : omega) {
    const Eigen::MatrixXcd G = response(system, w);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      responses[k].omega.push_back(w);
      responses[k].value.push_back(G(outputs[k], input));
    }
  }
  return responses;
}

}  // namespace tenon::assembly
