#pragma once

#include <Eigen/Core>

#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "titop/state_space.hpp"

namespace tenon::cli {

/// `tenon assemble --linearise`.
int run_linearised(const AssembleOptions& options);

Json channels(const std::vector<titop::Channel>& list);
void print_channels(const char* title, const std::vector<titop::Channel>& list);

/// The state space for other programs: A, B, C, D row by row, SI, named channels.
void write_system(const std::filesystem::path& path, Json object, const titop::StateSpace& ss);

}  // namespace tenon::cli
