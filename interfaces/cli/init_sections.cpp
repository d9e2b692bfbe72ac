#include "interfaces/cli/init_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

#include "fem/error.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

/// Letters and digits that mean themselves: `null` and its like would not.
bool is_plain(const std::string& name) {
  static const std::set<std::string> words{"null", "true", "false", "yes", "no", "on", "off", "y", "n"};
  std::string lower;
  for (const unsigned char c : name) lower += static_cast<char>(std::tolower(c));
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) && !words.contains(lower) &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

constexpr const char* shell_words = "{shell: THICKNESS}";
constexpr const char* beam_words =
    "{tube: [OUTER, INNER]}  # radii; or circle, rectangle, box, i, channel, general; move to `ignore` if it is no "
    "structure";

struct NamedCells {
  std::string name;
  int dimension = 0;
  long count = 0;  ///< of cells of that dimension
  const std::vector<std::vector<int>>* blocks = nullptr;
};

/// Sets of lines and surfaces, in the order in which they take their cells.
std::vector<NamedCells> sets_of_cells(const fem::Mesh& mesh) {
  std::vector<NamedCells> sets;
  for (const auto& [name, blocks] : mesh.cell_sets) {
    NamedCells set{name, dimension_of(mesh, blocks), 0, &blocks};
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (fem::dimension(mesh.cells[b].type) == set.dimension) set.count += std::ssize(blocks[b]);
    if (set.dimension == 1 || set.dimension == 2) sets.push_back(set);
  }
  const auto rank = [](const NamedCells& s) {
    const bool numbered = std::isdigit(static_cast<unsigned char>(s.name.empty() ? ' ' : s.name.back())) != 0;
    return std::tuple(-s.count, numbered);
  };
  std::ranges::stable_sort(sets, {}, rank);
  return sets;
}

/// Which section each cell has: −1 none yet.
class Cover {
 public:
  explicit Cover(const fem::Mesh& mesh) : mesh_(mesh) {
    for (const fem::CellBlock& block : mesh.cells) owner_.emplace_back(static_cast<std::size_t>(block.size()), -1);
  }

  /// The section that has a cell of the set, or −1: then the set takes its cells.
  int take(const NamedCells& set, int section) {
    for (const int value : {-1, section})
      for (std::size_t b = 0; b < set.blocks->size(); ++b) {
        if (fem::dimension(mesh_.cells[b].type) != set.dimension) continue;
        for (const int cell : (*set.blocks)[b]) {
          int& owner = owner_[b][static_cast<std::size_t>(cell)];
          if (value < 0 && owner >= 0) return owner;
          owner = value;
        }
      }
    return -1;
  }

  /// Whether a cell of this dimension has no section.
  bool lacks(int dimension) const {
    for (std::size_t b = 0; b < owner_.size(); ++b)
      if (fem::dimension(mesh_.cells[b].type) == dimension && std::ranges::find(owner_[b], -1) != owner_[b].end())
        return true;
    return false;
  }

 private:
  const fem::Mesh& mesh_;
  std::vector<std::vector<int>> owner_;
};

}  // namespace

/// The highest dimension of a set's cells, 0 for points alone.
int dimension_of(const fem::Mesh& mesh, const std::vector<std::vector<int>>& blocks) {
  int dimension = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (!blocks[b].empty()) dimension = std::max(dimension, fem::dimension(mesh.cells[b].type));
  return dimension;
}

std::string quoted(const std::string& name, const std::filesystem::path& file) {
  if (is_plain(name)) return name;
  try {
    return Json(name).dump();
  } catch (const Json::exception&) {
    throw InputError({file.string()}, fmt::format("the name '{}' is no UTF-8 text, as a scene is", name),
                     "Rename it in letters without accents, or save the file as UTF-8");
  }
}

std::string section_lines(const fem::Mesh& mesh, const std::filesystem::path& file) {
  const std::vector<NamedCells> sets = sets_of_cells(mesh);
  Cover cover(mesh);
  std::string text;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const NamedCells& set = sets[k];
    const char* const words = set.dimension == 2 ? shell_words : beam_words;
    if (const int owner = cover.take(set, static_cast<int>(k)); owner >= 0)
      text += fmt::format("      # {}: shares cells with {}\n", quoted(set.name, file),
                          quoted(sets[static_cast<std::size_t>(owner)].name, file));
    else
      text += fmt::format("      {}: {}\n", quoted(set.name, file), words);
  }
  const bool surfaces = cover.lacks(2), lines = cover.lacks(1);
  if (text.empty() && !surfaces && !lines)
    throw InputError({file.string()}, "holds neither lines nor surfaces, which beams and shells are made of",
                     "A part of solids comes in by the K and M of the program that owns it: `matrices:` of a scene");
  if (surfaces) text += fmt::format("      everywhere: {}\n", shell_words);
  if (!lines) return text;
  if (!surfaces && text.empty()) return fmt::format("      everywhere: {}\n", beam_words);
  return text +
         "    ignore: [everywhere]        # lines without a section above: name in the mesh those that are beams\n";
}

}  // namespace tenon::cli
