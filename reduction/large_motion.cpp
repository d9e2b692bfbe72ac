#include "reduction/large_motion.hpp"

#include "reduction/free_rows.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {

void add_large_motion(const fem::Model& model, const fem::Structure& structure, ReducedBody& body) {
  if (body.n() == 0) return;
  if (!body.shape_integrals)
    body.shape_integrals = std::make_shared<const ShapeIntegrals>(
        shape_integrals(structure, free_rows(structure, body.node_shapes), body.reference));
  if (!model.matrix_parts.empty()) {
    body.certificate.left_out.emplace_back("geometric stiffening: matrices do not tell the stress in the body");
    return;
  }
  body.stiffening = std::make_shared<const GeometricStiffness>(geometric_stiffness(model, structure, body));
}

}  // namespace tenon::reduction
