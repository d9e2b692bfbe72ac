#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

#include "fem/error.hpp"
#include "titop/equilibrate.hpp"
#include "titop/state_space.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Throws: the channels in the null directions of D(I, I), left times right, have nothing to invert.
[[noreturn]] void refuse(const StateSpace& ss, const std::vector<int>& I, const Eigen::VectorXd& direction,
                         double condition) {
  std::vector<std::string> names;
  const double largest = direction.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < I.size(); ++k) {
    const auto i = static_cast<std::size_t>(I[k]);
    if (std::abs(direction[static_cast<Index>(k)]) > 0.3 * largest)
      names.push_back(fmt::format("'{}' → '{}'", ss.inputs[i].name, ss.outputs[i].name));
  }
  throw NumericalError(fmt::format("channel {} cannot be inverted, its direct transmission D is singular: condition",
                                   fmt::join(names, ", ")),
                       condition,
                       "Keep the static modes of that port, add an inertia there, or use the second-order route");
}

std::vector<int> complement(const std::vector<int>& I, Index m) {
  std::vector<int> J;
  for (int j = 0; j < m; ++j)
    if (std::find(I.begin(), I.end(), j) == I.end()) J.push_back(j);
  return J;
}

}  // namespace

// u_I = F (y_I − C_I x − D_IJ u_J) with F = D_II⁻¹ put into the other rows K: eq (27) for a block, which equals the
// succession (28) in any order.
Inversion invert_channels(const StateSpace& ss, const std::vector<int>& I, double limit) {
  check(ss);
  const Index channels = std::min(ss.D.rows(), ss.D.cols()), q = static_cast<Index>(I.size());
  std::vector<int> sorted = I;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end() ||
      (q > 0 && (sorted.front() < 0 || sorted.back() >= channels)))
    throw ModelError(fmt::format("channels to invert must be distinct numbers from 0 to {}", channels - 1),
                     "Give each channel once, and only channels that have an input and an output");
  Inversion inversion{ss, 1.0};
  if (q == 0) return inversion;

  const Equilibrated e = equilibrate(ss.D(I, I));
  const Eigen::JacobiSVD<MatrixXd> svd(e.A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& s = svd.singularValues();
  inversion.condition = s[q - 1] > 0.0 ? s[0] / s[q - 1] : std::numeric_limits<double>::infinity();
  if (!(inversion.condition <= limit))
    refuse(ss, I, svd.matrixU().col(q - 1).cwiseProduct(svd.matrixV().col(q - 1)), inversion.condition);

  const std::vector<int> J = complement(I, ss.D.cols()), K = complement(I, ss.D.rows());
  const MatrixXd F = e.cols.asDiagonal() * e.A.fullPivLu().inverse() * e.rows.asDiagonal();  // D_II⁻¹
  const MatrixXd B_I = ss.B(Eigen::all, I), C_I = ss.C(I, Eigen::all), D_KI = ss.D(K, I), D_IJ = ss.D(I, J);
  const MatrixXd B_J = ss.B(Eigen::all, J), C_K = ss.C(K, Eigen::all), D_KJ = ss.D(K, J);
  StateSpace& inv = inversion.ss;
  inv.A = ss.A - B_I * F * C_I;
  inv.B(Eigen::all, J) = B_J - B_I * F * D_IJ;
  inv.B(Eigen::all, I) = B_I * F;
  inv.C(K, Eigen::all) = C_K - D_KI * F * C_I;
  inv.C(I, Eigen::all) = -F * C_I;
  inv.D(K, J) = D_KJ - D_KI * F * D_IJ;
  inv.D(K, I) = D_KI * F;
  inv.D(I, J) = -F * D_IJ;
  inv.D(I, I) = F;
  for (const int i : I) std::swap(inv.inputs[static_cast<std::size_t>(i)], inv.outputs[static_cast<std::size_t>(i)]);
  return inversion;
}

}  // namespace tenon::titop
