#include "fem/formats/matrices/digits.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "fem/rigid_forces.hpp"

namespace tenon::fem {
namespace {

constexpr Eigen::Index sampled = 4096;  // entries whose digits are counted
constexpr int fewest = 6;               // digits of rounded numbers: fewer are round numbers, and exact
constexpr int most = 13;                // more are a program's doubles
constexpr double digits_add_up = 4.0;   // roundings of a row against that of its largest term
constexpr double outlier = 1e4;         // a tie to the ground leaves nearly all rows without any of its force

int decimals(double x) {
  std::array<char, 32> text{};
  for (int n = 1; n < 17; ++n) {
    const auto written = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::scientific, n - 1);
    double back = 0.0;
    std::from_chars(text.data(), written.ptr, back);
    if (back == x) return n;
  }
  return 17;
}

/// Translations and, where places are known, rotations about the centroid, over the rows of the part.
Eigen::MatrixXd rigid_motions(const Model& model, const MatrixPart& part) {
  std::vector<char> scalar(model.nodes.size(), 0);
  for (const int node : model.scalar_points) scalar[static_cast<std::size_t>(node)] = 1;
  Vec3 centroid = Vec3::Zero();
  for (const Vec3& x : model.nodes) centroid += x / static_cast<double>(model.nodes.size());
  const bool placed = centroid.allFinite();
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(part.dofs.size()), placed ? 6 : 3);
  for (Eigen::Index i = 0; i < R.rows(); ++i) {
    const Dof& dof = part.dofs[static_cast<std::size_t>(i)];
    const auto node = static_cast<std::size_t>(dof.node);
    if (scalar[node] != 0) continue;
    const Vec3 r = placed ? Vec3(model.nodes[node] - centroid) : Vec3::Zero();
    R.row(i) = tau(r).row(dof.direction).head(R.cols());
  }
  return R;
}

}  // namespace

double unit_of_digits(const SparseMatrix& K) {
  const Eigen::Index step = std::max<Eigen::Index>(1, K.nonZeros() / sampled);
  int digits = 0;
  bool single = true;
  for (Eigen::Index k = 0; k < K.nonZeros(); k += step) {
    const double x = K.valuePtr()[k];
    single = single && static_cast<double>(static_cast<float>(x)) == x;
    digits = std::max(digits, decimals(x));
  }
  double unit = std::numeric_limits<double>::epsilon() / 2.0;
  if (digits >= fewest && digits <= most) unit = 0.5 * std::pow(10.0, 1 - digits);
  if (digits > fewest && single) unit = std::max(unit, std::numeric_limits<float>::epsilon() / 2.0);
  return unit;
}

double rounding_of(const Model& model, const MatrixPart& part) {
  const Eigen::MatrixXd R = rigid_motions(model, part);
  const RigidForces forces = rigid_forces(part.K, R);
  const double worst = forces.worst().ratio;
  if (worst <= rigid_limit::of_elements) return rigid_limit::of_elements;
  const double by_digits = digits_add_up * unit_of_digits(part.K);
  int moving = 0, forced = 0;  // rows that move; modal coordinates do not
  for (Eigen::Index i = 0; i < R.rows(); ++i) {
    if (R.row(i).isZero(0.0)) continue;
    ++moving;
    if (forces.ratio(i) > worst / outlier) ++forced;
  }
  const bool in_many_rows = forced > 3 && 4 * forced >= moving;
  return worst <= by_digits && in_many_rows ? std::max(by_digits, rigid_limit::of_matrices) : rigid_limit::of_matrices;
}

}  // namespace tenon::fem
