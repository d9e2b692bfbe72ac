#pragma once

#include "assembly/plan.hpp"
#include "assembly/scene.hpp"
#include "fem/model.hpp"

namespace tenon::assembly {

/// The finite-element model of a scene's beam: equal elements from port P to port C.
fem::Model beam_model(const SceneBody& body, const BeamSource& beam);

/// The scene's beam as a body: by its finite elements, reduced as the plan has it, or by the analytic shapes of
/// titop/beam.hpp, set into the body's frame.
ReducedBody make_beam(const SceneBody& body, const BeamSource& beam, const BodyPlan& plan,
                      const reduction::Progress& progress);

}  // namespace tenon::assembly
