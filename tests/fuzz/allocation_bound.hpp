#pragma once

#include <cstddef>

namespace tenon::fuzz {

/// While one lives, the program ends as at a fault at a single allocation of more than 100 times the case, and once it
/// holds more memory than at the beginning by `times` the case; small cases may take 4 MiB. What a file declares must
/// not be believed before its content is there.
class AllocationBound {
 public:
  AllocationBound(std::size_t case_size, int times);
  ~AllocationBound();
  AllocationBound(const AllocationBound&) = delete;
  AllocationBound& operator=(const AllocationBound&) = delete;
};

}  // namespace tenon::fuzz
