#pragma once

#include "assembly/network.hpp"
#include "tests/reference/beams.hpp"

/// Small networks with closed-form modes.
namespace tenon::reference {

using assembly::Joint;
using assembly::JointKind;
using assembly::Network;
using assembly::PortRef;

reduction::BodyPort port(const std::string& name, const fem::Vec3& position = fem::Vec3::Zero());

/// Two rigid bodies with inertias J1, J2 about a common z axis, joined there by a revolute joint of stiffness k:
/// ω² = k (1/J1 + 1/J2).
Network two_inertias(double J1, double J2, double k);

/// A rigid bar of 2 kg and 1 m with its mass in the middle, ports p and q at its ends, turned by `axes`.
ReducedBody rigid_bar(const char* name, const fem::Mat3& axes = fem::Mat3::Identity());

Joint weld(const char* name, PortRef parent, PortRef child);

/// A rigid hub with two uniform clamped-free beams welded on opposite sides, all at one point; hub mass and polar
/// inertia are `ratio` times those of both beams as rigid bodies.
Network hub_and_panels(double ratio, int modes);

/// Exact flexible frequencies of hub_and_panels: the i-th root above the i-th clamped frequency of
/// h (1 + cos b cosh b) + 2 g(b) = 0, ω = b², with h the hub's mass or inertia and g the beam's driving inertia times
/// (1 + cos b cosh b): (sinh b cos b + cosh b sin b)/b in translation, (cosh b sin b − sinh b cos b)/b³ in rotation.
/// Divided by cosh b.
double hub_and_panels_root(double ratio, bool rotation, int i);

}  // namespace tenon::reference
