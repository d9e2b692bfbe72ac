#pragma once

#include "interfaces/cli/commands.hpp"

namespace tenon::cli {

/// `tenon check` of a mesh (its geometry) or of a deck (all checks, in the deck's units).
int check_mesh(const CheckOptions& options, bool deck);

}  // namespace tenon::cli
