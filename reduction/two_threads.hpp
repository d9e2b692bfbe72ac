#pragma once

#include <Eigen/Core>
#include <thread>

namespace tenon::reduction {

/// work(begin, end, part) on two halves of 0..n at once (parts 0 and 1) where `worth` says so and the machine has a second
/// core; else work(0, n, 0). Halves, not as many as there are cores: what runs here is bound by memory.
template <class Work>
void in_two(Eigen::Index n, bool worth, const Work& work) {
  if (!worth || n < 2 || std::thread::hardware_concurrency() < 2) {
    work(Eigen::Index{0}, n, 0);
    return;
  }
  std::thread second([&] { work(n / 2, n, 1); });
  work(Eigen::Index{0}, n / 2, 0);
  second.join();
}

}  // namespace tenon::reduction
