#pragma once

#include <span>

#include "fem/elements/element_matrices.hpp"
#include "fem/elements/section_line.hpp"

namespace tenon::fem {

/// Stiffness and mass of a two-node beam whose section varies along it, or has its shear centre or its non-structural
/// mass off the centroid, 12×12. Both ends stand at the centroid. Stiffness by integrating flexibility: exact for loads
/// at the ends up to quadrature, which leaves less than 1e-8 at a ratio of 10 between the sizes at the ends; mass by
/// the shapes of that solution. A uniform beam with all centres at its centroid gives the matrices of `beam_matrices`.
/// BeamMass::nastran is that of its bar: neither rotary nor torsional inertia of the section, axial part averaged.
/// Warping is left out.
/// @throws ModelError naming the element: what `beam_matrices` refuses, I ≤ 0, J = 0 with an offset shear centre
/// Source: Spacone, Ciampi & Filippou, Computers & Structures 58 (1996) 71 (flexibility of a beam's section, shapes
/// from forces); Timoshenko, Young & Weaver, Vibration Problems in Engineering, 1974, §5.22 (shear centre).
void general_beam_matrices(const Beam& beam, const SectionLine& line, const Material& material,
                           std::span<const Vec3> nodes, ElementMatrices& out);

/// Geometric stiffness 12×12 of the axial force that the displacement u causes, as `beam_geometric_stiffness`.
void general_beam_geometric_stiffness(const Beam& beam, const SectionLine& line, const Material& material,
                                      std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                                      ElementMatrices::Matrix& out);

}  // namespace tenon::fem
