#pragma once

#include "assembly/integration/run.hpp"

/// SUNDIALS CVODE behind the door of integrate(): an independent reference with error control of variable order.
///
/// y = (q, v) with quaternions as four plain numbers, normalised before they are used. BDF solves by GMRES, which the
/// implicit articulated body preconditions (dq = r_q + γ dv, (M + γC + γ²K) dv = M r_v − γ K r_q); Adams
/// iterates by fixed points. Loops are closed in acceleration, and by BDF projected in position and speed after each
/// step (CVODE projects with BDF only); Adams takes none.
namespace tenon::assembly {

/// History is not kept between calls: a later one starts anew at order 1, within the tolerance but not bit for bit.
/// Throws NumericalError when CVODE gives up.
void run_cvode(Run& run);

}  // namespace tenon::assembly
