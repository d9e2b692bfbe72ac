#include "interfaces/cli/input.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/error.hpp"

namespace tenon::cli {

InputKind kind_of(const std::filesystem::path& file) {
  std::error_code fault;
  if (std::filesystem::is_directory(file, fault))
    throw InputError({file.string()}, "this is a folder", "Name a file in it");
  if (!std::filesystem::is_regular_file(file, fault)) {
    std::vector<std::string> names;
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    for (const auto& entry : std::filesystem::directory_iterator(folder, fault))
      names.push_back(entry.path().filename().string());
    const std::string near = fem::near_miss(file.filename().string(), names);
    throw InputError({file.string()}, "there is no such file",
                     near.empty() ? "Check the name and the folder" : fmt::format("Did you mean '{}'?", near));
  }
  const std::string extension = file.extension().string();
  if (extension == ".yaml" || extension == ".yml" || extension == ".json") return InputKind::scene;
  return fem::is_deck(file) ? InputKind::deck : InputKind::mesh;
}

fem::Deck read_deck(const std::filesystem::path& file, const std::vector<std::string>& allow) {
  fem::Deck deck = fem::read_deck(file, !allow.empty());
  for (const fem::Loss& loss : deck.model.losses)
    if (loss.changes_physics && std::find(allow.begin(), allow.end(), loss.name) == allow.end())
      throw InputError(
          {file.string()},
          fmt::format("{} would be read past, and it carries stiffness or mass ({})", loss.name, loss.note),
          fmt::format("Take it out of the file, or accept the loss with --allow {}", loss.name));
  return deck;
}

std::vector<fem::Loss> losses_of(const fem::Mesh& mesh) {
  std::vector<fem::Loss> losses = mesh.losses;
  const auto named = [](const fem::Loss& loss) { return loss.note == fem::own_matrices; };
  if (std::ranges::any_of(losses, named)) return losses;  // by the file's own names
  for (const fem::CellBlock& block : mesh.cells)
    if (fem::dimension(block.type) == 3)
      losses.push_back({std::string(fem::name(block.type)), block.size(), fem::own_matrices, true});
  return losses;
}

std::vector<std::string> loss_lines(const std::vector<fem::Loss>& losses) {
  std::vector<std::string> lines;
  for (const fem::Loss& loss : losses)
    lines.push_back(fmt::format("{} × {}{}{}", loss.count, loss.name, loss.note.empty() ? "" : ": " + loss.note,
                                loss.changes_physics ? " (carries stiffness or mass)" : ""));
  return lines;
}

}  // namespace tenon::cli
