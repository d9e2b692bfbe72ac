#include "assembly/recursion/sweep_kernels.hpp"

#include <cmath>
#include <utility>

namespace tenon::assembly {

namespace plain {
constexpr int lanes = 2;
#include "assembly/recursion/sweep_kernels.inc"
}  // namespace plain

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
constexpr int lanes = 4;
#include "assembly/recursion/sweep_kernels.inc"
}  // namespace avx2
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,fma")
namespace avx512 {
constexpr int lanes = 8;
#include "assembly/recursion/sweep_kernels.inc"
}  // namespace avx512
#pragma GCC pop_options
#endif

namespace {

SweepKernels choose() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    return {avx512::add_child_modes, avx512::eliminate_modes, avx512::lower_sweep,   avx512::upper_sweep,
            avx512::add_mode_forces, avx512::copy_inertia,    avx512::take_out_axis, avx512::carry_inertia,
            avx512::carry_force,     avx512::carry_rate,      avx512::hang,          avx512::rigid_load};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return {avx2::add_child_modes, avx2::eliminate_modes, avx2::lower_sweep,   avx2::upper_sweep,
            avx2::add_mode_forces, avx2::copy_inertia,    avx2::take_out_axis, avx2::carry_inertia,
            avx2::carry_force,     avx2::carry_rate,      avx2::hang,          avx2::rigid_load};
#endif
  return {plain::add_child_modes, plain::eliminate_modes, plain::lower_sweep,   plain::upper_sweep,
          plain::add_mode_forces, plain::copy_inertia,    plain::take_out_axis, plain::carry_inertia,
          plain::carry_force,     plain::carry_rate,      plain::hang,          plain::rigid_load};
}

}  // namespace

const SweepKernels& sweep_kernels() {
  static const SweepKernels kernels = choose();
  return kernels;
}

}  // namespace tenon::assembly
