#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "fem/formats/nastran/draft.hpp"
#include "fem/formats/nastran/element_cells.hpp"

namespace tenon::fem {
namespace nastran {
namespace {

/// A card of elements that name a property: EID, PID, then their grids.
struct ElementCard {
  const char* name;
  CellType type;
  int harmless;  ///< fields behind the grids that say no more than axes, which sections of a scene give
};

constexpr std::array<ElementCard, 10> element_cards{{{"CBAR", CellType::line, 4},
                                                     {"CBEAM", CellType::line, 4},
                                                     {"CROD", CellType::line, 0},
                                                     {"CTUBE", CellType::line, 0},
                                                     {"CQUAD4", CellType::quad, 1},
                                                     {"CQUADR", CellType::quad, 1},
                                                     {"CTRIA3", CellType::triangle, 1},
                                                     {"CTRIAR", CellType::triangle, 1},
                                                     {"CQUAD8", CellType::quad8, 0},
                                                     {"CTRIA6", CellType::triangle6, 1}}};

/// Solids too may stand in a mesh: they become losses.
constexpr std::array<std::string_view, 17> beside_elements{
    "GRID",  "GRDSET", "CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S",  "CTETRA",
    "CHEXA", "CPENTA", "CPYRAM", "PLOTEL", "PARAM",  "CEND",   "BEGIN",  "ENDDATA",
};

/// The name of a card or statement that a line begins with; empty for continuations, comments and blank lines.
std::string_view first_word(std::string_view line) {
  const std::size_t end = std::min(line.find_first_of(" \t,*=$\r"), line.size());
  const std::string_view word = line.substr(0, std::min<std::size_t>(end, 8));
  return word.starts_with('+') ? std::string_view() : word;
}

/// Whether `name`, in capitals, is that word in any.
bool is(std::string_view name, std::string_view word) {
  return std::ranges::equal(name, word, [](char a, char b) { return a == (b >= 'a' && b <= 'z' ? b - 'a' + 'A' : b); });
}

/// Offsets, pin flags, thicknesses at corners: what the scene would not know of.
void note_rest(Draft& draft, const Card& card, const ElementCard& kind, int first) {
  const auto says_something = [&](int i) {
    const std::optional<double> number = parse_real(card.at(i));
    return !card.blank(i) && !(number && *number == 0.0);
  };
  for (int i = first; i < first + kind.harmless; ++i)
    if (says_something(i)) {
      draft.losses.add(std::string(kind.name) + " axes", "of bars and materials: the scene's sections give them");
      break;
    }
  for (int i = first + kind.harmless; i <= card.size(); ++i)
    if (says_something(i)) {
      draft.losses.add_physical(std::string(kind.name) + " behind its grids",
                                "offsets, pin flags or thicknesses, in a file that gives no properties", card.place(i));
      break;
    }
}

void read_cells(Draft& draft) {
  ElementCells cells;
  Register known("element");
  std::array<int, 8> nodes{};
  for (const ElementCard& kind : element_cards)
    for (const Card& card : draft.take(kind.name)) {
      const long id = card.id(1, "EID");
      if (!known.admit(id, card, draft.losses)) continue;
      const auto count = static_cast<std::size_t>(node_count(kind.type));
      for (std::size_t i = 0; i < count; ++i) {
        const int field = 3 + static_cast<int>(i);
        nodes[i] = draft.node(card, field, "G");
        if (std::find(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(i), nodes[i]) !=
            nodes.begin() + static_cast<std::ptrdiff_t>(i))
          card.refuse(field, fmt::format("{} names GRID {} twice", id, card.at(field)),
                      "Give every place a grid of its own");
      }
      const auto block =
          static_cast<std::size_t>(std::ranges::find(ElementCells::types, kind.type) - ElementCells::types.begin());
      const std::string set = card.blank(2) ? std::string() : fmt::format("property {}", card.id(2, "PID"));
      cells.add(block, std::span(nodes).first(count), id, set);
      note_rest(draft, card, kind, 3 + static_cast<int>(count));
    }
  cells.finish(draft.deck.mesh);
}

}  // namespace
}  // namespace nastran

bool nastran_gives_sections(const std::filesystem::path& path) {
  using namespace nastran;
  const MappedFile file(path);
  std::string_view text = without_byte_order_mark(file.bytes());
  bool elements = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view word = first_word(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    const bool element = std::ranges::any_of(element_cards, [&](const ElementCard& e) { return is(e.name, word); });
    elements = elements || element;
    if (!element && std::ranges::none_of(beside_elements, [&](std::string_view name) { return is(name, word); }))
      return true;
  }
  return !elements;
}

Mesh read_nastran_mesh(const std::filesystem::path& path) {
  using namespace nastran;
  const Text text = read_text(path);
  Draft draft;
  Mesh& mesh = draft.deck.mesh;
  mesh.source = draft.deck.model.source = path.string();
  mesh.format = "nastran bulk data without properties";
  sort_cards(text, draft);
  read_grids(draft);
  read_cells(draft);
  if (std::ranges::any_of(draft.permanent_spc, [](unsigned held) { return held != 0; }))
    draft.losses.add_physical("GRID PS", "supports, in a file that gives no properties: `fix` of the scene holds nodes",
                              {path.string(), 0, 0});
  for (const Card& card : draft.take("PARAM"))
    draft.losses.add("PARAM " + upper(card.at(1)), "the file gives no properties that it could mean");
  classify_rest(draft);
  mesh.losses = draft.losses.losses();
  return std::move(mesh);
}

}  // namespace tenon::fem
