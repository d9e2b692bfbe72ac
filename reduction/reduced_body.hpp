#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fem/spatial.hpp"

namespace tenon::reduction {

using fem::Mat3;
using fem::Mat6;
using fem::Mat6X;
using fem::Vec3;

struct ShapeIntegrals;      // shape_integrals.hpp
struct GeometricStiffness;  // geometric_stiffness.hpp

/// A place where the body joins others. Its motion is x = τ(position − reference) x_ref + Phi η, eq (2) of the TITOP
/// paper.
struct BodyPort {
  std::string name;
  Vec3 position = Vec3::Zero();   ///< in the body frame [m]
  Mat3 axes = Mat3::Identity();   ///< columns: the port's axes in the body frame
  Mat6X Phi = Mat6X::Zero(6, 0);  ///< 6×n modal shapes at the port; zero at the parent port of a cantilever body
};

/// How a body was made, what was counted, what was left out, where it is valid.
struct Certificate {
  std::string basis;        ///< e.g. "craig-bampton, 12 fixed-interface modes"
  std::string source;       ///< file name
  std::string source_hash;  ///< "fnv1a64:..." of the source file's bytes; empty for analytic bodies
  int nodes = 0, elements = 0, dofs = 0;
  int modes_found = 0;             ///< eigenpairs of the fixed-interface (or clamped) problem that were kept
  int modes_counted = -1;          ///< by inertia count below `count_shift`; −1 not counted
  double count_shift = 0.0;        ///< σ of the count [rad²/s²]
  double max_residual = 0.0;       ///< of the kept eigenpairs, relative
  double max_orthogonality = 0.0;  ///< |ΦᵀMΦ − 1|
  double valid_below = 0.0;  ///< [rad/s] the first frequency that is *not* represented; 0: none is missing, or unknown
  std::vector<std::string> left_out;  ///< sentences: what was dropped or regularised, and how much it weighs
};

/// The form of eq (1) of the TITOP paper: [D Lᵀ; L 1][ẍ_ref; η̈] + diag(0, 2ζω)(..) + diag(0, ω²)(..) = Σ [τᵀ; Phiᵀ] W.
/// All 6-vectors linear first, in the body frame (axes of the mesh). A rigid body has n = 0.
struct ReducedBody {
  enum class Kind { cantilever, free_free };

  std::string name;
  Kind kind = Kind::cantilever;
  Vec3 reference = Vec3::Zero();  ///< point of x_ref: the parent port (cantilever) or the mass centre (free-free) [m]
  int parent = 0;                 ///< index into ports of the port the body hangs by; −1 for free-free
  Eigen::VectorXd omega;          ///< n modal frequencies [rad/s], ascending
  Eigen::VectorXd zeta;           ///< n damping ratios, diag(C) / 2ω
  Eigen::MatrixXd C;              ///< n×n modal damping matrix [rad/s]; empty: diag(2ζω)
  Eigen::MatrixXd L;              ///< n×6 participation at the reference [√kg, √kg·m]
  Mat6 D = Mat6::Zero();          ///< rigid mass matrix at the reference
  std::vector<BodyPort> ports;
  Certificate certificate;

  /// Shapes at the mesh nodes for pictures: node_positions N, node_shapes 6N×n; empty when not kept.
  std::vector<Vec3> node_positions;
  Eigen::MatrixXd node_shapes;

  /// What large motion adds, shared by copies; null when it was not computed.
  std::shared_ptr<const ShapeIntegrals> shape_integrals;  ///< mass that depends on η
  std::shared_ptr<const GeometricStiffness> stiffening;   ///< stiffness that depends on loads

  int n() const { return static_cast<int>(omega.size()); }
};

/// τ of a port: twist at the port from the twist at the reference.
inline Mat6 tau(const ReducedBody& body, int port) {
  return fem::tau(body.ports[static_cast<std::size_t>(port)].position - body.reference);
}

/// Index of a port by name; throws ModelError with a near miss when there is none.
int port_index(const ReducedBody& body, const std::string& port);

/// A body without flexibility: mass m [kg], centre of mass [m] and inertia about it [kg m²], ports[0] is the parent
/// port.
ReducedBody rigid_body(std::string name, double mass, const Vec3& centre, const Mat3& inertia,
                       std::vector<BodyPort> ports);

/// Sizes agree, numbers are finite, ω ≥ 0, D symmetric positive semi-definite and D − LᵀL ⪰ 0 up to round-off; throws
/// ModelError.
void check(const ReducedBody& body);

/// The modal damping matrix, whichever way it is given: C or diag(2ζω), n×n.
Eigen::MatrixXd damping(const ReducedBody& body);

/// Gives the body the damping matrix C (n×n, symmetric, positive semi-definite) and the ratios that its diagonal says.
void set_damping(ReducedBody& body, const Eigen::MatrixXd& C);

/// The same body hung by another of its ports: exact in the reduced space, by a congruence and a small eigen-solve. The
/// damping of a damped body becomes a full matrix VᵀCV.
ReducedBody rebase(const ReducedBody& body, int port);

/// Effective mass per direction Σ_j L_jd² as a table: n×6, and the remainder diag(D) − Σ_j L_jd² (6).
struct EffectiveMass {
  Eigen::MatrixXd per_mode;  ///< n×6 [kg, kg m²]
  Eigen::Matrix<double, 6, 1> total;
  Eigen::Matrix<double, 6, 1> remainder;
};
EffectiveMass effective_mass(const ReducedBody& body);

}  // namespace tenon::reduction
