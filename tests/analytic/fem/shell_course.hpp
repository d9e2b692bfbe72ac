#pragma once

#include <array>
#include <functional>
#include <string>

#include "tests/unit/fem/elements/small_assembly.hpp"

/// The shell obstacle course on regular and on badly distorted meshes: problems as functions that return a deflection;
/// the value published for it stands in brackets.
namespace tenon::fem::testing {

/// The distorted mesh has edges divided 1 : 2 : … : N, opposite edges from opposite ends, its nodes where the lines
/// that join them cross. It has two corners of small and two of large cells: `mirrored` is the other way round.
enum class Grid { regular, distorted, mirrored };
inline constexpr std::array<Grid, 2> skewed{Grid::distorted, Grid::mirrored};

/// Quadrilaterals, or triangles by one or the other diagonal of each.
enum class Cells { quads, diagonal_13, diagonal_24 };
inline constexpr std::array<Cells, 2> triangles{Cells::diagonal_13, Cells::diagonal_24};

/// An N×N mesh.
struct Cover {
  Grid grid = Grid::regular;
  int N = 16;
  Cells cells = Cells::quads;
};

std::string name(const Cover& cover);

using Surface = std::function<Vec3(double, double)>;
using Free = std::function<bool(const Vec3&, int)>;

Material elastic(double E, double nu);

/// Cells over (u, v) in the unit square, mapped to space. Triangles with the directors that assembly gives them.
SmallAssembly cover(const Cover& cover, double t, const Material& material, const Surface& at);

/// All displacements under `load` with the dofs for which `free` holds.
Eigen::VectorXd displacements(const SmallAssembly& a, const Free& free, const Eigen::VectorXd& load);

/// R = 300, L = 600, t = 3, E = 3e6, ν = .3, rigid diaphragms, pinched by a pair of unit forces: an eighth of it.
/// Deflection under the force [1.8248e-5].
double pinched_cylinder(const Cover& c);

/// R = 25, L = 50, 80°, t = .25, E = 4.32e8, ν = 0, weight 90 per area, diaphragms: a quarter. Free edge [.3024].
double scordelis_lo(const Cover& c);

/// R = 10, 18° hole, E = 6.825e7, ν = .3, unit forces in pairs: a quarter. Radial deflection times (t/.04)³ [.093].
double hemisphere(const Cover& c, double t);

/// The same closed, three patches of N×N, regular [.0924].
double full_hemisphere(const Cover& c, double t);

/// L = 12, W = 1.1, 90°, E = 29e6, ν = .22, N×6N, clamped: tip deflection under a unit force in plane (0) or out of it
/// (1) [t = .32: 5.424535e-3, 1.753248e-3; .0032: 5.256e3, 1.294e3].
double twisted_beam(const Cover& c, double t, int direction);

/// Ring, R = 1, one wide, E = 1, ν = 0, pulled apart along a diameter by two unit line loads: a quarter. What that
/// diameter grows.
double ring(const Cover& c, double t);

/// Clamped unit square, a quarter: centre deflection times D under a unit pressure [.00126532] or force [.0056].
enum class PlateLoad { pressure, force };
double clamped_plate(const Cover& c, double t, PlateLoad load);

/// Simply supported, a unit force at the centre: deflection times D [.01160].
double supported_plate(const Cover& c, double t);

/// Cook's panel, E = 1, ν = 1/3, a unit shear force on the free side: deflection of its middle [23.97].
double cooks_membrane(const Cover& c);

}  // namespace tenon::fem::testing
