#pragma once

#include "assembly/integration/integrate.hpp"

/// SUNDIALS CVODE behind the door of integrate(): an independent reference with error control of variable order.
///
/// y = (q, v) with quaternions as four plain numbers, normalised before they are used. BDF solves by GMRES, which the
/// implicit articulated body preconditions (dq = r_q + γ dv, (M + γC + γ²K) dv = M r_v − γ K r_q); Adams
/// iterates by fixed points. Neither takes closed loops.
namespace tenon::assembly {

/// Samples go to `observe`, which stops the run by false. History is not kept between calls: a later one starts anew at
/// order 1, within the tolerance but not bit for bit. Throws NumericalError when CVODE gives up, ModelError for
/// closed loops.
void integrate_cvode(const Multibody& system, Dynamics& dynamics, IntegrationState& state,
                     const IntegrationOptions& options, Integration& result,
                     const std::function<bool(double t, const MotionState& state)>& observe);

}  // namespace tenon::assembly
