#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assembly/scene.hpp"
#include "fem/formats/deck.hpp"

/// What the word after a command names.
namespace tenon::cli {

enum class InputKind { scene, deck, mesh };

/// Scenes by their extension (.yaml, .yml, .json), decks as fem::is_deck tells them; all else is left to the mesh
/// readers. Throws InputError when there is no such file, with near misses of its folder.
InputKind kind_of(const std::filesystem::path& file);

/// A deck in its own units; losses that would change the physics must stand in `allow`.
fem::Deck read_deck(const std::filesystem::path& file, const std::vector<std::string>& allow);

/// What was read past of a mesh, and its solids, which only `matrices:` brings into a scene.
std::vector<fem::Loss> losses_of(const fem::Mesh& mesh);

/// Losses as lines for people.
std::vector<std::string> loss_lines(const std::vector<fem::Loss>& losses);

}  // namespace tenon::cli
