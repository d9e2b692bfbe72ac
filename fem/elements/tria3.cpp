#include <fmt/format.h>

#include <Eigen/LU>

#include "fem/elements/basic_frame.hpp"
#include "fem/elements/shell.hpp"
#include "fem/elements/shell_shape.hpp"
#include "fem/elements/shell_theory.hpp"
#include "fem/error.hpp"

// Membrane: the optimal ANDES triangle with drilling rotations of Felippa, CMAME 192 (2003) 2125:
//   K = (1/V) L C L' + ¾ β₀ T' K_θ T                                                                               (1)
// L lumps a constant stress to node forces and moments (α_b = 3/2), T takes the node displacements to the hierarchical
// rotations, K_θ is the energy of three linear natural-strain fields. Bending of a rectangle cut into two triangles is
// exact for any aspect ratio. The rotations are real stiffness, so no drilling term is needed.
// Curved shells. Bending without membrane strain turns the surface by a field θ whose gradient is tangential,
// n·∂θ = 0, and moves it by u_j − u_i = ∫ θ × dx along the surface. With θ and the normals' tilt m, their part in the
// facet, both linear in it, â = a − ā what a differs from its mean by, an edge of length l and tangent t, q = n × t:
//
//   θz_i = θz₀ − ½ θ̂_i·(m_i + m̄)                                                                 (2)
//
//   (u_j − u_i)·t / l = −(1/12) (m_j − m_i)·t ((θ_j − θ_i) × n)·t                                  (3)
//
//   (u_j − u_i)·q / l = mean of θz along the edge − (1/12) (m_j − m_i)·t ((θ_j − θ_i) × n)·q       (4)
//
// The flat membrane takes these θz and edges for strain: thin shells lock, (1) by θz above all (the hemisphere of
// t/R = 4e-4, 16 × 16, to a hundredth of its deflection). Subtracted from what it is given, they leave it nothing.
// Rigid motions have θ_j = θ_i and flat shells m = 0: both stay as they are. What the next terms leave would still lock
// very thin shells, three drilling strains in each facet against one rotation at each node. Facets that curve take a
// share of these strains only, α_b and β₀ times
//
//   1 / (1 + m̂² A / 12 t²),   m̂ the largest of |m_i − m̄|                                                            (5)
//
// so that their energy stays of the order of bending's: all of it in flat facets and where h² ≪ R t, little where thin
// shells curve, whose facets then are near to constant strain. Any share passes the patch test.
// Plate: shell_theory.hpp. Everything integrated is quadratic: three points are exact, but for the square of the linked
// deflection (fourth-order effect).
namespace tenon::fem {
namespace {

using Mat9 = Eigen::Matrix<double, 9, 9>;
using Column9 = Eigen::Matrix<double, 9, 1>;

/// The triangle in its plane, x along its first edge.
struct FlatTria {
  Mat3 R;     ///< columns: element axes
  Vec3 x, y;  ///< corners [m]
  double A;   ///< area [m²]
};

FlatTria flatten(const Tria3& tria, std::span<const Vec3> nodes) {
  const Vec3& p1 = nodes[static_cast<std::size_t>(tria.nodes[0])];
  const Vec3 e12 = nodes[static_cast<std::size_t>(tria.nodes[1])] - p1;
  const Vec3 e13 = nodes[static_cast<std::size_t>(tria.nodes[2])] - p1;
  const Vec3 normal = e12.cross(e13);
  if (!spans_area(e12, e13))
    throw ModelError(fmt::format("triangle element {}: its area is zero", tria.id),
                     "Delete it, or move one of its nodes off the line through the others");
  FlatTria f;
  f.R.col(2) = normal.normalized();
  f.R.col(0) = e12.normalized();
  f.R.col(1) = f.R.col(2).cross(f.R.col(0));
  f.x << 0.0, e12.norm(), f.R.col(0).dot(e13);
  f.y << 0.0, 0.0, f.R.col(1).dot(e13);
  f.A = 0.5 * normal.norm();
  return f;
}

/// How the surface's normals lie to the facet.
struct FacetTilts {
  NormalTilts<3> m;
  Eigen::Vector2d mean;
  bool curved = false;          ///< false for a flat facet, or where a node has no director
  double drilling_share = 1.0;  ///< (5)
};

FacetTilts facet_tilts(const Tria3& tria, std::span<const Vec3> directors, const FlatTria& f, double thickness) {
  FacetTilts t;
  t.curved = normal_tilts(tria.nodes, directors, f.R, t.m);
  if (!t.curved) return t;
  t.mean = mean_tilt(t.m);
  t.drilling_share = resolved_share(t.m, f.A, thickness);
  return t;
}

/// What (2)–(4) add to (u v θz), from (θx θy) of the nodes.
Eigen::Matrix<double, 9, 6> curvature_terms(const FlatTria& f, const FacetTilts& tilts) {
  using Vec2 = Eigen::Vector2d;
  using Row = Eigen::Matrix<double, 1, 6>;
  const std::array<Vec2, 3>& m = tilts.m;
  const Vec2& mean = tilts.mean;
  Eigen::Matrix<double, 9, 6> E;
  std::array<Eigen::Matrix<double, 2, 6>, 3> theta;  // θ̂_i
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      theta[static_cast<std::size_t>(i)].block<2, 2>(0, 2 * j) =
          ((i == j ? 1.0 : 0.0) - 1.0 / 3.0) * Eigen::Matrix2d::Identity();

  std::array<Vec2, 3> t;
  Mat3 natural;                        // rows: edge strain = (c², s², cs) · ε
  Eigen::Matrix<double, 3, 6> strain;  // (3)
  Row omega = Row::Zero();             // (4), the mean of the edges
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
    t[i] = Vec2(f.x[b] - f.x[a], f.y[b] - f.y[a]).normalized();
    natural.row(a) << t[i].x() * t[i].x(), t[i].y() * t[i].y(), t[i].x() * t[i].y();
    const Vec2 bend = (m[j] - m[i]).dot(t[i]) / 12.0 * t[i];  // (θ × n)·q = −θ·t
    const Eigen::Matrix<double, 2, 6> turn = theta[j] - theta[i];
    strain.row(a) = bend.x() * turn.row(1) - bend.y() * turn.row(0);
    omega += (m[i] - mean).transpose().lazyProduct(theta[i]) / 12.0 - bend.transpose().lazyProduct(turn) / 3.0;
  }
  const Eigen::Matrix<double, 3, 6> epsilon = natural.inverse().lazyProduct(strain);
  for (const Vec2& e : t)
    omega -=
        (e.x() * e.y() * (epsilon.row(1) - epsilon.row(0)) + 0.5 * (e.x() * e.x() - e.y() * e.y()) * epsilon.row(2)) /
        3.0;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    E.row(3 * i) = f.x[i] * epsilon.row(0) + f.y[i] * (0.5 * epsilon.row(2) - omega);
    E.row(3 * i + 1) = f.y[i] * epsilon.row(1) + f.x[i] * (0.5 * epsilon.row(2) + omega);
    E.row(3 * i + 2) = 0.5 * (m[k] + mean).transpose().lazyProduct(theta[k]);
  }
  return E;
}

/// Node forces and moments of unit membrane stress over unit thickness, over (u v θz): α_b = 3/2 times (5). Lᵀu/A is
/// the mean strain.
Eigen::Matrix<double, 9, 3> lumping(const FlatTria& f, const FacetTilts& tilts) {
  const auto x = [&f](int i, int j) { return f.x[i] - f.x[j]; };
  const auto y = [&f](int i, int j) { return f.y[i] - f.y[j]; };
  const double alpha_b = 1.5 * tilts.drilling_share;
  Eigen::Matrix<double, 9, 3> L;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    L.row(3 * i) << y(j, k), 0.0, x(k, j);
    L.row(3 * i + 1) << 0.0, x(k, j), y(j, k);
    L.row(3 * i + 2) << y(j, k) * (y(i, k) - y(j, i)), x(k, j) * (x(k, i) - x(i, j)),
        2.0 * (x(k, i) * y(i, k) - x(i, j) * y(j, i));
    L.row(3 * i + 2) *= alpha_b / 6.0;
  }
  return 0.5 * L;
}

/// Stiffness over (u v θz), (1). Indices i, j, k are cyclic; edges 1-2, 2-3, 3-1.
Mat9 membrane_stiffness(const ShellTheory& theory, const FlatTria& f, const FacetTilts& tilts) {
  const double beta_0 = tilts.drilling_share * std::max(0.5 * (1.0 - 4.0 * theory.nu * theory.nu), 0.01);
  const auto x = [&f](int i, int j) { return f.x[i] - f.x[j]; };
  const auto y = [&f](int i, int j) { return f.y[i] - f.y[j]; };

  Eigen::Matrix<double, 3, 9> T;  // hierarchical rotations
  Mat3 natural;                   // rows: edge strain = (c², s², cs) · ε
  Vec3 l2;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int row = 0; row < 3; ++row) {
      T(row, 3 * i) = x(k, j) / (4.0 * f.A);
      T(row, 3 * i + 1) = y(k, j) / (4.0 * f.A);
      T(row, 3 * i + 2) = row == i ? 1.0 : 0.0;
    }
    l2[i] = x(j, i) * x(j, i) + y(j, i) * y(j, i);
    natural.row(i) << x(j, i) * x(j, i), y(j, i) * y(j, i), x(j, i) * y(j, i);
    natural.row(i) /= l2[i];
  }
  const Eigen::Matrix<double, 9, 3> L = lumping(f, tilts);
  const Eigen::Matrix<double, 9, 3> LC = L.lazyProduct(theory.membrane / f.A);
  Mat9 K = LC.lazyProduct(L.transpose());

  // natural strains at the corners per hierarchical rotation, β = (1, 2, 1, 0, 1, −1, −1, −1, −2)
  Mat3 Q1, Q2, Q3;
  Q1 << 1, 2, 1, 0, 1, -1, -1, -1, -2;
  Q2 << -2, -1, -1, 1, 1, 2, -1, 0, 1;
  Q3 << 1, -1, 0, -1, -2, -1, 2, 1, 1;
  const Vec3 scale = (2.0 * f.A / 3.0) * l2.cwiseInverse();
  const Mat3 inverse = natural.inverse();
  const Mat3 C = inverse.transpose() * theory.membrane * inverse;  // natural stress = C natural strain
  Mat3 K_theta = Mat3::Zero();
  for (const Mat3& Q : {Mat3(0.5 * (Q1 + Q2)), Mat3(0.5 * (Q2 + Q3)), Mat3(0.5 * (Q3 + Q1))}) {  // mid-sides
    const Mat3 SQ = scale.asDiagonal() * Q;
    K_theta.noalias() += SQ.transpose() * C * SQ;
  }
  const Eigen::Matrix<double, 9, 3> TK = T.transpose().lazyProduct(0.75 * beta_0 * f.A * K_theta);
  K.noalias() += TK.lazyProduct(T);
  return K;
}

/// Stiffness and mass over (w θx θy), and the mean curvatures as columns.
void plate(const ShellTheory& theory, const FlatTria& f, Mat9& K, Mat9& M, Eigen::Matrix<double, 9, 3>& mean) {
  Vec3 N_x, N_y;
  std::array<PlateEdge, 3> edge;  // 1-2, 2-3, 3-1
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    N_x[i] = (f.y[j] - f.y[k]) / (2.0 * f.A);
    N_y[i] = (f.x[k] - f.x[j]) / (2.0 * f.A);
    edge[static_cast<std::size_t>(i)] = plate_edge(theory, f.x[j] - f.x[i], f.y[j] - f.y[i]);
  }
  K.setZero();
  M.setZero();
  mean.setZero();
  const double dA = f.A / 3.0;
  for (int g = 0; g < 3; ++g) {
    Vec3 N = Vec3::Constant(1.0 / 6.0);
    N[g] = 2.0 / 3.0;
    Eigen::Matrix<double, 9, 3> B = Eigen::Matrix<double, 9, 3>::Zero();      // columns: curvatures
    Eigen::Matrix<double, 9, 2> gamma = Eigen::Matrix<double, 9, 2>::Zero();  // columns: shears
    Column9 w = Column9::Zero();                                              // linked deflection
    for (int i = 0; i < 3; ++i) {
      B(3 * i + 2, 0) = N_x[i];
      B(3 * i + 1, 1) = -N_y[i];
      B(3 * i + 1, 2) = -N_x[i];
      B(3 * i + 2, 2) = N_y[i];
      w[3 * i] = N[i];
      for (int j = 0; j < 3; ++j)
        for (int a = 1; a < 3; ++a) M(3 * i + a, 3 * j + a) += dA * theory.rotary * N[i] * N[j];
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const PlateEdge& e = edge[static_cast<std::size_t>(i)];
      const double P_x = 4.0 * (N_x[i] * N[j] + N[i] * N_x[j]), P_y = 4.0 * (N_y[i] * N[j] + N[i] * N_y[j]);
      const Vec3 kappa(P_x * e.c_dbeta, P_y * e.s_dbeta, P_y * e.c_dbeta + P_x * e.s_dbeta);
      add_g(B, kappa, e, i, j);
      // MITC3: the field N_i ∇N_j − N_j ∇N_i has unit tangential integral on its own edge and none on the others
      const Eigen::Vector2d whitney(N[i] * N_x[j] - N[j] * N_x[i], N[i] * N_y[j] - N[j] * N_y[i]);
      add_g(gamma, Eigen::Vector2d(e.shear * whitney), e, i, j);
      add_link(w, 4.0 * N[i] * N[j], e, i, j);
    }
    mean += B / 3.0;
    const Eigen::Matrix<double, 9, 3> BD = B.lazyProduct(dA * theory.bending);
    K.noalias() += BD.lazyProduct(B.transpose());
    K.noalias() += Eigen::Matrix<double, 9, 2>(gamma.lazyProduct(dA * theory.shear)).lazyProduct(gamma.transpose());
    M.noalias() += (dA * theory.mass * w) * w.transpose();
  }
}

}  // namespace

void tria3_matrices(const Tria3& tria, const ShellSection& section, const Material& material,
                    std::span<const Vec3> nodes, ElementMatrices& out, std::span<const Vec3> directors) {
  const FlatTria flat = flatten(tria, nodes);
  const ShellTheory theory =
      shell_theory(section, material, tria.material_axis, flat.R.col(0), flat.R, "triangle", tria.id);

  const FacetTilts tilt = facet_tilts(tria, directors, flat, theory.thickness);
  const Mat9 K_membrane = membrane_stiffness(theory, flat, tilt);
  Mat9 K_plate, M_plate, K_coupling, M_membrane = Mat9::Zero();
  Eigen::Matrix<double, 9, 3> kappa;
  plate(theory, flat, K_plate, M_plate, kappa);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)  // ∫ N_i N_j dA = A (1 + δ_ij)/12
      M_membrane(3 * i, 3 * j) = M_membrane(3 * i + 1, 3 * j + 1) = theory.mass * flat.A * (i == j ? 2.0 : 1.0) / 12.0;
  if (theory.coupled)  // A ε̄ᵀ B κ̄, ε̄ = Lᵀu/A
    K_coupling =
        Eigen::Matrix<double, 9, 3>(lumping(flat, tilt).lazyProduct(theory.coupling)).lazyProduct(kappa.transpose());
  std::array<Vec3, 3> arms;
  arms.fill(Vec3(0.0, 0.0, tria.offset));
  Eigen::Matrix<double, 18, 18> K = join_shell<3>(K_membrane, K_plate, theory.coupled ? &K_coupling : nullptr);
  if (tilt.curved) {
    const Eigen::Matrix<double, 9, 6> E = curvature_terms(flat, tilt);
    Eigen::Matrix<double, 18, 18> T = Eigen::Matrix<double, 18, 18>::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        T.block<2, 2>(6 * i, 6 * j + 3) = E.block<2, 2>(3 * i, 2 * j);
        T.block<1, 2>(6 * i + 5, 6 * j + 3) += E.block<1, 2>(3 * i + 2, 2 * j);
      }
    const Eigen::Matrix<double, 18, 18> KT = K.lazyProduct(T);
    K = T.transpose().lazyProduct(KT);
  }
  to_basic_frame<3>(K, flat.R, arms, out.K);
  arms.fill(Vec3(0.0, 0.0, tria.offset + theory.mass_height));
  shell_to_basic_frame<3>(M_membrane, M_plate, flat.R, arms, out.M);
}

void tria3_geometric_stiffness(const Tria3& tria, const ShellSection& section, const Material& material,
                               std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                               ElementMatrices::Matrix& out, std::span<const Vec3> directors) {
  const FlatTria flat = flatten(tria, nodes);
  const ShellTheory theory =
      shell_theory(section, material, tria.material_axis, flat.R.col(0), flat.R, "triangle", tria.id);
  std::array<Vec3, 3> arms, bending;  // bending: (w θx θy)
  arms.fill(Vec3(0.0, 0.0, tria.offset));
  Column9 in_plane;
  Eigen::Matrix<double, 6, 1> across;  // θx θy
  Vec3 N_x, N_y;
  std::array<PlateEdge, 3> edge;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Vec3 turn = flat.R.transpose() * u.segment<3>(6 * i + 3);
    const Vec3 corner = flat.R.transpose() * u.segment<3>(6 * i) + turn.cross(arms[0]);
    in_plane.segment<3>(3 * i) << corner.x(), corner.y(), turn.z();
    across.segment<2>(2 * i) = turn.head<2>();
    bending[static_cast<std::size_t>(i)] << corner.z(), turn.x(), turn.y();
    N_x[i] = (flat.y[j] - flat.y[k]) / (2.0 * flat.A);
    N_y[i] = (flat.x[k] - flat.x[j]) / (2.0 * flat.A);
    edge[static_cast<std::size_t>(i)] = plate_edge(theory, flat.x[j] - flat.x[i], flat.y[j] - flat.y[i]);
  }
  const FacetTilts tilt = facet_tilts(tria, directors, flat, theory.thickness);
  if (tilt.curved) in_plane += curvature_terms(flat, tilt) * across;
  Vec3 curvature = Vec3::Zero();  // the element's mean
  for (std::size_t k = 0; k < 3; ++k) curvature += edge_bending(edge[k], bending[k], bending[(k + 1) % 3]) / flat.A;
  const Eigen::Matrix2d N =
      flat.A / 3.0 * stress_resultants(theory, lumping(flat, tilt).transpose() * in_plane / flat.A, curvature);
  Mat9 K_membrane = Mat9::Zero(), K_plate = Mat9::Zero();
  for (int g = 0; g < 3; ++g) {
    Vec3 area = Vec3::Constant(1.0 / 6.0);
    area[g] = 2.0 / 3.0;
    Eigen::Matrix<double, 9, 2> w = Eigen::Matrix<double, 9, 2>::Zero();  // columns: w,x w,y
    for (int i = 0; i < 3; ++i) w.row(3 * i) << N_x[i], N_y[i];
    add_in_plane(K_membrane, w, N);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const PlateEdge& e = edge[static_cast<std::size_t>(i)];
      add_link(w.col(0), 4.0 * (N_x[i] * area[j] + area[i] * N_x[j]), e, i, j);
      add_link(w.col(1), 4.0 * (N_y[i] * area[j] + area[i] * N_y[j]), e, i, j);
    }
    K_plate.noalias() += Eigen::Matrix<double, 9, 2>(w.lazyProduct(N)).lazyProduct(w.transpose());
  }
  shell_to_basic_frame<3>(K_membrane, K_plate, flat.R, arms, out);
}

}  // namespace tenon::fem
