#pragma once

#include <array>
#include <string>
#include <string_view>

#include "fem/elements/basic_frame.hpp"
#include "fem/model.hpp"

/// What the quadrilateral and the triangle share. Element axes x, y in the plane, z normal; node dofs
/// [u v w θx θy θz]; the normal's rotations β_x = θy, β_y = −θx, so that a point at z moves by (zβ_x, zβ_y).
///   membrane strain  ε = (u,x  v,y  u,y + v,x),   curvature  κ = (β_x,x  β_y,y  β_x,y + β_y,x),
///   shear  γ = (w,x + β_x, w,y + β_y).
///
/// Bending of an edge from node i to node j, length l, tangent (c, s), β_t = c β_x + s β_y: beside its linear part β_t
/// carries Δβ 4ξ(1−ξ), and its shear is constant, γ̄. Compatibility of w along the edge and M_t' = V of a plate strip
/// say
///   g + (2/3) l Δβ = l γ̄,   g = w_j − w_i + (l/2)(β_ti + β_tj)                                                     (1)
///   γ̄ = −(2/3) φ Δβ,        φ = 12 D / (κ G t l²), both along the edge                                             (2)
/// so that  l γ̄ = g φ/(1+φ)  and  Δβ = −(3/2l) g/(1+φ)                                                              (3)
/// Thick (φ → ∞): no edge rotation, and γ̄ tied to the element by MITC interpolation is MITC4 / MITC3 itself. Thin
/// (φ → 0): γ̄ → 0 on each edge without a penalty, nothing locks and no stiffness grows as 1/t². A strip of such
/// elements is the exact Timoshenko beam, whose Φ the φ is. Source: Katili, IJNME 36 (1993) 1859, 1885 (DKMT, DKMQ);
/// MITC4: Bathe, Dvorkin, IJNME 21 (1985) 367; MITC3: Lee, Bathe, Comput. Struct. 82 (2004) 945.
///
/// Mass: u, v linear or bilinear; w by linked interpolation, linear plus on each edge 4ξ(1−ξ) (l/8)(β_tj − β_ti),
/// what (1) says of a bent edge without net shear. Rigid motions have β_tj = β_ti: their masses stay exact.
namespace tenon::fem {

/// The shell's section stiffnesses and masses per unit area. Element axes: N = A ε + B κ, M = B ε + D κ, Q = S γ.
struct ShellTheory {
  Mat3 membrane;          ///< A; t C, C plane stress [N/m]
  Mat3 coupling;          ///< B [N]
  Mat3 bending;           ///< D; (12I/t³) t³/12 C [N m]
  Eigen::Matrix2d shear;  ///< S; κ G t [N/m]; 0 stands for rigid in shear
  Mat3 bending_free;      ///< D − B A⁻¹ B: bending without membrane force [N m]
  double in_plane_shear;  ///< G t, of a laminate the mean over all directions [N/m]
  double nu;              ///< ν, of a laminate A12 / √(A11 A22)
  double thickness;       ///< [m]
  double mass;            ///< ρ t + nsm [kg/m²]
  double rotary;          ///< ρ t³/12, about the mass's own height [kg]
  double mass_height;     ///< of the centre of mass above the middle surface [m]
  bool coupled = false;   ///< B ≠ 0
  bool isotropic = true;

  bool shear_rigid() const { return !(shear(0, 0) > 0.0); }
};

/// In the section's own axes. `kind` and `id` name the element in messages.
/// @throws ModelError for values no shell can have
ShellTheory shell_theory(const ShellSection& section, const Material& material, std::string_view kind, long id);

/// The same in an element's axes R: direction 1 of a laminate is the projection of `material_axis`, or with a zero one
/// of `side`, from node 1 to node 2 (both in the basic frame). @throws ModelError where that has none
ShellTheory shell_theory(const ShellSection& section, const Material& material, const Vec3& material_axis,
                         const Vec3& side, const Mat3& R, std::string_view kind, long id);

/// An edge's part in bending and shear, (1)–(3).
struct PlateEdge {
  double dx, dy;   ///< l c, l s [m]
  double shear;    ///< l γ̄ / g = φ/(1+φ)
  double c_dbeta;  ///< c Δβ / g [1/m]
  double s_dbeta;  ///< s Δβ / g [1/m]
};

PlateEdge plate_edge(const ShellTheory& theory, double dx, double dy);

/// ∫ (β_x n_x, β_y n_y, β_x n_y + β_y n_x) ds [m] over the edge from i to j, n outwards when edges run
/// counterclockwise: their sum over an element is its mean curvature times its area. `i`, `j`: (w θx θy).
Vec3 edge_bending(const PlateEdge& edge, const Vec3& i, const Vec3& j);

/// Columns += g' factors, g of the edge from i to j over the dofs (w θx θy).
template <typename Columns, typename Factors>
void add_g(Columns&& columns, const Factors& factors, const PlateEdge& e, int i, int j) {
  for (int a = 0; a < factors.size(); ++a) {
    const double f = factors[a], f_x = 0.5 * f * e.dx, f_y = 0.5 * f * e.dy;
    columns(3 * i, a) -= f;
    columns(3 * i + 1, a) -= f_y;
    columns(3 * i + 2, a) += f_x;
    columns(3 * j, a) += f;
    columns(3 * j + 1, a) -= f_y;
    columns(3 * j + 2, a) += f_x;
  }
}

/// w += P (l/8)(β_tj − β_ti), the linked deflection of the edge from i to j.
template <typename Column>
void add_link(Column&& w, double P, const PlateEdge& e, int i, int j) {
  const double f_x = 0.125 * P * e.dx, f_y = 0.125 * P * e.dy;
  w[3 * i + 1] += f_y;
  w[3 * i + 2] -= f_x;
  w[3 * j + 1] -= f_y;
  w[3 * j + 2] += f_x;
}

/// [N_x N_xy; N_xy N_y] of a membrane strain and a curvature [N/m].
inline Eigen::Matrix2d stress_resultants(const ShellTheory& theory, const Vec3& strain, const Vec3& curvature) {
  const Vec3 N = theory.membrane * strain + theory.coupling * curvature;
  return (Eigen::Matrix2d() << N[0], N[2], N[2], N[1]).finished();
}

/// K += ∇u N ∇uᵀ + ∇v N ∇vᵀ over (u v θz), the gradients of both being those of w over (w θx θy): rows 3i.
template <typename Square, typename Gradients>
void add_in_plane(Square& K, const Gradients& gradients, const Eigen::Matrix2d& N) {
  for (int j = 0; j < gradients.rows(); j += 3)
    for (int i = 0; i < gradients.rows(); i += 3) {
      const double k = gradients.row(i).dot(N * gradients.row(j).transpose());
      K(i, j) += k;
      K(i + 1, j + 1) += k;
    }
}

/// A membrane matrix over (u v θz) and a plate matrix over (w θx θy) as one, with `coupling` between the two if there
/// is one.
template <int N>
Eigen::Matrix<double, 6 * N, 6 * N> join_shell(const Eigen::Matrix<double, 3 * N, 3 * N>& membrane,
                                               const Eigen::Matrix<double, 3 * N, 3 * N>& plate,
                                               const Eigen::Matrix<double, 3 * N, 3 * N>* coupling = nullptr) {
  static constexpr std::array<int, 3> in_plane{0, 1, 5}, across{2, 3, 4};
  Eigen::Matrix<double, 6 * N, 6 * N> local = Eigen::Matrix<double, 6 * N, 6 * N>::Zero();
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i)
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) {
          const auto ka = static_cast<std::size_t>(a), kb = static_cast<std::size_t>(b);
          local(6 * i + in_plane[ka], 6 * j + in_plane[kb]) = membrane(3 * i + a, 3 * j + b);
          local(6 * i + across[ka], 6 * j + across[kb]) = plate(3 * i + a, 3 * j + b);
          if (coupling)
            local(6 * j + across[kb], 6 * i + in_plane[ka]) = local(6 * i + in_plane[ka], 6 * j + across[kb]) =
                (*coupling)(3 * i + a, 3 * j + b);
        }
  return local;
}

/// The same carried to the basic frame.
template <int N>
void shell_to_basic_frame(const Eigen::Matrix<double, 3 * N, 3 * N>& membrane,
                          const Eigen::Matrix<double, 3 * N, 3 * N>& plate, const Mat3& R,
                          const std::array<Vec3, N>& arms, ElementMatrices::Matrix& out,
                          const Eigen::Matrix<double, 3 * N, 3 * N>* coupling = nullptr) {
  to_basic_frame<N>(join_shell<N>(membrane, plate, coupling), R, arms, out);
}

}  // namespace tenon::fem
