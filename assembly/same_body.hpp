#pragma once

#include <string>

#include "assembly/plan.hpp"
#include "assembly/scene.hpp"

namespace tenon::assembly {

/// Everything that decides what a body of a scene becomes, as text: its source, ports, damping and plan, not its name.
/// Bodies with equal texts are reduced once. Empty for a rigid body, which costs nothing to make.
std::string fingerprint(const SceneBody& body, const BodyPlan& plan);

}  // namespace tenon::assembly
