#include "reduction/count.hpp"

#include "fem/error.hpp"
#include "reduction/dense.hpp"
#include "reduction/two_threads.hpp"

namespace tenon::reduction {

namespace {

constexpr double small_factor = 2.5e8;  // entries of L

}  // namespace

void Count::prepare(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Factor& ordered) {
  if (begun_) return;
  begun_ = true;
  small_ = ordered.report().nonzeros < small_factor;
  analysis_ = std::async(std::launch::async, [&K, &M, permutation = ordered.permutation()] {
    return std::make_unique<InertiaCounter>(K, M, permutation);
  });
}

InertiaCounter& Count::counter() {
  if (analysis_.valid()) ready_ = analysis_.get();
  return *ready_;
}

void Count::foresee(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma) {
  if (foreseen_ || !small_) return;
  foreseen_ = sigma;
  running_ = std::async(std::launch::async, [this, &K, &M, sigma] {
    const WorkBeside busy;
    const ThreadLimit limit;
    return counter().count(K, M, sigma);
  });
}

Inertia Count::below(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma, bool estimate_nearest) {
  if (running_.valid()) {
    try {
      last_ = running_.get();
      last_sigma_ = foreseen_;
    } catch (const NumericalError&) {
      if (!ready_) throw;   // the analysis failed
      last_sigma_.reset();  // σ foreseen was a bad one
    }
  }
  if (last_sigma_ == sigma && !estimate_nearest) return last_;
  last_sigma_.reset();
  last_ = counter().count(K, M, sigma, estimate_nearest);
  last_sigma_ = sigma;
  return last_;
}

}  // namespace tenon::reduction
