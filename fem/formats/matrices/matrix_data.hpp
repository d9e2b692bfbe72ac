#pragma once

#include <map>
#include <string>
#include <vector>

#include "fem/mesh.hpp"
#include "fem/structure.hpp"

namespace tenon::fem {

/// The dof behind one row of matrices: the file's node number with a direction 0..5 (ux uy uz rx ry rz), or a scalar
/// (modal) dof, numbered by `node`.
struct MatrixRow {
  long node = 0;
  int direction = 0;
  bool scalar = false;
};

/// K and M as another program wrote them, rows in its order, in the file's own units and the basic frame.
struct MatrixData {
  std::string source;
  std::vector<MatrixRow> rows;
  SparseMatrix K;                                 ///< n×n, symmetric, lower triangle
  SparseMatrix M;                                 ///< n×n, symmetric, lower triangle
  std::map<long, Vec3> positions;                 ///< of the nodes whose place the files tell, basic frame
  std::map<std::string, std::vector<long>> sets;  ///< node numbers by name, e.g. "boundary"
  std::vector<Loss> losses;
};

}  // namespace tenon::fem
