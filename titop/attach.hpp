#pragma once

#include "reduction/reduced_body.hpp"

namespace tenon::titop {

/// The body with a rigid mass fixed to one of its ports: mass [kg] ≥ 0, centre of mass in the body frame [m], inertia
/// about that centre in the axes of the body frame [kg m²]. Exact in the reduced space. At the reference port of a
/// cantilever body only D changes; elsewhere also the modes: M_zz = 1 + ΦᵀMΦ, whose large and small parts are kept
/// apart (singular values), so that ω keeps its digits at any ratio of masses. D holds the sum of both masses: seen
/// from the parent port, a load more than 1e7 times the body hides the body, and a release of the parent port is
/// refused (port_model.hpp, constrain.hpp). Throws ModelError for a mass that makes no sense or a mode without
/// stiffness.
reduction::ReducedBody attach_mass(const reduction::ReducedBody& body, int port, double mass,
                                   const reduction::Vec3& centre,
                                   const reduction::Mat3& inertia = reduction::Mat3::Zero());

/// The body with a port moved by the rigid arm `offset` [m, body frame]: Φ' = τ(offset) Φ for a child port; for the
/// parent port of a cantilever body the reference moves along.
reduction::ReducedBody move_port(const reduction::ReducedBody& body, int port, const reduction::Vec3& offset);

}  // namespace tenon::titop
