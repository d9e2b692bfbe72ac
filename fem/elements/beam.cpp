#include "fem/elements/beam.hpp"

#include <Eigen/LU>

#include "fem/elements/basic_frame.hpp"
#include "fem/elements/beam_frame.hpp"
#include "fem/elements/beam_releases.hpp"

// The beam in its own axes: x from end 1 to end 2 (length h), y and z of the section. Both bending planes at once:
//   v = (u_y, u_z), slopes s = (r_z, −r_y), so that s = v' in an unsheared beam.
//   B   = E [I_z I_yz; I_yz I_y]                     bending stiffness, M = B s'          2×2
//   C_s = diag(1/κ_y GA, 1/κ_z GA), 0 where κ = 0    shear compliance, v' − s = C_s V      2×2
//
// Exact static shapes. Without distributed load V' = 0 and V = −B s'', so the shear strain v' − s is constant over the
// element and equals −C_s B s''. With ξ = x/h and
//   P = (12/h²) C_s B  (the matrix Φ of Przemieniecki),   Q = (1 + P)⁻¹                                            (1)
// the solution through the end values q = (v₁, s₁, v₂, s₂) blends two sets of shapes,
//   v(ξ) = Σ_i [H_i(ξ) Q + L_i(ξ) (1 − Q)] q_i,    s(ξ) = Σ_i [H_i'(ξ)/h Q + l_i(ξ) (1 − Q)] q_i                   (2)
//   H = cubic Hermite,  L = {1−ξ, h(ξ−ξ²)/2, ξ, −h(ξ−ξ²)/2},  l = {0, 1−ξ, 0, ξ}:
// the first is the beam that cannot shear, the second the one that bends as if shear were free. All integrals are then
// 4×4 tables of numbers, joined with 2×2 matrices by Kronecker products; for planes that do not couple (I_yz = 0) this
// is the textbook element plane by plane.
//   K = k_H ⊗ BQ + k_L ⊗ B(1−Q),     BQ = (B⁻¹ + 12/h² C_s)⁻¹ symmetric                                            (3)
//   M = m h [HH ⊗ Q'Q + HL ⊗ Q'(1−Q) + (HL)' ⊗ (1−Q)'Q + LL ⊗ (1−Q)'(1−Q)] + rotary part, alike                    (4)
//
// High-order mass. By the Rayleigh quotient, the frequency error of a consistent element is the energy of what its
// shapes cannot follow: the deflection of the clamped-clamped element under its own inertia load p = λ m v, nearly
// constant over the element. Per unit p and plane its mean is h⁴/720EI + h²/12κGA = h⁴(1+5Φ)/720EI, therefore
//   λ_h = λ + λ² c + ...,   c = m h⁴ (1 + 5Φ) / (720 EI)       [slender: λ_h = λ (1 + (kh)⁴/720)]                   (5)
// for any end conditions, and 1/λ_h = 1/λ − c. Adding c K_e to M_e turns 1/λ_h into 1/λ_h + c = 1/λ + higher order.
// K_e R = 0, so rigid mass properties stay. The same for the axial bar, c = m h²/12EA, and for torsion, where
// (1/6)[2 1; 1 2] becomes (1/12)[5 1; 1 5]. What (5) leaves of shear and rotary inertia coupled is O((kr)⁴(kh)²),
// r the radius of gyration.
//
// Geometric stiffness. With ∫ H'L' = ∫ L'L' = G the axial force N does the second-order work of
//   K_σ = N/h [(hh − G) ⊗ Q'Q + G ⊗ 1]                                                                             (6)
// Released ends follow the others statically, u = T q (beam_releases.hpp): T'K T, T'M T and T'K_σ T.
namespace tenon::fem {
namespace {

using Mat2 = Eigen::Matrix2d;
using ShapeTable = Eigen::Matrix4d;  // over (v₁, h s₁, v₂, h s₂)

ShapeTable table(double scale, std::array<double, 16> rows) {
  return scale * Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
}

// ∫ over ξ in 0..1 of products of the shapes (2), lengths divided out.
const ShapeTable k_H = table(1.0, {12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4});  // H'' H''
const ShapeTable k_L = table(1.0, {0, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, -1, 0, 1});          // l' l'
const ShapeTable HH = table(1.0 / 420, {156, 22, 54, -13, 22, 4, 13, -3, 54, 13, 156, -22, -13, -3, -22, 4});
const ShapeTable HL = table(1.0 / 120, {42, 5, 18, -5, 6, 1, 4, -1, 18, 5, 42, -5, -4, -1, -6, 1});
const ShapeTable LL = table(1.0 / 120, {40, 5, 20, -5, 5, 1, 5, -1, 20, 5, 40, -5, -5, -1, -5, 1});
const ShapeTable hh = table(1.0 / 30, {36, 3, -36, 3, 3, 4, -3, -1, -36, -3, 36, -3, 3, -1, -3, 4});  // H' H'
const ShapeTable hl = table(1.0 / 12, {0, -6, 0, -6, 0, 1, 0, -1, 0, 6, 0, 6, 0, -1, 0, 1});          // H' l
const ShapeTable ll = table(1.0 / 6, {0, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 0, 0, 1, 0, 2});               // l l

const ShapeTable LsLs = table(1.0 / 12, {12, 0, -12, 0, 0, 1, 0, -1, -12, 0, 12, 0, 0, -1, 0, 1});  // G: L' L' = H' L'

/// A sum of Kronecker products Σ A ⊗ X with its transpose's terms in, over (v₁, h s₁, v₂, h s₂): 2×2 blocks i ≤ j.
class Transverse {
 public:
  /// += A ⊗ X, both symmetric
  void add(const ShapeTable& A, const Mat2& X) {
    for (int i = 0, n = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j, ++n) block_[static_cast<std::size_t>(n)] += A(i, j) * X;
  }
  /// += A ⊗ X + A' ⊗ X'
  void add_with_transpose(const ShapeTable& A, const Mat2& X) {
    const Mat2 Xt = X.transpose();
    for (int i = 0, n = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j, ++n) block_[static_cast<std::size_t>(n)] += A(i, j) * X + A(j, i) * Xt;
  }
  /// Onto the dofs of a 12×12 matrix: s = (r_z, −r_y), h s scaled to s.
  void place(Mat12& out, double h) const {
    static constexpr int dof[4][2] = {{1, 2}, {5, 4}, {7, 8}, {11, 10}};
    const double scale[4][2] = {{1.0, 1.0}, {h, -h}, {1.0, 1.0}, {h, -h}};
    for (int i = 0, n = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j, ++n)
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b)
            out(dof[i][a], dof[j][b]) = out(dof[j][b], dof[i][a]) =
                scale[i][a] * scale[j][b] * block_[static_cast<std::size_t>(n)](a, b);
  }

 private:
  std::array<Mat2, 10> block_{Mat2::Zero(), Mat2::Zero(), Mat2::Zero(), Mat2::Zero(), Mat2::Zero(),
                              Mat2::Zero(), Mat2::Zero(), Mat2::Zero(), Mat2::Zero(), Mat2::Zero()};
};

void add_bar(Mat12& out, int dof, double diagonal, double coupling) {
  out(dof, dof) += diagonal;
  out(dof + 6, dof + 6) += diagonal;
  out(dof, dof + 6) += coupling;
  out(dof + 6, dof) += coupling;
}

Mat2 symmetric(const Mat2& X) { return 0.5 * (X + X.transpose()); }

/// Bending and shear of a section over a length h, (1).
struct ShearBlend {
  Mat2 I, B, P, Q, PQ;  // PQ is 1 − Q, without cancellation
};

ShearBlend shear_blend(const BeamSection& section, const Material& material, double h) {
  const double GA = material.G * section.A;
  const Mat2 I = (Mat2() << section.Iz, section.Iyz, section.Iyz, section.Iy).finished();
  const Eigen::Vector2d C_s(section.kappa_y > 0.0 ? 1.0 / (section.kappa_y * GA) : 0.0,
                            section.kappa_z > 0.0 ? 1.0 / (section.kappa_z * GA) : 0.0);
  const Mat2 B = material.E * I;
  const Mat2 P = 12.0 / (h * h) * C_s.asDiagonal() * B;  // (1)
  const Mat2 Q = (Mat2::Identity() + P).inverse();
  return {I, B, P, Q, P * Q};
}

/// Stiffness in the element's axes, both ends joined.
Mat12 joined_stiffness(const BeamSection& section, const Material& material, const ShearBlend& blend, double h) {
  Mat12 K = Mat12::Zero();
  const double EA_h = material.E * section.A / h, GJ_h = material.G * section.J / h;
  add_bar(K, 0, EA_h, -EA_h);
  add_bar(K, 3, GJ_h, -GJ_h);
  Transverse k;
  k.add(k_H, symmetric(blend.B * blend.Q) / (h * h * h));  // (3)
  k.add(k_L, symmetric(blend.B * blend.PQ) / (h * h * h));
  k.place(K, h);
  return K;
}

bool released(const Beam& beam) { return (beam.releases[0] | beam.releases[1]) != 0; }

}  // namespace

void beam_matrices(const Beam& beam, const BeamSection& section, const Material& material, std::span<const Vec3> nodes,
                   ElementMatrices& out) {
  check_beam(beam, section, material);
  const BeamFrame frame(beam, nodes);
  const auto& [R, h] = frame;

  const double rho = material.rho;
  const ShearBlend blend = shear_blend(section, material, h);
  const auto& [I, B, P, Q, PQ] = blend;

  Mat12 K = joined_stiffness(section, material, blend, h), M = Mat12::Zero();
  Transverse m;
  const double mass = (rho * section.A + section.nsm) * h;       // [kg]
  const double torsional = rho * (section.Iy + section.Iz) * h;  // [kg m²]
  if (beam.mass == BeamMass::nastran) {
    add_bar(M, 0, mass * 5.0 / 12.0, mass / 12.0);
    m.add(HH, mass * Mat2::Identity());
  } else {
    const bool high = beam.mass == BeamMass::high_order;
    const double diagonal = high ? 5.0 / 12.0 : 1.0 / 3.0, coupling = high ? 1.0 / 12.0 : 1.0 / 6.0;
    add_bar(M, 0, mass * diagonal, mass * coupling);
    add_bar(M, 3, torsional * diagonal, torsional * coupling);
    m.add(HH, mass * Q.transpose() * Q);  // (4)
    m.add_with_transpose(HL, mass * Q.transpose() * PQ);
    m.add(LL, mass * PQ.transpose() * PQ);
    if (beam.rotary_inertia) {
      const Mat2 rho_I = rho / h * I;
      m.add(hh, Q.transpose() * rho_I * Q);
      m.add_with_transpose(hl, Q.transpose() * rho_I * PQ);
      m.add(ll, PQ.transpose() * rho_I * PQ);
    }
    if (high) {  // c K_e of (5), B cancelled: Q(1+5P) = 5 − 4Q and (1−Q)(1+5P) = 5P − 4(1−Q)
      m.add(k_H, mass / 720.0 * symmetric(5.0 * Mat2::Identity() - 4.0 * Q));
      m.add(k_L, mass / 720.0 * symmetric(5.0 * P - 4.0 * PQ));
    }
  }
  m.place(M, h);
  if (released(beam)) {
    const Release release = release_ends(beam, K);
    K = release.K;
    M = congruent(M, release.T);
  }

  const std::array<Vec3, 2> arms = frame.arms(beam);
  to_basic_frame<2>(K, R, arms, out.K);
  to_basic_frame<2>(M, R, arms, out.M);
}

void beam_geometric_stiffness(const Beam& beam, const BeamSection& section, const Material& material,
                              std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                              ElementMatrices::Matrix& out) {
  check_beam(beam, section, material);
  const BeamFrame frame(beam, nodes);
  const auto& [R, h] = frame;
  const ShearBlend blend = shear_blend(section, material, h);
  const Mat2& Q = blend.Q;
  Eigen::Matrix<double, 12, 1> ends = end_displacements(beam, frame, u);
  Mat12 T;
  if (released(beam)) {
    T = release_ends(beam, joined_stiffness(section, material, blend, h)).T;
    ends = (T * ends).eval();
  }
  const double N = material.E * section.A / h * (ends[6] - ends[0]);

  Mat12 K = Mat12::Zero();
  const double wagner = N / h * (section.Iy + section.Iz) / section.A;
  add_bar(K, 3, wagner, -wagner);
  Transverse k;
  k.add(hh - LsLs, N / h * Q.transpose() * Q);  // (6)
  k.add(LsLs, N / h * Mat2::Identity());
  k.place(K, h);
  if (released(beam)) K = congruent(K, T);
  const std::array<Vec3, 2> arms = frame.arms(beam);
  to_basic_frame<2>(K, R, arms, out);
}

}  // namespace tenon::fem
