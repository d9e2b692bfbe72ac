#pragma once

#include <atomic>
#include <cstddef>

namespace tenon::fem::testing {

/// The largest piece of memory asked for since this was last set to zero.
extern std::atomic<std::size_t> largest_request;

}  // namespace tenon::fem::testing
