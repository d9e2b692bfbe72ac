#pragma once

#include "assembly/scene.hpp"
#include "fem/model.hpp"

namespace tenon::assembly {

/// The elements of a mesh by the sections of a scene: every line, triangle and quadrilateral gets the one section of
/// its set. Throws InputError in the scene for sets that are missing, empty, of another kind or cover each other, for
/// cells without a section that no port, support or mass names nor `ignore`, and for cells that a port, support or mass
/// names and `everywhere` may mean as well.
fem::Model elements_of(const fem::Mesh& mesh, const SceneBody& body, const FeSource& fe);

}  // namespace tenon::assembly
