#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>

#include "reduction/factor.hpp"
#include "reduction/inertia.hpp"

namespace tenon::reduction {

/// The count of eigenvalues below a shift, made in a second thread beside the search for the modes: MUMPS analyses as
/// soon as there is an ordering and factors as soon as there is a shift. Refers to K and M while it counts.
class Count {
 public:
  /// Begins the analysis of the common pattern of K and M in the ordering of a factor; nothing where it has begun.
  void prepare(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Factor& ordered);
  /// Begins to count below σ where that may go on beside the search; only the first call does something. Above
  /// 2.5e8 entries of L (2 GB, and MUMPS's factor is larger) the count waits until the search has left its memory.
  void foresee(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma);
  /// σ of the count begun, if any.
  std::optional<double> foreseen() const { return foreseen_; }

  /// The count below σ: that foreseen if σ is the same (and it did not fail), the last one if it was at σ, or a new
  /// one.
  Inertia below(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma, bool estimate_nearest = false);

 private:
  InertiaCounter& counter();

  std::future<std::unique_ptr<InertiaCounter>> analysis_;
  std::unique_ptr<InertiaCounter> ready_;
  std::optional<double> foreseen_, last_sigma_;
  Inertia last_;
  std::future<Inertia> running_;  ///< last, so that it ends before what it works with
  bool begun_ = false, small_ = false;
};

}  // namespace tenon::reduction
