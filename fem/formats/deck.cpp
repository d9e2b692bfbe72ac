#include "fem/formats/deck.hpp"

#include "fem/formats/abaqus.hpp"
#include "fem/formats/extension.hpp"
#include "fem/formats/nastran.hpp"

namespace tenon::fem {
namespace {

/// A name without a file, in a scene that is only being read, is taken at its word.
bool gives_sections(const std::filesystem::path& file) {
  std::error_code error;
  return !std::filesystem::is_regular_file(file, error) || nastran_gives_sections(file);
}

}  // namespace

bool is_deck(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".inp") return abaqus_gives_sections(file);
  return is_nastran(extension) && gives_sections(file);
}

Deck read_deck(const std::filesystem::path& file, bool allow_losses) {
  if (lower_extension(file) == ".inp") {
    AbaqusDeck deck = read_abaqus(file, {.allow_losses = allow_losses});
    return {std::move(deck.mesh), std::move(deck.model)};
  }
  NastranDeck deck = read_nastran(file, {.allow_losses = allow_losses, .spc_set = {}, .mpc_set = {}});
  return {std::move(deck.mesh), std::move(deck.model), deck.mass_factor, deck.auto_spc};
}

}  // namespace tenon::fem
