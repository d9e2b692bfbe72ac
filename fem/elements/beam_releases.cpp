#include "fem/elements/beam_releases.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

constexpr double negligible = 1e-11;  ///< of a diagonal term of K: rounding, of some 1e-16 of it

void clear(Mat12& K, int i) {
  K.row(i).setZero();
  K.col(i).setZero();
}

}  // namespace

Release release_ends(const Beam& beam, const Mat12& K) {
  constexpr std::array<const char*, 6> direction{"ux", "uy", "uz", "rx", "ry", "rz"};
  Release release{Mat12::Identity(), K};
  for (int r = 0; r < 12; ++r) {
    if ((beam.releases[static_cast<std::size_t>(r / 6)] >> (r % 6) & 1) == 0 || K(r, r) == 0.0) continue;
    const double K_rr = release.K(r, r);
    if (!(K_rr > negligible * K(r, r)))
      throw ModelError(fmt::format("beam element {}: its end releases make a mechanism: with {} released at end {} "
                                   "nothing holds the element between its nodes",
                                   beam.id, direction[static_cast<std::size_t>(r % 6)], r / 6 + 1),
                       "Release fewer directions, or the direction at one end only");
    Eigen::Matrix<double, 1, 12> follow = -release.K.row(r) / K_rr;
    follow[r] = 0.0;
    const Eigen::Matrix<double, 12, 1> moves = release.T.col(r), k = release.K.col(r);
    release.T.col(r).setZero();
    release.T += moves * follow;
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 12; ++i) release.K(i, j) -= k[i] * k[j] / K_rr;
    clear(release.K, r);
  }
  for (int i = 0; i < 12; ++i)  // no stiffness left but rounding: K ≥ 0 has an empty row where its diagonal is 0
    if (release.K(i, i) <= negligible * K(i, i)) clear(release.K, i);
  return release;
}

Mat12 congruent(const Mat12& A, const Mat12& T) {
  const Mat12 AT = A.lazyProduct(T);
  return T.transpose().lazyProduct(AT);
}

}  // namespace tenon::fem
