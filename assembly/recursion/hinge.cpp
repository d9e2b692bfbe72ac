#include "assembly/recursion/hinge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/rotation.hpp"

namespace tenon::assembly {

using fem::Mat3;
using fem::Vec3;
using fem::Vec6;
using Quaternion = Eigen::Quaterniond;

namespace {

struct Kind {
  const char* name;
  int dofs, coordinates;
};
constexpr std::array<Kind, 8> kinds{{{"weld", 0, 0},
                                     {"revolute", 1, 1},
                                     {"prismatic", 1, 1},
                                     {"cylindrical", 2, 2},
                                     {"universal", 2, 2},
                                     {"spherical", 3, 4},
                                     {"planar", 3, 3},
                                     {"free", 6, 7}}};

const Kind& of(HingeKind kind) { return kinds[static_cast<std::size_t>(kind)]; }

Mat3 about_z(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3 R;
  R << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return R;
}

Vec3 turn_of(HingeKind kind, const double* beta) { return Eigen::Map<const Vec3>(beta + attitude(kind)); }

}  // namespace

std::string name(HingeKind kind) { return of(kind).name; }
int hinge_dofs(HingeKind kind) { return of(kind).dofs; }
int hinge_coordinates(HingeKind kind) { return of(kind).coordinates; }
int attitude(HingeKind kind) { return kind == HingeKind::spherical ? 0 : kind == HingeKind::free ? 3 : -1; }

void hinge_motion(HingeKind kind, const double* theta, const double* beta, HingeMotion& motion) {
  motion.R.setIdentity();
  motion.d.setZero();
  motion.bias.setZero();
  motion.H_star.setZero(6, hinge_dofs(kind));
  switch (kind) {
    case HingeKind::weld:
      break;
    case HingeKind::revolute:
      motion.R = about_z(theta[0]);
      motion.H_star(5, 0) = 1.0;
      break;
    case HingeKind::prismatic:
      motion.d.z() = theta[0];
      motion.H_star(2, 0) = 1.0;
      break;
    case HingeKind::cylindrical:
      motion.d.z() = theta[0];
      motion.R = about_z(theta[1]);
      motion.H_star(2, 0) = motion.H_star(5, 1) = 1.0;
      break;
    case HingeKind::universal: {
      const double c = std::cos(theta[0]), s = std::sin(theta[0]), c2 = std::cos(theta[1]), s2 = std::sin(theta[1]);
      motion.R << c2, 0.0, s2, s * s2, c, -s * c2, -c * s2, s, c * c2;  // R_x(θ1) R_y(θ2)
      motion.H_star(3, 0) = 1.0;
      motion.H_star.col(1) << 0.0, 0.0, 0.0, 0.0, c, s;
      motion.bias.tail<3>() << 0.0, -s * beta[0] * beta[1], c * beta[0] * beta[1];
      break;
    }
    case HingeKind::planar:
      motion.d << theta[0], theta[1], 0.0;
      motion.R = about_z(theta[2]);
      motion.H_star(0, 0) = motion.H_star(1, 1) = motion.H_star(5, 2) = 1.0;
      break;
    case HingeKind::spherical:
      motion.R = Quaternion(theta).toRotationMatrix();
      motion.H_star.bottomRows<3>() = motion.R;
      break;
    case HingeKind::free:
      motion.d = Eigen::Map<const Vec3>(theta);
      motion.R = Quaternion(theta + 3).toRotationMatrix();
      motion.H_star.topLeftCorner<3, 3>().setIdentity();
      motion.H_star.bottomRightCorner<3, 3>() = motion.R;
      break;
  }
}

// ω' = −Rᵀω, d' = −Rᵀd, ḋ' = −Rᵀ(ḋ − ω × d), and their rates in the axes of O
void reverse(const double* beta, HingeMotion& motion) {
  Vec6 V = Vec6::Zero();
  for (Eigen::Index j = 0; j < motion.H_star.cols(); ++j) V += beta[j] * motion.H_star.col(j);
  const Vec3 v = V.head<3>(), w = V.tail<3>(), dv = motion.bias.head<3>(), dw = motion.bias.tail<3>(), d = motion.d;
  const Mat3 back = motion.R.transpose();
  motion.bias.head<3>() = -back * (dv - dw.cross(d) - 2.0 * w.cross(v) + w.cross(w.cross(d)));
  motion.bias.tail<3>() = -back * dw;
  for (Eigen::Index j = 0; j < motion.H_star.cols(); ++j) {
    const Vec3 hv = motion.H_star.col(j).head<3>(), hw = motion.H_star.col(j).tail<3>();
    motion.H_star.col(j).head<3>() = -back * (hv - hw.cross(d));
    motion.H_star.col(j).tail<3>() = -back * hw;
  }
  motion.d = -back * d;
  motion.R = back;
}

void rest(HingeKind kind, double* theta) {
  std::fill_n(theta, hinge_coordinates(kind), 0.0);
  if (attitude(kind) >= 0) theta[attitude(kind) + 3] = 1.0;
}

void move(HingeKind kind, const double* delta, double* theta) {
  const int first = attitude(kind), plain = first < 0 ? hinge_dofs(kind) : first;
  for (int j = 0; j < plain; ++j) theta[j] += delta[j];
  if (first < 0) return;
  const Vec3 turn = turn_of(kind, delta);
  const double half = 0.5 * turn.norm();
  const double sinc = half < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  Quaternion step;
  step.w() = std::cos(half);
  step.vec() = 0.5 * sinc * turn;
  Eigen::Map<Quaternion> q(theta + first);
  q = (q * step).normalized();
}

void displacements(HingeKind kind, const double* theta, double* delta) {
  const int first = attitude(kind), plain = first < 0 ? hinge_dofs(kind) : first;
  std::copy_n(theta, plain, delta);
  if (first >= 0) Eigen::Map<Vec3>(delta + first) = fem::rotation_vector(Quaternion(theta + first).toRotationMatrix());
}

}  // namespace tenon::assembly
