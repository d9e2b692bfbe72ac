#include "fem/elements/quad4_geometry.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "fem/elements/shell_shape.hpp"
#include "fem/error.hpp"

// A bilinear quad x = x̄ + r x_r + s x_s + rs x_d has three constant strains and two that vary. All five follow from
// the covariant strains along its edges and in its centre (Ko, Lee, Bathe, Comput. Struct. 182 (2017) 404), and these
// from six chords between nodes in space,
//
//   g_ij = (x_j − x_i)·(u_j − u_i)
//   A = e_rr(0,1) = ¼ g_43,  B = e_rr(0,−1) = ¼ g_12,  C = e_ss(1,0) = ¼ g_23,  D = e_ss(−1,0) = ¼ g_14
//   E = e_rs(0,0) = (g_13 − g_24) / 16                                                                             (1)
//   e_rr = ½(A+B) − d + ½ s (A−B) + s² d,  e_ss = ½(C+D) − d + ½ r (C−D) + r² d
//
// d = x_d·u_d: with x_d = c_r x_r + c_s x_s in the mean plane it is
//
//   d (1 − c_r² − c_s²) = ½ c_r (A−B) + ½ c_s (C−D) − ½ c_r² (A+B) − ½ c_s² (C+D) − 2 c_r c_s E                    (2)
//
// which leaves out what warping has across the plane: that would lock. A convex quad has |c_r| + |c_s| < 1.
//
// The surface is curved between two nodes, with normals n_i, n_j at them. Bending alone, without strain along it,
// brings their ends together or apart: of an arc l with curvature κ₀ that bends by δκ, δg = −κ₀ δκ l⁴/12, so that
//
//   its own stretch is  g + (1/12) ((n_j − n_i)·Δx) ((θ_j − θ_i) × n)·Δx                                           (3)
//
// Neither rigid motions nor flat quads change. Without (3) thin shells lock on skew meshes: chords side by side differ
// in length, and no displacement in the surface undoes the strain all of them show.
//
// Strain over a curved surface is not bilinear either. Compatibility says that bending κ along a, in a surface with
// curvature κ₀ along n, comes with ε_aa,nn = −κ₀ κ: e.g. a cylinder's ε_xx is a parabola around it, where u, v follow
// the hoop. What edges and centre say of its mean over the element is off by
//
//   Δe_rr = ⅓ G a_r² n_s²,  Δe_ss = ⅓ G a_s² n_r²,  Δe_rs = ⅙ G (a_r² + a_s²) n_r n_s,   a_r = x_r·a, … (4)
//
// G = κ₁ κ_22 + κ₂ κ_11 in the axes of the surface's curvatures κ₁, κ₂, no strain in inextensional bending. Of two
// curvatures n is the greater one's axis in the share δ = |κ₁² − κ₂²| / (κ₁² + κ₂²), any axis in the rest:
//
//   mean of a_r² n_s² = ⅛ (3 x_r² x_s² − 2 (x_r·x_s)²),  mean of (a_r² + a_s²) n_r n_s = ⅛ (x_r·x_s)(x_r² + x_s²)
//
// Compatibility leaves open what part of G is parabolas of ε_nn and γ; (4) is their absence, as in shells that carry
// along a. It leaves a fifth of the error of the Scordelis-Lo roof.
//
// With (3) the rotations can undo membrane strain, which costs them bending only: where h² ≫ R t more of them than the
// shell itself has, and its modes come out low (t/R = 1e-4, 16 skew quads a quarter of a cylinder: by half). All of
// this is taken
//
//   1 / (1 + m̂² A / 12 t²)                                                                                         (5)
//
// times, m̂ the largest tilt of a node's normal against their mean: the whole where elements resolve √(R t), the flat
// quad, a few per cent stiff in bending and never far off, where they do not.
//
// The flat membrane hangs on arms a_i at the nodes, u_corner = u + θ × a e_z, and has the chords Δx·Δu_corner in its
// plane. E adds what (3) says to them.
namespace tenon::fem {
namespace {

using Chord = Eigen::Matrix<double, 1, 12>;

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;
using Tilts = NormalTilts<4>;

/// What (3) adds to the chord of corners i and j, over (w θx θy).
Chord chord_terms(const FlatQuad& f, const Tilts& m, int i, int j) {
  const auto ki = static_cast<std::size_t>(i), kj = static_cast<std::size_t>(j);
  const double dx = f.x[j] - f.x[i], dy = f.y[j] - f.y[i];
  const double bend = (dx * (m[kj].x() - m[ki].x()) + dy * (m[kj].y() - m[ki].y())) / 12.0;
  const double a_i = f.arms[ki].z(), a_j = f.arms[kj].z();
  Chord g = Chord::Zero();  // (θ × n)·Δx = θy Δx − θx Δy; Δz = a_i − a_j
  g.segment<3>(3 * j) << a_i - a_j, (a_j - bend) * dy, (bend - a_j) * dx;
  g.segment<3>(3 * i) << a_j - a_i, (bend - a_i) * dy, (a_i - bend) * dx;
  return g;
}

/// A tensor's covariant components: rr, ss, rs.
template <typename T>
struct Covariant {
  T rr, ss, rs;
};

/// ¼ Δm·Δx of corners i and j.
double normal_turn(const FlatQuad& f, const Tilts& m, int i, int j) {
  return 0.25 *
         Vec2(f.x[j] - f.x[i], f.y[j] - f.y[i]).dot(m[static_cast<std::size_t>(j)] - m[static_cast<std::size_t>(i)]);
}

/// ¼ ((θ_j − θ_i) × n)·Δx of corners i and j, over (w θx θy).
Chord bending_turn(const FlatQuad& f, int i, int j) {
  const double dx = 0.25 * (f.x[j] - f.x[i]), dy = 0.25 * (f.y[j] - f.y[i]);
  Chord k = Chord::Zero();
  k.segment<2>(3 * j + 1) << -dy, dx;
  k.segment<2>(3 * i + 1) << dy, -dx;
  return k;
}

/// (4). `J`: columns x_r, x_s
Covariant<Chord> parabolas(const FlatQuad& f, const Tilts& m, const Mat2& J, const Mat2& J_inv) {
  const Covariant<double> z{.rr = 0.5 * (normal_turn(f, m, 3, 2) + normal_turn(f, m, 0, 1)),
                            .ss = 0.5 * (normal_turn(f, m, 1, 2) + normal_turn(f, m, 0, 3)),
                            .rs = f.arms[0].z()};
  const Covariant<Chord> k{.rr = 0.5 * (bending_turn(f, 3, 2) + bending_turn(f, 0, 1)),
                           .ss = 0.5 * (bending_turn(f, 1, 2) + bending_turn(f, 0, 3)),
                           .rs = 0.25 * (bending_turn(f, 0, 2) - bending_turn(f, 1, 3))};
  const Mat2 Z = J_inv.transpose() * (Mat2() << z.rr, z.rs, z.rs, z.ss).finished() * J_inv;
  const double angle = 0.5 * std::atan2(2.0 * Z(0, 1), Z(0, 0) - Z(1, 1));
  Vec2 n(std::cos(angle), std::sin(angle)), a(-n.y(), n.x());
  double k_n = n.dot(Z * n), k_a = a.dot(Z * a);
  if (std::abs(k_a) > std::abs(k_n)) {
    std::swap(n, a);
    std::swap(k_n, k_a);
  }
  const double along = k_n == 0.0 ? 0.0 : (k_n * k_n - k_a * k_a) / (k_n * k_n + k_a * k_a),
               any = 0.125 * (1.0 - along);
  const Vec2 N = J.transpose() * n, A = J.transpose() * a;  // n_r, n_s; a_r, a_s
  const double r2 = J.col(0).squaredNorm(), s2 = J.col(1).squaredNorm(), rs = J.col(0).dot(J.col(1));
  const double round = any * (3.0 * r2 * s2 - 2.0 * rs * rs), area = J.determinant();

  const Chord G = (1.0 / (area * area)) * (z.rr * k.ss + z.ss * k.rr - 2.0 * z.rs * k.rs);
  return {.rr = (along * A[0] * A[0] * N[1] * N[1] + round) / 3.0 * G,
          .ss = (along * A[1] * A[1] * N[0] * N[0] + round) / 3.0 * G,
          .rs = (along * A.squaredNorm() * N[0] * N[1] + any * rs * (r2 + s2)) / 6.0 * G};
}

}  // namespace

FlatQuad flat_quad(const Quad4& quad, std::span<const Vec3> nodes) {
  std::array<Vec3, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = nodes[static_cast<std::size_t>(quad.nodes[i])];
  const Vec3 d13 = p[2] - p[0], d24 = p[3] - p[1], normal = d13.cross(d24);
  const double size2 = d13.squaredNorm() + d24.squaredNorm();
  if (!spans_area(d13, d24))
    throw ModelError(fmt::format("quad element {}: its area is zero", quad.id),
                     "Delete it, or use a triangle where two of its nodes coincide");
  FlatQuad f;
  f.R.col(2) = normal.normalized();
  f.R.col(0) = (d13.normalized() - d24.normalized()).normalized();
  f.R.col(1) = f.R.col(2).cross(f.R.col(0));
  const Vec3 centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  for (int i = 0; i < 4; ++i) {
    const Vec3 local = f.R.transpose() * (p[static_cast<std::size_t>(i)] - centre);
    f.x[i] = local.x();
    f.y[i] = local.y();
    const bool flat = std::abs(local.z()) <= 1e-13 * std::sqrt(size2);
    f.arms[static_cast<std::size_t>(i)] = flat ? Vec3(0.0, 0.0, 0.0) : Vec3(0.0, 0.0, -local.z());
  }
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4, last = (i + 3) % 4;
    const double turn = (f.x[next] - f.x[i]) * (f.y[last] - f.y[i]) - (f.y[next] - f.y[i]) * (f.x[last] - f.x[i]);
    if (!turns(turn, normal.norm()))
      throw ModelError(
          fmt::format("quad element {}: it is folded or crossed, the angle at its corner {} is 180° or more", quad.id,
                      i + 1),
          "List the nodes around the element, or split it into two triangles");
  }
  return f;
}

bool surface_terms(const Quad4& quad, std::span<const Vec3> directors, const FlatQuad& f, double thickness,
                   SurfaceTerms& E) {
  using Pair = Eigen::Matrix<double, 2, 12>;
  Tilts m;
  if (!normal_tilts(quad.nodes, directors, f.R, m)) return false;

  const Chord A = 0.25 * chord_terms(f, m, 3, 2), B = 0.25 * chord_terms(f, m, 0, 1);  // (1)
  const Chord C = 0.25 * chord_terms(f, m, 1, 2), D = 0.25 * chord_terms(f, m, 0, 3);
  const Chord centre = (chord_terms(f, m, 0, 2) - chord_terms(f, m, 1, 3)) / 16.0;
  Mat2 J;  // columns x_r, x_s
  J << corner_r.dot(f.x), corner_s.dot(f.x), corner_r.dot(f.y), corner_s.dot(f.y);
  J *= 0.25;
  const Mat2 J_inv = J.inverse(), to_plane = J_inv.transpose();
  const Vec2 x_d(0.25 * corner_h.dot(f.x), 0.25 * corner_h.dot(f.y)), c = J_inv * x_d;
  const Chord d = (0.5 * c[0] * ((1.0 - c[0]) * A - (1.0 + c[0]) * B) +
                   0.5 * c[1] * ((1.0 - c[1]) * C - (1.0 + c[1]) * D) - 2.0 * c[0] * c[1] * centre) /
                  (1.0 - c.squaredNorm());  // (2)
  const Covariant<Chord> parabola = parabolas(f, m, J, J_inv);
  const Chord e_rr = 0.5 * (A + B) - d + parabola.rr, e_ss = 0.5 * (C + D) - d + parabola.ss;
  const Chord e_rs = centre + parabola.rs;
  // corners that show these strains and do not turn: x_r·u_r = e_rr, x_s·u_r = e_rs, …, x_r·u_d + x_d·u_r = ½(A−B)
  Pair e_r, e_s, e_d;
  e_r << e_rr, e_rs;
  e_s << e_rs, e_ss;
  const Pair u_r = to_plane.lazyProduct(e_r), u_s = to_plane.lazyProduct(e_s);
  e_d << 0.5 * (A - B) - x_d.transpose().lazyProduct(u_r), 0.5 * (C - D) - x_d.transpose().lazyProduct(u_s);
  const Pair u_d = to_plane.lazyProduct(e_d);
  const double share = resolved_share(m, 4.0 * J.determinant(), thickness);  // (5)
  for (int i = 0; i < 4; ++i)
    E.middleRows<2>(2 * i) = share * corner_r[i] * u_r + share * corner_s[i] * u_s + share * corner_h[i] * u_d;
  return true;
}

}  // namespace tenon::fem
