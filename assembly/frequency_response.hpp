#pragma once

#include <vector>

#include "assembly/second_order.hpp"

namespace tenon::assembly {

/// Frequencies [rad/s] that show a response between `low` and `high` > 0: `points` evenly spaced on the logarithmic
/// axis, and around each mode's peak a cluster as wide as its half-power bandwidth 2ζω, so that no peak falls between
/// two points however light its damping.
std::vector<double> response_grid(const SystemModes& modes, double low, double high, int points);

/// One response from an input to an output over a grid.
struct FrequencyResponse {
  std::vector<double> omega;                ///< [rad/s]
  std::vector<std::complex<double>> value;  ///< in the output's unit per the input's
};

/// Responses of some outputs (rows of the system) to one input (a column).
std::vector<FrequencyResponse> frequency_responses(const SecondOrderSystem& system, const std::vector<int>& outputs,
                                                   int input, const std::vector<double>& omega);

}  // namespace tenon::assembly
