#include "fem/formats/abaqus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem {
namespace abaqus {
namespace {

/// What the steps of the reader understand.
const std::set<std::string> understood{"NODE",           "ELEMENT",
                                       "NSET",           "ELSET",
                                       "TRANSFORM",      "MATERIAL",
                                       "ELASTIC",        "DENSITY",
                                       "BEAM SECTION",   "BEAM GENERAL SECTION",
                                       "SHELL SECTION",  "MASS",
                                       "ROTARY INERTIA", "SPRING",
                                       "SOLID SECTION",  "MEMBRANE SECTION",
                                       "GASKET SECTION", "SURFACE SECTION",
                                       "FLUID SECTION",  "RIGID BODY",
                                       "COUPLING",       "KINEMATIC",
                                       "DISTRIBUTING",   "MPC",
                                       "EQUATION",       "BOUNDARY",
                                       "HEADING",        "SURFACE"};

struct Harmless {
  const char* keyword;
  const char* note;
};

constexpr const char* analysis = "loads, steps and output of an analysis";
constexpr const char* of_material = "a property that the linear K and M do not use";
constexpr const char* naming = "names and bookkeeping";

// by the words that a keyword begins with
constexpr std::array harmless{
    Harmless{"STEP", analysis},
    Harmless{"END STEP", analysis},
    Harmless{"FREQUENCY", analysis},
    Harmless{"STATIC", analysis},
    Harmless{"DYNAMIC", analysis},
    Harmless{"BUCKLE", analysis},
    Harmless{"MODAL DYNAMIC", analysis},
    Harmless{"STEADY STATE", analysis},
    Harmless{"COMPLEX FREQUENCY", analysis},
    Harmless{"HEAT TRANSFER", analysis},
    Harmless{"COUPLED TEMPERATURE", analysis},
    Harmless{"UNCOUPLED TEMPERATURE", analysis},
    Harmless{"VISCO", analysis},
    Harmless{"RANDOM RESPONSE", analysis},
    Harmless{"PSD-DEFINITION", analysis},
    Harmless{"CORRELATION", analysis},
    Harmless{"MATRIX GENERATE", analysis},
    Harmless{"MATRIX OUTPUT", analysis},
    Harmless{"SECTION CONTROLS", "control of reduced integration, which these elements do without"},
    Harmless{"GREEN", analysis},
    Harmless{"SUBSTRUCTURE", analysis},
    Harmless{"SELECT", analysis},
    Harmless{"RETAINED", analysis},
    Harmless{"SENSITIVITY", analysis},
    Harmless{"DESIGN", analysis},
    Harmless{"DESIGNVARIABLES", analysis},
    Harmless{"OBJECTIVE", analysis},
    Harmless{"CLOAD", analysis},
    Harmless{"DLOAD", analysis},
    Harmless{"DSLOAD", analysis},
    Harmless{"CFLUX", analysis},
    Harmless{"DFLUX", analysis},
    Harmless{"FILM", analysis},
    Harmless{"RADIATE", analysis},
    Harmless{"TEMPERATURE", analysis},
    Harmless{"AMPLITUDE", analysis},
    Harmless{"TIME POINTS", analysis},
    Harmless{"INITIAL CONDITIONS", analysis},
    Harmless{"CONTROLS", analysis},
    Harmless{"RESTART", analysis},
    Harmless{"NODE FILE", analysis},
    Harmless{"NODE OUTPUT", analysis},
    Harmless{"NODE PRINT", analysis},
    Harmless{"EL FILE", analysis},
    Harmless{"EL PRINT", analysis},
    Harmless{"ELEMENT OUTPUT", analysis},
    Harmless{"CONTACT FILE", analysis},
    Harmless{"CONTACT PRINT", analysis},
    Harmless{"CONTACT OUTPUT", analysis},
    Harmless{"SECTION PRINT", analysis},
    Harmless{"OUTPUT", analysis},
    Harmless{"FIELD OUTPUT", analysis},
    Harmless{"HISTORY OUTPUT", analysis},
    Harmless{"ENERGY", analysis},
    Harmless{"MODAL DAMPING", analysis},
    Harmless{"BASE MOTION", analysis},
    Harmless{"PREPRINT", naming},
    Harmless{"FILE FORMAT", naming},
    Harmless{"SYSTEM OF UNITS", naming},
    Harmless{"PHYSICAL CONSTANTS", of_material},
    Harmless{"VALUES AT INFINITY", of_material},
    Harmless{"DAMPING", of_material},
    Harmless{"EXPANSION", of_material},
    Harmless{"CONDUCTIVITY", of_material},
    Harmless{"SPECIFIC HEAT", of_material},
    Harmless{"SPECIFIC GAS", of_material},
    Harmless{"FLUID CONSTANTS", of_material},
    Harmless{"PLASTIC", of_material},
    Harmless{"CREEP", of_material},
    Harmless{"CYCLIC HARDENING", of_material},
    Harmless{"DEFORMATION PLASTICITY", of_material},
    Harmless{"DASHPOT", "dampers are no part of K and M"},
    Harmless{"ORIENTATION", "axes of springs, which are read, and of materials: isotropic ones do not depend on them"},
    Harmless{"PART", naming},
    Harmless{"END PART", naming},
    Harmless{"ASSEMBLY", naming},
    Harmless{"END ASSEMBLY", naming},
    Harmless{"END INSTANCE", naming},
    Harmless{"CONSTRAINT", naming}};

const char* harmless_note(const std::string& keyword) {
  const auto begins = [&](const Harmless& h) {
    const std::size_t length = std::string_view(h.keyword).size();
    return keyword.starts_with(h.keyword) &&
           (keyword.size() == length || !std::isalnum(static_cast<unsigned char>(keyword[length])));
  };
  const auto found = std::ranges::find_if(harmless, begins);
  return found == harmless.end() ? nullptr : found->note;
}

/// Without what they make the deck is another one.
void refuse_generators(const Draft& draft) {
  for (const Block& block : draft.text.blocks)
    if (block.has("INPUT") && understood.contains(block.keyword))
      block.refuse(fmt::format("*{}, INPUT= of another file is not read", block.keyword), "Bring it in by *INCLUDE");
  static const std::set<std::string> generators{"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "PARAMETER"};
  for (const Block& block : draft.text.blocks)
    if (generators.contains(block.keyword))
      block.refuse(fmt::format("*{} makes parts of the deck by rule, which is not read", block.keyword),
                   "Write the nodes and elements out, as pre-processors do");
}

}  // namespace

void classify_rest(Draft& draft) {
  for (const Block& block : draft.text.blocks) {
    if (understood.contains(block.keyword) || block.keyword == "INSTANCE") continue;
    const std::string name = "*" + block.keyword;
    if (const char* const note = harmless_note(block.keyword))
      draft.losses.add(name, note);
    else
      draft.losses.add_physical(name, "it is not known here and may carry stiffness or mass", block.place);
  }
}

}  // namespace abaqus

bool abaqus_gives_sections(const std::filesystem::path& path) {
  const abaqus::Text text = abaqus::read_text(path);
  return std::ranges::any_of(text.blocks, [](const abaqus::Block& block) {
    return block.keyword.ends_with("SECTION") || block.keyword == "MASS" || block.keyword == "ROTARY INERTIA" ||
           block.keyword == "SPRING";
  });
}

AbaqusDeck read_abaqus(const std::filesystem::path& path, const AbaqusOptions& options) {
  using namespace abaqus;
  Draft draft;
  draft.text = read_text(path);
  AbaqusDeck& deck = draft.deck;
  deck.mesh.source = deck.model.source = path.string();
  deck.mesh.format = "abaqus / calculix input";
  for (const Block& block : draft.text.blocks)
    if (DataLines line(block); block.keyword == "HEADING" && line.next() && deck.title.empty())
      deck.title = std::string(line.at(0));

  refuse_generators(draft);
  place_parts(draft);
  read_nodes(draft);
  if (deck.mesh.points.empty())
    throw InputError({path.string(), 0, 0}, "the deck defines no node (*NODE)",
                     "Check that it is the right file and names its *INCLUDE files");
  read_elements(draft);
  read_sets(draft);
  read_transforms(draft);
  read_materials(draft);
  read_sections(draft);
  if (deck.has_sections) {
    read_links(draft);
    read_supports(draft);
  } else {
    for (const Block& block : draft.text.blocks)
      for (const char* of_model : {"BOUNDARY", "EQUATION", "MPC", "RIGID BODY", "COUPLING"})
        if (block.keyword == of_model)
          draft.losses.add("*" + block.keyword,
                           "supports and links of a mesh without sections: a scene states its own");
  }
  classify_rest(draft);
  if (!options.allow_losses && deck.has_sections) draft.losses.refuse_physical();
  deck.mesh.losses = deck.model.losses = draft.losses.losses();
  return std::move(draft.deck);
}

}  // namespace tenon::fem
