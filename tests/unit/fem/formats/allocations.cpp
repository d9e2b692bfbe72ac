#include "tests/unit/fem/formats/allocations.hpp"

#include <cstdlib>
#include <new>

namespace tenon::fem::testing {

std::atomic<std::size_t> largest_request{0};

}  // namespace tenon::fem::testing

// Every allocation of this executable passes here.
void* operator new(std::size_t n) {
  auto& largest = tenon::fem::testing::largest_request;
  std::size_t seen = largest.load();
  while (n > seen && !largest.compare_exchange_weak(seen, n)) {
  }
  if (void* const p = std::malloc(n > 0 ? n : 1)) return p;
  throw std::bad_alloc();
}
// As the standard library has it; sanitizers bring one of their own, whose memory is not for free().
void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
  try {
    return operator new(n);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
