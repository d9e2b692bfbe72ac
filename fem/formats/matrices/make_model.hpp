#pragma once

#include "fem/formats/matrices/matrix_data.hpp"
#include "fem/mesh.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// Matrices as a model of one part, and a mesh without cells that names its nodes and their sets.
struct MatrixModel {
  Mesh mesh;
  Model model;
};

/// The model of K and M, in their own units: nodes in the order of the rows, scalar dofs as scalar points. Nodes whose
/// place is not told stand at NaN: links, ports and rigid motions refuse them when they need it. Sets keep the nodes
/// that have rows. Throws ModelError for labels that do not fit the matrices or stand twice, for numbers that are not
/// finite, and for negative diagonals, which no stiffness or mass has.
MatrixModel make_model(MatrixData data);

}  // namespace tenon::fem
