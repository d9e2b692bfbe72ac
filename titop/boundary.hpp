#pragma once

#include <array>
#include <vector>

#include "titop/port_model.hpp"

namespace tenon::titop {

/// What a port does in its six directions [ux uy uz rx ry rz] of the body frame: fixed (acceleration and motion
/// prescribed, zero) or free (wrench prescribed).
struct PortCondition {
  std::array<bool, 6> fixed{};
};

/// One condition for every port of a body, in the order of its ports.
struct Boundary {
  std::vector<PortCondition> ports;
};

/// The four ends of beam theory, for bending in one plane:
///   end      transverse  rotation  the other four directions (along the beam, out of the plane, about the axis)
///   clamped  fixed       fixed     fixed
///   free     free        free      free
///   pinned   fixed       free      fixed: a hinge about the normal of the plane
///   sliding  free        fixed     fixed: a slide across the beam
enum class End { clamped, free, pinned, sliding };

/// The plane of bending: x-y turns about z, x-z turns about y.
enum class BendingPlane { xy, xz };

/// The directions that an end speaks for. The others stay as the port model has them without inversion: fixed at the
/// parent port, free at the child ports.
enum class Scope {
  bending,  ///< transverse motion and rotation in the plane: the 4×4 model G_f, appendix 2 of the TITOP paper
  planar,   ///< with motion along x: the 6×6 model G of eq (24)
  spatial   ///< all six
};

/// The same kind of ends at every port, one per port of the body. Throws ModelError when the number differs, or for a
/// scope other than `spatial` when the body has no parent port.
Boundary boundary(const reduction::ReducedBody& body, const std::vector<End>& ends, Scope scope = Scope::spatial,
                  BendingPlane plane = BendingPlane::xy);

/// The channels of a port model to invert for a boundary: fixed directions of child ports, free ones of the parent.
std::vector<int> inverted_channels(const PortModel& model, const Boundary& boundary);

/// The boundary that a set of inverted channels stands for, for a model of all ports of the body.
Boundary boundary_of(const PortModel& model, const std::vector<int>& I);

}  // namespace tenon::titop
