#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh.hpp"

/// Pictures for ParaView: VTK's XML files of unstructured grids (.vtu) and collections of them (.pvd).
namespace tenon::fem {

/// Named values at the points (or cells): one row a point, one column a component (three make a vector in ParaView).
struct PointArray {
  std::string name;
  Eigen::MatrixXd values;
};

/// The translations of shapes over all dofs (6N×n, node by node [ux uy uz rx ry rz]) as "mode_1" ... "mode_n", N×3
/// each.
std::vector<PointArray> mode_arrays(const Eigen::Ref<const Eigen::MatrixXd>& shapes);

struct VtuOptions {
  std::vector<PointArray> cell_arrays{};  ///< one row a cell, block after block
  int digits = 9;                         ///< significant ones: enough for a picture; 17 give the same numbers again
};

/// Writes points, cells and the arrays as text. The file appears whole or not at all.
/// Throws ModelError when an array has not one row a point (a cell) or holds NaN or infinity, InputError when the file
/// cannot be written. VTK has no 14-node pyramid: its 13 edge and corner nodes are written. Source: VTK file formats,
/// "UnstructuredGrid"; cell numbers of vtkCellType.h.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh, const std::vector<PointArray>& arrays = {},
               const VtuOptions& options = {});

struct AnimationOptions {
  int frames = 24;         ///< over one period
  double amplitude = 0.1;  ///< of the point that moves most, over the diagonal of the mesh's box
};

/// Writes one period of a mode u (N×3) as a collection "name.pvd" of frames "name_000.vtu", ... beside it: positions
/// x + a u sin 2πt with t = 0, 1/frames, ..., and the array "displacement" a u sin 2πt. The collection is written last.
/// Throws as write_vtu.
void write_mode_animation(const std::filesystem::path& pvd, const Mesh& mesh,
                          const Eigen::Ref<const Eigen::MatrixX3d>& mode, const AnimationOptions& options = {});

}  // namespace tenon::fem
