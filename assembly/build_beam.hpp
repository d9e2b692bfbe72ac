#pragma once

#include "assembly/plan.hpp"
#include "assembly/scene.hpp"
#include "fem/model.hpp"

namespace tenon::assembly {

/// The finite-element model of a scene's beam: equal elements from port P to port C.
fem::Model beam_model(const SceneBody& body, const BeamSource& beam);

/// The same, held to its x-y plane where the scene says so: out of it (z, rotations about x and y of the beam) every
/// node follows P as one rigid piece, which is what the reduced body keeps. Such a model is for full_model() alone: its
/// port C is not free to be held.
fem::Model full_beam_model(const SceneBody& body, const BeamSource& beam);

/// The scene's beam as a body: by its finite elements, reduced as the plan has it, or by the analytic shapes of
/// titop/beam.hpp, set into the body's frame.
ReducedBody make_beam(const SceneBody& body, const BeamSource& beam, const BodyPlan& plan,
                      const reduction::Progress& progress);

}  // namespace tenon::assembly
