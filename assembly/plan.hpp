#pragma once

#include <string>
#include <vector>

#include "assembly/scene.hpp"

namespace tenon::assembly {

/// Modes kept of an FE body whose scene states neither a reduction nor a band.
inline constexpr int default_modes = 20;

/// What is kept of one body, what is dropped, and why.
struct BodyPlan {
  std::string body;
  bool rigid = false;                ///< no flexibility: a rigid body, or an FE body taken as one
  reduction::ReduceOptions options;  ///< of an FE body that is reduced
  std::string kept, dropped, why;    ///< for people
};

struct Plan {
  std::vector<BodyPlan> bodies;    ///< in the order of the scene
  std::vector<std::string> notes;  ///< sentences on the scene as a whole
};

/// Decides from the values of the scene alone; opens no mesh. `auto` keeps the static shapes of all ports and of rigid
/// inertia and every fixed-interface mode below twice the top of the required band, or the default count when no band
/// is required.
Plan plan(const Scene& scene);

}  // namespace tenon::assembly
