#pragma once

#include <filesystem>

#include "assembly/full_model.hpp"
#include "assembly/plan.hpp"
#include "assembly/scene.hpp"
#include "fem/model.hpp"

/// From the values of a scene to models and networks.
namespace tenon::assembly {

/// The structural model of an FE body, SI, with its ports. Throws InputError at the place in the scene for sets, nodes
/// and sections that do not fit the mesh, ModelError for what the elements refuse.
fem::Model build_model(const SceneBody& body);

/// Reduces an FE body, reads a reduced one, makes a rigid one, as the plan has it; hung by its parent port.
ReducedBody build_body(const SceneBody& body, const BodyPlan& plan, const reduction::Progress& progress = {});

/// All bodies, joined. Bodies, joints, inputs and outputs keep the order of the scene. Bodies that differ in nothing
/// but their name are reduced once (same_body.hpp).
Network build_network(const Scene& scene, const Plan& plan, const reduction::Progress& progress = {});

/// Joins given bodies (one for each of the scene's, in its order) as the scene says.
Network connect(const Scene& scene, std::vector<ReducedBody> bodies);

/// The unreduced assembly of a scene, `network` being what build_network() made of it. A beam that moves in one plane
/// is rigid out of it, as its reduced body is.
FullModel full_model(const Scene& scene, const Network& network);

}  // namespace tenon::assembly
