#pragma once

#include <optional>

#include "reduction/block_lanczos.hpp"
#include "reduction/modes.hpp"
#include "reduction/shift_invert.hpp"

namespace tenon::reduction {

/// Where to stop: the `modes` largest μ are to be converged; between them and the next lies the shift σ of the count.
struct Cut {
  int modes = 0;
  double sigma = 0.0;  ///< [rad²/s²]
  bool last = false;   ///< there are no further finite modes
};

/// Chooses the cut for at least `wanted` modes from Ritz values of the operator at shift s: the first gap from there on
/// that is wider than the Ritz values' own uncertainty and than 1e-4, so never inside a cluster. With `sigma` given the
/// cut is there. Empty when the Ritz values do not say yet, or the modes below the cut have not met `tolerance`
/// (residual relative to μ).
std::optional<Cut> choose_cut(const RitzValues& ritz, int wanted, double s, double tolerance,
                              std::optional<double> sigma);

/// A shift that will lie in that gap if the Ritz values of a running search, of an error near residual²/θ, are right;
/// empty while they cannot tell. It lies in the lower quarter: the values still move down.
std::optional<double> foresee_cut(const RitzValues& ritz, int wanted, double s);

/// Does σ lie below every mode but the first `modes`, clear of its neighbours as a cut that choose_cut makes?
bool clear_of_modes(const RitzValues& ritz, int modes, double s, double sigma);

/// Eigenpairs by the solver the options name, orthogonal to `locked`; vectors of all modes below the cut and one more.
/// `watch`, if any, sees the Ritz values of each block step.
LanczosResult find_pairs(const ShiftInvert& op, const ModesOptions& options, const Eigen::MatrixXd& locked, int wanted,
                         int block, std::uint64_t seed, double s, std::optional<double> sigma,
                         const std::function<void(const RitzValues&)>& watch = {});

}  // namespace tenon::reduction
