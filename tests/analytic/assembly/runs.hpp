#pragma once

#include "assembly/integration/integrate.hpp"

/// A run and the last it showed.
namespace tenon::assembly::testing {

inline constexpr Method all_methods[] = {Method::generalized_alpha, Method::midpoint, Method::dormand_prince,
                                         Method::bdf, Method::adams};

struct Ran {
  Integration result;
  MotionState last;
  double t = 0.0;
  long samples = 0;
  std::vector<double> times{};
};
inline Ran run(const Multibody& mb, const MotionState& start, const IntegrationOptions& options,
               const Loads& loads = {}) {
  Ran r;
  IntegrationState state = begin(mb, start);
  r.result = integrate(mb, loads, state, options, [&](const Sample& s) {
    r.last = s.state;
    r.t = s.t;
    ++r.samples;
    r.times.push_back(s.t);
    return true;
  });
  return r;
}

}  // namespace tenon::assembly::testing
