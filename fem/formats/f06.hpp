#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "fem/spatial.hpp"

namespace tenon::fem {

/// A row of Nastran's table of real eigenvalues.
struct ModalRow {
  double lambda = 0.0;            ///< ω² [rad²/s²]
  double generalized_mass = 0.0;  ///< φᵀMφ of the printed shape
};

/// Normal modes as Nastran prints them (.f06): in the units and displacement frames of the deck.
struct ModalRun {
  std::map<long, ModalRow> modes;                                      ///< by number, from 1 on without gaps
  std::map<long, std::map<long, Eigen::Matrix<double, 6, 1>>> shapes;  ///< of a mode, by grid: [T1 T2 T3 R1 R2 R3]
  int digits = 0;                                                      ///< significant ones of the shapes' numbers
  std::optional<Mat6> mass;  ///< MO of the grid point weight generator, about `mass_point`, in input units
  long mass_point = 0;       ///< a grid, or 0: the origin
};

/// Reads the tables REAL EIGENVALUES, REAL EIGENVECTOR NO. and the weight generator; page headers and other tables are
/// read past, and so are scalar points.
/// Throws InputError with line for a run that ended fatally, complex modes, what is repeated (several subcases), cut
/// off or contradicts itself, and for a file without modes or without shapes.
/// Source: the tables' layout in the User's Guides of MSC and NX Nastran.
ModalRun read_f06(const std::filesystem::path& path);

}  // namespace tenon::fem
