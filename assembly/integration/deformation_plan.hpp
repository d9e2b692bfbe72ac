#pragma once

#include "assembly/integration/simulation.hpp"

/// What a motion requires of its bodies: how much each would deform is seen on the motion of the same scene with rigid
/// bodies, which costs little, before modes are integrated at all.
namespace tenon::assembly {

/// Of one body of the network with modes whose level the scene leaves to the plan.
struct DeformationPlan {
  std::string body;
  Flexibility level = Flexibility::full;
  double deflection = 0.0;  ///< largest of a port, over the body's size or rad, twice the static one: loads that step
  double softening = 0.0;   ///< largest change of a modal stiffness by loads and spin, over the stiffness
  std::string why;          ///< for people
};

/// Where the section says `auto`: integrates the motion with rigid bodies, takes the loads that it puts on the modes
/// η_s = ω⁻² (Jᵀλ − 𝓜 χ̇ − 𝓒) of eq (44) as static ones, and picks
///  - `dropped` where deflection and softening both stay below `tolerance`: ports and mass then stand where they would
///    within it;
///  - `rigid` where they stay below a thousandth of it and every mode of the body lies above `band` so far that its
///    quasi-static error (band/ω₁)² is below `tolerance` as well; never without a band (0) [rad/s];
///  - `full` for all others, and for all bodies when the motion with rigid ones cannot be integrated.
/// Progress runs from 0 to 1.
std::vector<DeformationPlan> plan_deformation(const Network& network, const SceneSimulation& section, double until,
                                              double tolerance, double band, const reduction::Progress& progress = {});

/// The section with the levels of the plan.
SceneSimulation with_levels(SceneSimulation section, const std::vector<DeformationPlan>& plan);

}  // namespace tenon::assembly
