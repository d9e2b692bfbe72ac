#pragma once

#include <Eigen/Core>
#include <atomic>
#include <thread>

namespace tenon::reduction {

/// Threads at long work of their own beside the caller's (the count of eigenvalues beside their search).
inline std::atomic<unsigned> working_beside = 0;

/// While one lives, a core is taken by such a thread.
struct WorkBeside {
  WorkBeside() { ++working_beside; }
  ~WorkBeside() { --working_beside; }
  WorkBeside(const WorkBeside&) = delete;
  WorkBeside& operator=(const WorkBeside&) = delete;
};

/// Is there a second core that nobody works on?
inline bool second_core() { return std::thread::hardware_concurrency() >= 2 + working_beside; }

/// first() and second(), at once where `worth` says so and a second core is there, else one after the other.
template <class First, class Second>
void both(bool worth, const First& first, const Second& second) {
  if (worth && second_core()) {
    std::thread other(second);
    first();
    other.join();
  } else {
    first();
    second();
  }
}

/// work(begin, end, part) on two halves of 0..n (parts 0 and 1) where `worth` says so; else work(0, n, 0). Who takes
/// the halves depends on the cores at hand, the halves themselves do not: the digits of sums stay the same. Halves, not
/// as many as there are cores: what runs here is bound by memory.
template <class Work>
void in_two(Eigen::Index n, bool worth, const Work& work) {
  if (!worth || n < 2) {
    work(Eigen::Index{0}, n, 0);
    return;
  }
  both(
      true, [&] { work(Eigen::Index{0}, n / 2, 0); }, [&] { work(n / 2, n, 1); });
}

}  // namespace tenon::reduction
