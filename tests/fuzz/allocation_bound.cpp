#include "tests/fuzz/allocation_bound.hpp"

#include <sanitizer/allocator_interface.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace tenon::fuzz {
namespace {

constexpr std::int64_t least = 4 << 20;

// One thread reads; the hooks must not allocate.
std::int64_t live = 0, bound = 0, single_bound = 0;
bool counting = false;

void allocated(const volatile void*, std::size_t size) {
  const auto bytes = static_cast<std::int64_t>(size);
  if (!counting || ((live += bytes) <= bound && bytes <= single_bound)) return;
  counting = false;
  constexpr std::string_view text = "ERROR: the reader holds more than its bound: a multiple of the case, and 4 MiB\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  std::abort();
}

void freed(const volatile void* memory) {
  if (counting && memory)
    live -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(memory)));
}

}  // namespace

AllocationBound::AllocationBound(std::size_t case_size, int times) {
  [[maybe_unused]] static const int installed = __sanitizer_install_malloc_and_free_hooks(allocated, freed);
  live = 0;
  const auto bytes = static_cast<std::int64_t>(case_size);
  bound = std::max(least, times * bytes);
  single_bound = std::max(least, 100 * bytes);
  counting = true;
}

AllocationBound::~AllocationBound() { counting = false; }

}  // namespace tenon::fuzz
