#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "assembly/recursion/closure.hpp"
#include "tests/benchmarks/chain.hpp"

// Counts what the recursions take from the heap: every allocation of this program passes through here.
namespace {
std::atomic<long> allocations{0};
}
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: glibc's own
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace tenon::assembly {
namespace {

using Eigen::VectorXd;

TEST(Allocations, RecursionsTakeNothingFromTheHeap) {
  const long before_vector = allocations;
  { const VectorXd seen(100); }
  ASSERT_GT(allocations, before_vector) << "the counter sees Eigen's allocations";
  for (const int modes : {0, 1, 5, 10}) {
    Multibody mb = bench::chain(20, modes);
    Closure c;  // the tip on a rail
    c.inner = {-1, -1};
    c.outer = {19, 1};
    c.kind = HingeKind::planar;
    mb.closures = {c};
    for (const Deformation deformation : {Deformation::dropped, Deformation::full}) {
      for (HingedBody& b : mb.bodies) b.deformation = deformation;
      const MotionState s = bench::bent(mb);
      Sweeps sweeps = make_sweeps(mb);
      ClosureRows rows = make_closure_rows(mb);
      VectorXd T = VectorXd::Zero(mb.nv), v_dot(mb.nv);
      const auto all = [&] {
        set_state(mb, s.q, s.v, sweeps);
        passive_forces(mb, s.q, s.v, T);
        closure_rows(mb, sweeps, s.q, s.v, rows);
        inverse_dynamics(mb, sweeps, s.v, v_dot);
        articulate(mb, sweeps, {1e-3, 1e-6});
        solve(mb, sweeps, T, v_dot);
        articulate(mb, sweeps);
        forward_dynamics(mb, sweeps, T, v_dot);
      };
      all();
      const long before = allocations;
      all();
      EXPECT_EQ(allocations - before, 0) << modes << " modes a body";
    }
  }
}

}  // namespace
}  // namespace tenon::assembly
