#pragma once

#include "interfaces/cli/commands.hpp"

namespace tenon::cli {

/// `tenon doctor --cost`: what forward dynamics of chains costs, counted and measured on this machine.
int run_cost(const DoctorOptions& options);

}  // namespace tenon::cli
