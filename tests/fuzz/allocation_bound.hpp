#pragma once

#include <cstddef>

namespace tenon::fuzz {

/// While one lives, the program ends as at a fault once it holds more memory than at the beginning by `times`
/// the case, or by 4 MiB for small ones: what a file declares must not be believed before its content is there.
class AllocationBound {
 public:
  AllocationBound(std::size_t case_size, int times);
  ~AllocationBound();
  AllocationBound(const AllocationBound&) = delete;
  AllocationBound& operator=(const AllocationBound&) = delete;
};

}  // namespace tenon::fuzz
