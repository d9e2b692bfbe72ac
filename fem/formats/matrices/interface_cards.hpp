#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/formats/matrices/matrix_data.hpp"
#include "fem/formats/matrices/op4.hpp"
#include "fem/formats/nastran/draft.hpp"

/// Bulk data that says what the rows of matrices are: grids, their frames, scalar points.
namespace tenon::fem::matrices {

/// The cards of one file, its grids read. Cards look into `text`, so the pair stays where it is.
struct InterfaceCards {
  explicit InterfaceCards(const std::filesystem::path& path);
  InterfaceCards(const InterfaceCards&) = delete;
  InterfaceCards& operator=(const InterfaceCards&) = delete;

  nastran::Text text;
  nastran::Draft draft;

  bool is_grid(long id) const { return draft.node_of.contains(id); }
  bool is_scalar(long id) const { return draft.scalars.contains(id); }
  /// Refuses what is left of the cards where it adds stiffness or mass; else it joins the losses of `data`.
  void finish(MatrixData& data);
};

/// Turns the rows from the displacement frames CD of the grids to the basic frame, K' = R K Rᵀ, and adds positions and
/// the set "boundary". Throws InputError for a node in a skew frame with some but not all of three directions.
void turn_to_basic(MatrixData& data, const InterfaceCards& cards);

/// The labels of K and M in rising order as rows; "", "" choose the one matrix whose name begins so.
MatrixData from_direct_matrices(const std::string& file, InterfaceCards& cards, const std::string& stiffness,
                                const std::string& mass);

}  // namespace tenon::fem::matrices
