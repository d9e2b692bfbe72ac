#include <Eigen/LU>

#include "fem/elements/basic_frame.hpp"
#include "fem/elements/quad4_geometry.hpp"
#include "fem/elements/shell.hpp"
#include "fem/elements/shell_theory.hpp"

// Natural coordinates r, s in −1..1; h = rs. The shape functions split into what linear fields see and an hourglass,
//
//   N_i = Δ_i + b_i x + c_i y + γ_i h,   γ_i = ¼ [h_i − (Σ h_j x_j) b_i − (Σ h_j y_j) c_i]                          (1)
//
// so ∇N_i = (b_i, c_i) + γ_i ∇h, and γ is blind to every linear field, whatever the quad's shape (Flanagan, Belytschko,
// IJNME 17 (1981) 679).
//
// Membrane: bilinear u, v with incompatible modes 1−r², 1−s² whose gradients are those of the centre scaled by j₀/j, so
// that constant stress does no work on them (Taylor, Beresford, Wilson, IJNME 10 (1976) 1211): in-plane bending exact
// in rectangles, patch test in any quad.
//
// Drilling, relative to the membrane's rotation ω = ½(v,x − u,y), never to ground (Hughes, Brezzi, CMAME 72 (1989)
// 105):
//
//   ½ G t A (θ̄ − ω̄)² + ½ α G t ∫ (θz − ω)² dA,   α = min(10⁻³, t²/A); bars are means over the element               (2)
//
// The means agree in linear fields and in in-plane bending, so their stiffness may have its natural size G t. It is
// needed where facets meet at an angle and bending moments pass as drilling ones: without it the twisted beam of
// MacNeal and Harder comes out 30 % soft. The second term keeps the other three θz patterns from being mechanisms and
// must be weak: over a curved surface the nodal rotation's part along each facet's normal varies with no strain in the
// shell, and α = 1 locks the thin hemisphere to a quarter of its deflection. t²/A keeps the term of the order of the
// bending energy, G t³ of a rotation's change over the element, however thin the shell. Drilling has no mass: it is
// condensed statically and however weak adds no mode.
//
// Plate: shell_theory.hpp. In a plane wave of the thin plate, w = exp i(ξx+ηy) on a lattice of a×b rectangles, the
// element's energy differs from the continuum's, D/2 (ξ²+η²)², by the second-order form
//
//   −½ D ξ²η² { q₁ (ξ²b² + η²a²) + [ν/6 + (1−ν)/2 (1/12 + q₂)] (ξ²a² + η²b²) },   q = ¼ (1 − f/3)                   (3)
//
// f being a factor on the energy of the hourglass part of κ_x, κ_y (f₁) and of κ_xy (f₂). With f = 1 it is too soft in
// oblique directions; f₁ = 3, f₂ = 4/(1−ν) make (3) vanish: fourth order where the mesh is rectangular and the edges
// are held, a smaller constant elsewhere. The energy to add is
//
//   D/(1+φ) { q_x² ∫h_x² + q_y² ∫h_y² + ¼(3+ν) ∫(q_x h_y + q_y h_x)² },   q_x = Σ γ_i β_xi,  q_y = Σ γ_i β_yi (4)
//
// zero for constant curvature by (1). Like the edge rotations it fades as φ → ∞, where plain MITC4 remains. (3) is that
// of isotropic plates: a laminate goes without (4).
namespace tenon::fem {
namespace {

using Mat2 = Eigen::Matrix2d;
using Mat4 = Eigen::Matrix4d;
using Column12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// Shape functions and metric at (r, s).
struct Point {
  Vec4 N, N_x, N_y;
  Mat2 J_inv;              ///< [r,x s,x; r,y s,y]
  Eigen::Vector2d grad_h;  ///< of h = rs
  double dA;               ///< j
};

Point at(const FlatQuad& q, double r, double s) {
  Point p;
  const Vec4 fr = Vec4::Ones() + r * corner_r, fs = Vec4::Ones() + s * corner_s;
  p.N = 0.25 * fr.cwiseProduct(fs);
  const Vec4 N_r = 0.25 * corner_r.cwiseProduct(fs), N_s = 0.25 * corner_s.cwiseProduct(fr);
  const double x_r = q.x.dot(N_r), x_s = q.x.dot(N_s), y_r = q.y.dot(N_r), y_s = q.y.dot(N_s);
  p.dA = x_r * y_s - x_s * y_r;
  p.J_inv << y_s, -y_r, -x_s, x_r;
  p.J_inv /= p.dA;
  p.N_x = p.J_inv(0, 0) * N_r + p.J_inv(0, 1) * N_s;
  p.N_y = p.J_inv(1, 0) * N_r + p.J_inv(1, 1) * N_s;
  p.grad_h = p.J_inv * Eigen::Vector2d(s, r);
  return p;
}

/// The 2×2 Gauss points, exact for everything here but the square of the linked deflection (fourth-order effect).
struct Points {
  Point centre;
  std::array<double, 4> r, s;
  std::array<Point, 4> gauss;
};

Points points(const FlatQuad& flat) {
  Points p;
  p.centre = at(flat, 0.0, 0.0);
  for (int g = 0; g < 4; ++g) {
    const auto k = static_cast<std::size_t>(g);
    p.r[k] = corner_r[g] / std::sqrt(3.0);
    p.s[k] = corner_s[g] / std::sqrt(3.0);
    p.gauss[k] = at(flat, p.r[k], p.s[k]);
  }
  return p;
}

using Strains2 = Eigen::Matrix<double, 3, 2>;
using Strains4 = Eigen::Matrix<double, 3, 4>;

/// What bending couples to: mean strain B₀ u, hourglass strains and incompatible modes at the Gauss points.
struct Membrane {
  Mat12 K;  ///< over (u v θz)
  Eigen::Matrix<double, 3, 12> B0 = decltype(B0)::Zero();
  Eigen::Matrix<double, 2, 12> q = decltype(q)::Zero();
  std::array<Strains2, 4> H;  ///< condensed: H − G (∫G'AG)⁻¹ ∫G'AH
  std::array<Strains4, 4> G;
  Mat4 GG_inverse;  ///< (∫G'AG)⁻¹
};

/// Stiffness over (u v θz). By (1) the strain is B₀ u + H q, q = (Σγ_i u_i, Σγ_i v_i), H = [h_x 0; 0 h_y; h_y h_x], and
/// with ∫H = ∫G = 0 (G: gradients of the incompatible modes) the condensed stiffness is
///   A B₀' D B₀ + q' S q,   S = ∫H'DH − ∫H'DG (∫G'DG)⁻¹ ∫G'DH
Membrane membrane_stiffness(const ShellTheory& theory, const Points& points, const Vec4& gamma) {
  const Mat3& D = theory.membrane;
  const auto strain = [](const Eigen::Vector2d& gradient) {
    return (Strains2() << gradient.x(), 0.0, 0.0, gradient.y(), gradient.y(), gradient.x()).finished();
  };
  Mat2 HH = Mat2::Zero();
  Eigen::Matrix<double, 2, 4> HG = Eigen::Matrix<double, 2, 4>::Zero();
  Mat4 GG = Mat4::Zero();
  Membrane m;
  for (std::size_t g = 0; g < 4; ++g) {
    const Point& p = points.gauss[g];
    const double scale = -2.0 * points.centre.dA / p.dA;
    const Strains2 H = strain(p.grad_h), DH = p.dA * D * H;
    m.G[g] << strain(scale * points.r[g] * points.centre.J_inv.col(0)),
        strain(scale * points.s[g] * points.centre.J_inv.col(1));
    m.H[g] = H;
    const Strains4 DG = p.dA * D * m.G[g];
    HH.noalias() += H.transpose() * DH;
    HG.noalias() += H.transpose() * DG;
    GG.noalias() += m.G[g].transpose() * DG;
  }
  m.GG_inverse = GG.inverse();
  const Eigen::Matrix<double, 4, 2> condensed = m.GG_inverse * HG.transpose();
  const Mat2 S = HH - HG * condensed;
  for (std::size_t g = 0; g < 4; ++g) m.H[g] -= m.G[g] * condensed;
  for (int i = 0; i < 4; ++i) {
    const double b = points.centre.N_x[i], c = points.centre.N_y[i];
    m.B0.block<3, 2>(0, 3 * i) << b, 0.0, 0.0, c, c, b;
    m.q(0, 3 * i) = m.q(1, 3 * i + 1) = gamma[i];
  }
  const Eigen::Matrix<double, 3, 12> DB = (4.0 * points.centre.dA * D).lazyProduct(m.B0);
  const Eigen::Matrix<double, 2, 12> Sq = S.lazyProduct(m.q);
  m.K = m.B0.transpose().lazyProduct(DB);
  m.K.noalias() += m.q.transpose().lazyProduct(Sq);
  return m;
}

/// With B ≠ 0 the incompatible modes a also follow bending: minimal over a, ∫ εᵀBκ + ½ εᵀAε is
///   uᵀ Σ (B₀ + H q)ᵀ B κ − ½ Pᵀ (∫G'AG)⁻¹ P,   P = ∫ G' B κ
/// `curvature`: κ at the Gauss points over (w θx θy).
Mat12 coupling_stiffness(const ShellTheory& theory, const Points& points, const Membrane& membrane,
                         const std::array<Eigen::Matrix<double, 12, 3>, 4>& curvature, Mat12& K_plate) {
  Mat12 K = Mat12::Zero();
  Eigen::Matrix<double, 12, 4> P = Eigen::Matrix<double, 12, 4>::Zero();
  for (std::size_t g = 0; g < 4; ++g) {
    const Eigen::Matrix<double, 12, 3> kB = curvature[g].lazyProduct(points.gauss[g].dA * theory.coupling);
    const Eigen::Matrix<double, 3, 12> strain = membrane.B0 + membrane.H[g].lazyProduct(membrane.q);
    K.noalias() += strain.transpose().lazyProduct(kB.transpose());
    P.noalias() += kB.lazyProduct(membrane.G[g]);
  }
  K_plate.noalias() -= Eigen::Matrix<double, 12, 4>(P.lazyProduct(membrane.GG_inverse)).lazyProduct(P.transpose());
  return K;
}

/// With u_corner + E (w θx θy) in place of the corners' (u v), `surface_terms`: the membrane and its coupling to
/// bending are carried to the plate and to what couples both. False for a flat quad.
bool add_surface_terms(const Quad4& quad, std::span<const Vec3> directors, const FlatQuad& flat,
                       const ShellTheory& theory, const Mat12& K_membrane, Mat12& K_plate, Mat12& K_coupling) {
  SurfaceTerms E;
  if (!surface_terms(quad, directors, flat, theory.thickness, E)) return false;
  if (!theory.coupled) K_coupling.setZero();
  Mat12 EtC = Mat12::Zero();  // over (w θx θy): Eᵀ (C + K E)
  Eigen::Matrix<double, 12, 8> K;
  for (int i = 0; i < 4; ++i) K.middleCols<2>(2 * i) = K_membrane.middleCols<2>(3 * i);
  if (theory.coupled) {
    for (int i = 0; i < 4; ++i)
      EtC.noalias() += E.middleRows<2>(2 * i).transpose().lazyProduct(K_coupling.middleRows<2>(3 * i));
    K_plate += EtC + EtC.transpose();
  }
  const Mat12 KE = K.lazyProduct(E);
  for (int i = 0; i < 4; ++i)
    K_plate.noalias() += E.middleRows<2>(2 * i).transpose().lazyProduct(KE.middleRows<2>(3 * i));
  K_coupling += KE;
  return true;
}

/// Energy (2), added over (u v θz).
void add_drilling(const ShellTheory& theory, const Points& points, Mat12& K) {
  const double area = 4.0 * points.centre.dA, t = theory.thickness, alpha = std::min(1e-3, t * t / area);
  Column12 mean = Column12::Zero();
  for (const Point& p : points.gauss) {
    Column12 relative;  // θz − ½ (v,x − u,y)
    for (int i = 0; i < 4; ++i) relative.segment<3>(3 * i) << 0.5 * p.N_y[i], -0.5 * p.N_x[i], p.N[i];
    K.noalias() += (alpha * theory.in_plane_shear * p.dA * relative) * relative.transpose();
    mean += p.dA * relative;
  }
  K.noalias() += (theory.in_plane_shear / area * mean) * mean.transpose();
}

/// Energy (4), added over (w θx θy).
void add_hourglass(const ShellTheory& theory, const Points& points, const Vec4& gamma, Mat12& K) {
  double xx = 0.0, yy = 0.0, xy = 0.0;  // ∫ ∇h ∇h'
  for (const Point& p : points.gauss) {
    xx += p.dA * p.grad_h.x() * p.grad_h.x();
    yy += p.dA * p.grad_h.y() * p.grad_h.y();
    xy += p.dA * p.grad_h.x() * p.grad_h.y();
  }
  const double area = 4.0 * points.centre.dA, D = theory.bending(0, 0);
  const double fade = theory.shear_rigid() ? 1.0 : 1.0 / (1.0 + 12.0 * D / (theory.shear(0, 0) * area));
  const double twist = 0.5 * (3.0 + theory.nu);
  const double k_xx = fade * D * (2.0 * xx + twist * yy), k_yy = fade * D * (2.0 * yy + twist * xx);
  const double k_xy = fade * D * twist * xy;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {  // β_x = θy, β_y = −θx
      const double gg = gamma[i] * gamma[j];
      K(3 * i + 2, 3 * j + 2) += gg * k_xx;
      K(3 * i + 1, 3 * j + 1) += gg * k_yy;
      K(3 * i + 2, 3 * j + 1) -= gg * k_xy;
      K(3 * i + 1, 3 * j + 2) -= gg * k_xy;
    }
}

/// The linked deflection's edge bubbles 4ξ(1−ξ) across the element and their derivatives; edges 1-2, 2-3, 3-4, 4-1.
struct Bubbles {
  std::array<double, 4> P, P_r, P_s;
};

Bubbles bubbles(double r, double s) {
  const double br = 1.0 - r * r, bs = 1.0 - s * s;
  return {{0.5 * br * (1.0 - s), 0.5 * bs * (1.0 + r), 0.5 * br * (1.0 + s), 0.5 * bs * (1.0 - r)},
          {-r * (1.0 - s), 0.5 * bs, -r * (1.0 + s), -0.5 * bs},
          {-0.5 * br, -s * (1.0 + r), 0.5 * br, -s * (1.0 - r)}};
}

/// Stiffness and mass over (w θx θy), and the curvatures at the Gauss points; `NN` is ∫ N_i N_j dA.
void plate(const ShellTheory& theory, const FlatQuad& flat, const Points& points, const Vec4& gamma, const Mat4& NN,
           Mat12& K, Mat12& M, std::array<Eigen::Matrix<double, 12, 3>, 4>& curvature) {
  std::array<PlateEdge, 4> edge;
  for (int k = 0; k < 4; ++k) {
    const int j = (k + 1) % 4;
    edge[static_cast<std::size_t>(k)] = plate_edge(theory, flat.x[j] - flat.x[k], flat.y[j] - flat.y[k]);
  }
  K.setZero();
  M.setZero();
  for (std::size_t g = 0; g < 4; ++g) {
    const Point& p = points.gauss[g];
    const double r = points.r[g], s = points.s[g];
    Eigen::Matrix<double, 12, 3>& B = curvature[g];  // columns: curvatures
    B.setZero();
    Eigen::Matrix<double, 12, 2> natural = Eigen::Matrix<double, 12, 2>::Zero();  // γ_r, γ_s
    Column12 w = Column12::Zero();                                                // linked deflection
    for (int i = 0; i < 4; ++i) {
      B(3 * i + 2, 0) = p.N_x[i];
      B(3 * i + 1, 1) = -p.N_y[i];
      B(3 * i + 1, 2) = -p.N_x[i];
      B(3 * i + 2, 2) = p.N_y[i];
      w[3 * i] = p.N[i];
    }
    // the edges' bubbles and the MITC4 weights of their shears, ½(1 ± s)/2
    const auto [P, P_r, P_s] = bubbles(r, s);
    const std::array<double, 4> tie{0.25 * (1.0 - s), 0.25 * (1.0 + r), -0.25 * (1.0 + s), -0.25 * (1.0 - r)};
    for (std::size_t k = 0; k < 4; ++k) {
      const PlateEdge& e = edge[k];
      const int i = static_cast<int>(k), j = (i + 1) % 4;
      const double P_x = p.J_inv(0, 0) * P_r[k] + p.J_inv(0, 1) * P_s[k];
      const double P_y = p.J_inv(1, 0) * P_r[k] + p.J_inv(1, 1) * P_s[k];
      const Vec3 kappa(P_x * e.c_dbeta, P_y * e.s_dbeta, P_y * e.c_dbeta + P_x * e.s_dbeta);
      add_g(B, kappa, e, i, j);
      add_g(natural.col(i % 2), Eigen::Matrix<double, 1, 1>(tie[k] * e.shear), e, i, j);
      add_link(w, P[k], e, i, j);
    }
    const Eigen::Matrix<double, 12, 3> BD = B.lazyProduct(p.dA * theory.bending);
    const Eigen::Matrix<double, 12, 2> shear = natural.lazyProduct(p.J_inv.transpose());
    K.noalias() += BD.lazyProduct(B.transpose());
    K.noalias() += Eigen::Matrix<double, 12, 2>(shear.lazyProduct(p.dA * theory.shear)).lazyProduct(shear.transpose());
    M.noalias() += (p.dA * theory.mass * w) * w.transpose();
  }
  if (theory.isotropic) add_hourglass(theory, points, gamma, K);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int a = 1; a < 3; ++a) M(3 * i + a, 3 * j + a) += theory.rotary * NN(i, j);
}

ShellTheory theory_of(const Quad4& quad, const ShellSection& section, const Material& material,
                      std::span<const Vec3> nodes, const FlatQuad& flat) {
  const auto at = [&](std::size_t i) -> const Vec3& { return nodes[static_cast<std::size_t>(quad.nodes[i])]; };
  return shell_theory(section, material, quad.material_axis, at(1) - at(0), flat.R, "quad", quad.id);
}

}  // namespace

void quad4_matrices(const Quad4& quad, const ShellSection& section, const Material& material,
                    std::span<const Vec3> nodes, ElementMatrices& out, std::span<const Vec3> directors) {
  const FlatQuad flat = flat_quad(quad, nodes);
  const ShellTheory theory = theory_of(quad, section, material, nodes, flat);
  const Points gauss = points(flat);

  Mat4 NN = Mat4::Zero();
  for (const Point& p : gauss.gauss) NN.noalias() += p.dA * p.N * p.N.transpose();
  const Point& centre = gauss.centre;
  const Vec4 gamma = 0.25 * (corner_h - corner_h.dot(flat.x) * centre.N_x - corner_h.dot(flat.y) * centre.N_y);  // (1)
  Membrane membrane = membrane_stiffness(theory, gauss, gamma);
  add_drilling(theory, gauss, membrane.K);
  Mat12 K_plate, M_plate, K_coupling;
  std::array<Eigen::Matrix<double, 12, 3>, 4> curvature;
  plate(theory, flat, gauss, gamma, NN, K_plate, M_plate, curvature);
  if (theory.coupled) K_coupling = coupling_stiffness(theory, gauss, membrane, curvature, K_plate);

  std::array<Vec3, 4> arms = flat.arms;
  for (Vec3& arm : arms) arm.z() += quad.offset;
  const bool curved = add_surface_terms(quad, directors, flat, theory, membrane.K, K_plate, K_coupling);
  shell_to_basic_frame<4>(membrane.K, K_plate, flat.R, arms, out.K, theory.coupled || curved ? &K_coupling : nullptr);
  Mat12 M_membrane = Mat12::Zero();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) M_membrane(3 * i, 3 * j) = M_membrane(3 * i + 1, 3 * j + 1) = theory.mass * NN(i, j);
  for (Vec3& arm : arms) arm.z() += theory.mass_height;
  shell_to_basic_frame<4>(M_membrane, M_plate, flat.R, arms, out.M);
}

void quad4_geometric_stiffness(const Quad4& quad, const ShellSection& section, const Material& material,
                               std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                               ElementMatrices::Matrix& out, std::span<const Vec3> directors) {
  const FlatQuad flat = flat_quad(quad, nodes);
  const ShellTheory theory = theory_of(quad, section, material, nodes, flat);
  const Points gauss = points(flat);
  std::array<Vec3, 4> arms = flat.arms;
  for (Vec3& arm : arms) arm.z() += quad.offset;

  Eigen::Matrix<double, 8, 1> in_plane;
  Column12 bending;  // (w θx θy)
  std::array<PlateEdge, 4> edge;
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const int j = (i + 1) % 4;
    const Vec3 turn = flat.R.transpose() * u.segment<3>(6 * i + 3);
    const Vec3 corner = flat.R.transpose() * u.segment<3>(6 * i) + turn.cross(arms[k]);
    in_plane.segment<2>(2 * i) = corner.head<2>();
    bending.segment<3>(3 * i) << corner.z(), turn.x(), turn.y();
    edge[k] = plate_edge(theory, flat.x[j] - flat.x[i], flat.y[j] - flat.y[i]);
  }
  if (SurfaceTerms E; surface_terms(quad, directors, flat, theory.thickness, E)) in_plane += E * bending;
  Vec3 strain = Vec3::Zero(), curvature = Vec3::Zero();  // the element's means, B₀ u and ∮ β n ds / area
  for (int i = 0; i < 4; ++i) {
    const double b = gauss.centre.N_x[i], c = gauss.centre.N_y[i], u_i = in_plane[2 * i], v_i = in_plane[2 * i + 1];
    strain += Vec3(b * u_i, c * v_i, c * u_i + b * v_i);
  }
  for (int i = 0; i < 4; ++i)
    curvature += edge_bending(edge[static_cast<std::size_t>(i)], bending.segment<3>(3 * i),
                              bending.segment<3>(3 * ((i + 1) % 4))) /
                 (4.0 * gauss.centre.dA);
  const Mat2 N = stress_resultants(theory, strain, curvature);
  Mat12 K_membrane = Mat12::Zero(), K_plate = Mat12::Zero();
  for (std::size_t g = 0; g < 4; ++g) {
    const Point& p = gauss.gauss[g];
    const Bubbles bubble = bubbles(gauss.r[g], gauss.s[g]);
    Eigen::Matrix<double, 12, 2> w = Eigen::Matrix<double, 12, 2>::Zero();  // columns: w,x w,y
    for (int i = 0; i < 4; ++i) {
      w(3 * i, 0) = p.N_x[i];
      w(3 * i, 1) = p.N_y[i];
    }
    add_in_plane(K_membrane, w, p.dA * N);
    for (int i = 0; i < 4; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector2d gradient = p.J_inv * Eigen::Vector2d(bubble.P_r[k], bubble.P_s[k]);
      for (int a = 0; a < 2; ++a) add_link(w.col(a), gradient[a], edge[k], i, (i + 1) % 4);
    }
    K_plate.noalias() += Eigen::Matrix<double, 12, 2>(w.lazyProduct(p.dA * N)).lazyProduct(w.transpose());
  }
  shell_to_basic_frame<4>(K_membrane, K_plate, flat.R, arms, out);
}

}  // namespace tenon::fem
