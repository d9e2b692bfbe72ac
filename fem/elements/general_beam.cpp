#include "fem/elements/general_beam.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "fem/elements/basic_frame.hpp"
#include "fem/elements/beam_frame.hpp"
#include "fem/elements/beam_releases.hpp"

// The beam in its own axes, x from end 1 to end 2, both at the centroid; displacements and forces at the centroid.
//
// A load p on end 2, end 1 being clamped, meets section s with the forces
//   D = (N, V_y, V_z, T, M_y, M_z) = S(s) W(h − s) p,     W(δ) = τ(−δ x̂)'  carries a wrench back by δ              (1)
// where S moves the torque to the shear centre c: T = m_x − c_y f_z + c_z f_y. The section answers with the strains
//   f D,  f = diag(1/EA, 1/κ_y GA, 1/κ_z GA, 1/GJ, [I_y −I_yz; −I_yz I_z]⁻¹/E) (2)
// and with q(s) = S' f S W(h − s), the displacement at x of the load p is, W(x − s) being linear in x,
//   G(x) p = ∫₀ˣ W(x − s)' q ds p = [I₀ + E'(x I₀ − I₁)] p,   I₀ = ∫₀ˣ q ds,  I₁ = ∫₀ˣ s q ds,  W(δ) = 1 + δ E      (3)
//   G'(x) = q + E' I₀
// With Γ = [−τ(h x̂) 1], the motion of end 2 beyond that of a rigid beam,
//   K = Γ' G(h)⁻¹ Γ,     u(x) = N(x) u_e,  N = [τ(x x̂) 0] + G(x) G(h)⁻¹ Γ                                           (4)
//   M = ∫ N' m N dx,     m the 6×6 mass of the section about its centroid, non-structural mass at its own centre (5)
//
// High-order mass adds (5) of beam.cpp, λ c times the energy of each part, point by point: with m the mass and I_p the
// polar inertia per length,
//   c = m h²/12EA in tension,   c = m h⁴/720 (B⁻¹ + 60 C_s/h²) in bending and shear,                                (6)
// and in torsion, about a shear centre at a from which the centroid moves by v_c = v_s + a φ,
//   (h²/12) φ' (I_p φ' + m a · v_c') .                                                                            (7)
namespace tenon::fem {
namespace {

using Mat612 = Eigen::Matrix<double, 6, 12>;
using Row12 = Eigen::Matrix<double, 1, 12>;

template <std::size_t n>
struct GaussRule {
  std::array<double, n> at, weight;  ///< on 0..1
};

constexpr GaussRule<4> gauss4{{0.069431844202973714, 0.33000947820757187, 0.66999052179242813, 0.93056815579702623},
                              {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}};
constexpr GaussRule<8> gauss8{{0.019855071751231884, 0.10166676129318664, 0.23723379504183550, 0.40828267875217510,
                               0.59171732124782490, 0.76276620495816450, 0.89833323870681336, 0.98014492824876812},
                              {0.050614268145188130, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
                               0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.050614268145188130}};

constexpr std::size_t max_pieces = 16;

/// x-sections at which the mass is summed.
struct MassPoint {
  double x = 0.0, weight = 0.0;  ///< [m], weight with dx in
  std::size_t piece = 0;
  Mat6 G, slope;  ///< G(x), G'(x) of (3)
  Mat6 S;
};

Mat6 shear_centre(const BeamSection& s) {
  Mat6 S = Mat6::Identity();
  S(3, 2) = -s.shear_y;
  S(3, 1) = s.shear_z;
  return S;
}

/// W(δ)
Mat6 carried_back(double distance) { return tau(Vec3(distance, 0.0, 0.0)).transpose(); }

/// E' A
Mat6 transposed_lever(const Mat6& A) {
  Mat6 X = Mat6::Zero();
  X.row(1) = A.row(5);
  X.row(2) = -A.row(4);
  return X;
}

class GeneralBeam {
 public:
  GeneralBeam(const Beam& beam, const SectionLine& line, const Material& material, double length)
      : beam_(beam), line_(line), material_(material), h_(length) {
    for (std::size_t k = 0; k <= (line.uniform() ? 0 : line.pieces()); ++k) check(line.section(k));
    if (line.pieces() > max_pieces)
      refuse_beam(beam, fmt::format("{} stations along it, at most {} are read", line.pieces() + 1, max_pieces + 1),
                  "Cut it into several elements");
    // fields of a uniform beam are cubic: four points integrate their squares exactly
    line.uniform() ? integrate(gauss4) : integrate(gauss8);
    gamma_ << -tau(Vec3(h_, 0.0, 0.0)), Mat6::Identity();
    end_force_ = G_h_.partialPivLu().solve(gamma_);
  }

  Mat12 stiffness() const {
    Mat612 force = end_force_;
    if (!twists_) force.row(3).setZero();  // its unit flexibility only shaped φ
    const Mat12 K = gamma_.transpose() * force;
    return 0.5 * (K + K.transpose());
  }

  Mat12 mass() {
    Mat12 M = Mat12::Zero();
    for (std::size_t i = 0; i < points_; ++i) {
      const MassPoint& p = point_[i];
      line_.at(p.piece, p.x / h_, section_);
      const Mat612 N = shapes(p);
      M.noalias() += p.weight * N.transpose() * (section_mass() * N).eval();
      if (beam_.mass != BeamMass::consistent) add_high_order(p, M);
    }
    return M;
  }

  /// N ∫ (v_c' v_c'ᵀ + (Iy + Iz)/A φ' φ'ᵀ) dx of the axial force N
  Mat12 geometric_stiffness(double axial_force) {
    Mat12 K = Mat12::Zero();
    for (std::size_t i = 0; i < points_; ++i) {
      const MassPoint& p = point_[i];
      line_.at(p.piece, p.x / h_, section_);
      const Mat612 slope = slopes(p);
      const double wagner = (section_.Iy + section_.Iz) / section_.A;
      K += axial_force * p.weight *
           (slope.middleRows<2>(1).transpose() * slope.middleRows<2>(1) +
            wagner * slope.row(3).transpose() * slope.row(3));
    }
    return K;
  }

  /// The axial force per unit of each end displacement.
  Row12 axial_force() const { return end_force_.row(0); }

 private:
  void check(const BeamSection& s) {
    check_beam(beam_, s, material_);
    if (!(s.Iy * s.Iz - s.Iyz * s.Iyz > 1e-14 * s.Iy * s.Iz))
      refuse_beam(beam_, fmt::format("section '{}' does not resist bending in every direction", s.name),
                  "A section that varies, or with its shear centre or mass off the centroid, needs Iy Iz > Iyz²");
    if (s.J > 0.0) return;
    twists_ = false;
    if (s.shear_y != 0.0 || s.shear_z != 0.0)
      refuse_beam(beam_,
                  fmt::format("section '{}' has a shear centre off its centroid and no torsional stiffness", s.name),
                  "Give J > 0");
  }

  /// f of (2)
  Mat6 flexibility() const {
    const BeamSection& s = section_;
    const double GA = material_.G * s.A, E = material_.E, det = s.Iy * s.Iz - s.Iyz * s.Iyz;
    Mat6 f = Mat6::Zero();
    f(0, 0) = 1.0 / (E * s.A);
    f(1, 1) = s.kappa_y > 0.0 ? 1.0 / (s.kappa_y * GA) : 0.0;
    f(2, 2) = s.kappa_z > 0.0 ? 1.0 / (s.kappa_z * GA) : 0.0;
    f(3, 3) = twists_ ? 1.0 / (material_.G * s.J) : 1.0 / (E * s.Iz);  // without stiffness: any, φ is linear
    f(4, 4) = s.Iz / (E * det);
    f(5, 5) = s.Iy / (E * det);
    f(4, 5) = f(5, 4) = s.Iyz / (E * det);
    return f;
  }

  /// q of (3) at x
  Mat6 strain(std::size_t piece, double x) {
    line_.at(piece, x / h_, section_);
    const Mat6 S = shear_centre(section_);
    return S.transpose() * flexibility() * S * carried_back(h_ - x);
  }

  template <std::size_t n>
  void integrate(const GaussRule<n>& rule) {
    Mat6 I0 = Mat6::Zero(), I1 = Mat6::Zero();
    double x = 0.0;
    const auto advance = [&](std::size_t piece, double to) {
      for (std::size_t k = 0; k < n; ++k) {
        const double s = x + rule.at[k] * (to - x);
        const Mat6 q = rule.weight[k] * (to - x) * strain(piece, s);
        I0 += q;
        I1 += s * q;
      }
      x = to;
    };
    for (std::size_t piece = 0; piece < line_.pieces(); ++piece) {
      const double from = h_ * line_.begin(piece), to = h_ * line_.begin(piece + 1);
      for (std::size_t g = 0; g < n; ++g) {
        advance(piece, from + rule.at[g] * (to - from));
        MassPoint& p = point_[points_++];
        p.x = x;
        p.weight = rule.weight[g] * (to - from);
        p.piece = piece;
        p.G = I0 + transposed_lever(x * I0 - I1);
        p.slope = strain(piece, x) + transposed_lever(I0);
        p.S = shear_centre(section_);
      }
      advance(piece, to);
    }
    G_h_ = I0 + transposed_lever(x * I0 - I1);
  }

  /// N of (4), and its derivative
  Mat612 shapes(const MassPoint& p) const {
    Mat612 N = p.G * end_force_;
    N.leftCols<6>() += tau(Vec3(p.x, 0.0, 0.0));
    return N;
  }
  Mat612 slopes(const MassPoint& p) const {
    Mat612 slope = p.slope * end_force_;
    slope(1, 5) += 1.0;
    slope(2, 4) -= 1.0;
    return slope;
  }

  /// m of (5)
  Mat6 section_mass() const {
    const BeamSection& s = section_;
    const double rho = material_.rho;
    Mat6 m = Mat6::Zero();
    m.diagonal().head<3>().setConstant(rho * s.A);
    if (beam_.mass != BeamMass::nastran) {
      m(3, 3) = rho * (s.Iy + s.Iz);
      if (beam_.rotary_inertia) {
        m(4, 4) = rho * s.Iy;
        m(5, 5) = rho * s.Iz;
        m(4, 5) = m(5, 4) = -rho * s.Iyz;
      }
    }
    if (s.nsm > 0.0) m += rigid_mass(s.nsm, Vec3(0.0, s.nsm_y, s.nsm_z), Mat3::Zero());
    return m;
  }

  /// (6), (7)
  void add_high_order(const MassPoint& p, Mat12& M) const {
    const BeamSection& s = section_;
    const double m = material_.rho * s.A + s.nsm, I_p = material_.rho * (s.Iy + s.Iz);
    const Mat6 f = flexibility();
    const Mat612 D = p.S * carried_back(h_ - p.x) * end_force_;
    const auto add = [&](double c, const Row12& a, const Row12& b) {
      M += (0.5 * c * p.weight) * (a.transpose() * b + b.transpose() * a);
    };
    const double second = h_ * h_ / 12.0, fourth = m * std::pow(h_, 4) / 720.0;
    add(second * m, f(0, 0) * D.row(0), f(0, 0) * D.row(0));
    if (beam_.mass == BeamMass::nastran) return;

    const Mat612 slope = slopes(p);
    const Row12 twist = f(3, 3) * D.row(3);
    add(second * I_p, twist, twist);
    // the centroid from the shear centre is −c: v_c = v_s + (c_z, −c_y) φ
    add(second * m * s.shear_z, twist, slope.row(1));
    add(-second * m * s.shear_y, twist, slope.row(2));

    // planes (y, r_z) and (z, −r_y), as in beam.cpp
    using Mat212 = Eigen::Matrix<double, 2, 12>;
    Mat212 moment, force;
    moment << D.row(5), -D.row(4);
    force << D.row(1), D.row(2);
    Eigen::Matrix2d compliance;  // B⁻¹
    compliance << f(5, 5), -f(4, 5), -f(4, 5), f(4, 4);
    const Eigen::Matrix2d C_s = Eigen::Vector2d(f(1, 1), f(2, 2)).asDiagonal();
    const Eigen::Matrix2d c = fourth * (compliance + 60.0 / (h_ * h_) * C_s);
    const auto energy = [&](const Eigen::Matrix2d& of, const Mat212& a) -> Mat12 {
      const Eigen::Matrix2d X = 0.5 * (of * c + c * of);
      return p.weight * a.transpose() * (X * a).eval();
    };
    M += energy(compliance, moment) + energy(C_s, force);
  }

  const Beam& beam_;
  const SectionLine& line_;
  const Material& material_;
  double h_;
  BeamSection section_;  ///< where the integration stands
  bool twists_ = true;   ///< J > 0
  std::array<MassPoint, 8 * max_pieces> point_;
  std::size_t points_ = 0;
  Mat6 G_h_;
  Mat612 gamma_, end_force_;
};

}  // namespace

void general_beam_matrices(const Beam& beam, const SectionLine& line, const Material& material,
                           std::span<const Vec3> nodes, ElementMatrices& out) {
  const BeamFrame frame(beam, nodes);
  GeneralBeam general(beam, line, material, frame.h);
  Mat12 K = general.stiffness(), M = general.mass();
  if ((beam.releases[0] | beam.releases[1]) != 0) {
    const Release release = release_ends(beam, K);
    K = release.K;
    M = congruent(M, release.T);
  }
  const std::array<Vec3, 2> arms = frame.arms(beam);
  to_basic_frame<2>(K, frame.R, arms, out.K);
  to_basic_frame<2>(M, frame.R, arms, out.M);
}

void general_beam_geometric_stiffness(const Beam& beam, const SectionLine& line, const Material& material,
                                      std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                                      ElementMatrices::Matrix& out) {
  const BeamFrame frame(beam, nodes);
  GeneralBeam general(beam, line, material, frame.h);
  Eigen::Matrix<double, 12, 1> ends = end_displacements(beam, frame, u);
  Mat12 T = Mat12::Identity();
  const bool released = (beam.releases[0] | beam.releases[1]) != 0;
  if (released) {
    T = release_ends(beam, general.stiffness()).T;
    ends = (T * ends).eval();
  }
  Mat12 K = general.geometric_stiffness(general.axial_force().dot(ends.transpose()));
  if (released) K = congruent(K, T);
  to_basic_frame<2>(K, frame.R, frame.arms(beam), out);
}

}  // namespace tenon::fem
