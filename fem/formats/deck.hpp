#pragma once

#include <filesystem>

#include "fem/model.hpp"

/// Decks: files that carry a whole model, sections and materials included, whatever program they are for.
namespace tenon::fem {

struct Deck {
  Mesh mesh;
  Model model;               ///< its first nodes are those of the mesh
  double mass_factor = 1.0;  ///< Nastran's PARAM,WTMASS, already applied
  bool auto_spc = false;     ///< its own program holds what has no stiffness (NastranDeck)
};

/// An .inp file that gives its elements sections, Nastran bulk data (.bdf, .dat, .nas, .blk) that gives properties or
/// anything beside grids and elements. Without, they are meshes. @throws InputError when an .inp file cannot be read
bool is_deck(const std::filesystem::path& file);

/// Reads it by read_nastran or read_abaqus. @param allow_losses  read on past what would change stiffness or mass
Deck read_deck(const std::filesystem::path& file, bool allow_losses);

}  // namespace tenon::fem
