#include "assembly/recursion/mode_kernels.hpp"

#include <cmath>

namespace tenon::assembly {

namespace plain {
#include "assembly/recursion/mode_kernels.inc"
}

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
#include "assembly/recursion/mode_kernels.inc"
}
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,fma")
namespace avx512 {
#include "assembly/recursion/mode_kernels.inc"
}
#pragma GCC pop_options
#endif

namespace {

ModeKernels choose() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    return {avx512::add_child_modes, avx512::eliminate_modes, avx512::lower_sweep, avx512::upper_sweep,
            avx512::add_mode_forces};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return {avx2::add_child_modes, avx2::eliminate_modes, avx2::lower_sweep, avx2::upper_sweep, avx2::add_mode_forces};
#endif
  return {plain::add_child_modes, plain::eliminate_modes, plain::lower_sweep, plain::upper_sweep,
          plain::add_mode_forces};
}

}  // namespace

const ModeKernels& mode_kernels() {
  static const ModeKernels kernels = choose();
  return kernels;
}

}  // namespace tenon::assembly
