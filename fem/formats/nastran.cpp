#include "fem/formats/nastran.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem {
namespace nastran {
namespace {

/// "SPC = 3" → {"SPC", "3"}, "METHOD(STRUCTURE)=1" → {"METHOD", "1"}, "SUBCASE 2" → {"SUBCASE", "2"}.
struct Assignment {
  std::string key, value;
};

Assignment assignment(const std::string& statement) {
  const std::size_t key_end = statement.find_first_of(" \t=(,");
  Assignment result{upper(statement.substr(0, key_end)), {}};
  if (key_end == std::string::npos) return result;
  const std::size_t equals = statement.find('=');
  result.value =
      std::string(trim(std::string_view(statement).substr(equals == std::string::npos ? key_end : equals + 1)));
  return result;
}

/// Nastran looks at the first four letters of a command.
bool is_command(const Assignment& a, std::string_view command) {
  return std::string_view(a.key).substr(0, 4) == command.substr(0, 4);
}

/// A set that case control selects: for all subcases alike, or not at all.
std::optional<Choice> choice(const Text& text, const std::string& key) {
  std::optional<Choice> global;
  std::vector<std::optional<Choice>> subcases;
  for (const CaseStatement& statement : text.case_control) {
    const Assignment a = assignment(statement.text);
    if (is_command(a, "SUBCASE") || is_command(a, "SUBCOM")) subcases.push_back(global);
    if (!is_command(a, key)) continue;
    const auto set = parse_integer(a.value);
    if (!set || *set <= 0)
      throw InputError(statement.place, fmt::format("found {} = '{}', expected the number of a set", key, a.value),
                       fmt::format("Write {} = number", key));
    (subcases.empty() ? global : subcases.back()) = Choice{*set, statement.place};
  }
  if (subcases.empty()) return global;
  const auto number = [](const std::optional<Choice>& c) { return c ? c->set : 0; };
  for (const auto& subcase : subcases)
    if (number(subcase) != number(subcases.front())) {
      const Choice& named = subcase ? *subcase : *subcases.front();
      throw InputError(
          named.place,
          fmt::format("the subcases select different {} sets ({} and {}, 0 is none): which model is meant?", key,
                      number(subcases.front()), number(subcase)),
          fmt::format("Keep one subcase, or one {} for all", key));
    }
  return subcases.front();
}

/// Statements of case control that add matrices or stress stiffness.
void refuse_direct_input(Draft& draft, const Text& text) {
  for (const CaseStatement& statement : text.case_control) {
    const Assignment a = assignment(statement.text);
    for (const char* bad : {"K2GG", "M2GG", "K2PP", "M2PP", "STATSUB"})
      if (is_command(a, bad))
        draft.losses.add_physical(std::string("case control ") + bad, "it adds to stiffness or mass", statement.place);
  }
}

/// Whether materials take values at a temperature: TEMPERATURE(MATERIAL), (INITIAL), (BOTH).
bool selects_material_temperature(const Text& text) {
  return std::ranges::any_of(text.case_control, [](const CaseStatement& statement) {
    const std::size_t open = statement.text.find('(');
    if (!is_command(assignment(statement.text), "TEMPERATURE") || open == std::string::npos) return false;
    const std::string of = upper(std::string(trim(std::string_view(statement.text).substr(open + 1))).substr(0, 4));
    return of.starts_with("MAT") || of.starts_with("INI") || of.starts_with("BOT");
  });
}

/// PARAM cards, and PARAM statements of case control: name, value, place.
struct Parameter {
  std::string name, value;
  Place place;
};

std::vector<Parameter> parameters(Draft& draft, const Text& text) {
  std::vector<Parameter> all;
  for (const Card& card : draft.take("PARAM"))
    all.push_back({upper(card.at(1)), std::string(card.at(2)), card.place(2)});
  for (const CaseStatement& statement : text.case_control) {
    if (assignment(statement.text).key != "PARAM") continue;
    std::array<std::string, 3> words;
    std::size_t n = 0;
    for (const char c : statement.text) {
      if ((c == ',' || c == '=') && n < 2)
        ++n;
      else if (!std::isspace(static_cast<unsigned char>(c)))
        words[n] += c;
    }
    if (words[1].empty() || words[2].empty())
      throw InputError(statement.place, fmt::format("found '{}', expected PARAM, name, value", statement.text),
                       "Write commas between the three");
    all.push_back({upper(words[1]), words[2], statement.place});
  }
  return all;
}

std::string note_on(const std::string& parameter) {
  if (parameter == "AUTOSPC")
    return "`tenon modes` of the deck holds what has no stiffness, a body in a scene does not";
  if (parameter == "GRDPNT") return "mass, centre and inertia are always available";
  if (parameter == "K6ROT") return "the drilling stiffness of shells is the program's own";
  return "no effect on K and M";
}

void read_parameters(Draft& draft, const Text& text) {
  std::map<std::string, Parameter> used;
  for (const Parameter& p : parameters(draft, text)) {
    if (p.name == "AUTOSPC") draft.deck.auto_spc = upper(p.value) != "NO";
    if (p.name != "COUPMASS" && p.name != "WTMASS") {
      draft.losses.add("PARAM " + p.name, note_on(p.name));
      continue;
    }
    const auto value = parse_real(p.value);
    if (!value || (p.name == "WTMASS" && !(*value > 0.0)))
      throw InputError(p.place,
                       fmt::format("PARAM {} is '{}', expected a number{}", p.name, p.value,
                                   p.name == "WTMASS" ? " above zero" : ""),
                       "Correct the parameter's value");
    const auto [earlier, added] = used.try_emplace(p.name, p);
    if (!added && *parse_real(earlier->second.value) != *value)
      throw InputError(p.place,
                       fmt::format("PARAM {} is {} here but {} at {}", p.name, p.value, earlier->second.value,
                                   to_string(earlier->second.place)),
                       "Keep one of the two");
    if (p.name == "COUPMASS") draft.deck.coupled_mass = *value > 0.0;
    if (p.name == "WTMASS") draft.deck.mass_factor = *value;
  }
}

void scale_masses(NastranDeck& deck) {
  const double factor = deck.mass_factor;
  for (Material& material : deck.model.materials) material.rho *= factor;
  for (BeamSection& section : deck.model.beam_sections) section.nsm *= factor;
  for (ShellSection& section : deck.model.shell_sections) {
    section.nsm *= factor;
    for (Ply& ply : section.plies) ply.rho *= factor;
  }
  for (Element& element : deck.model.elements)
    if (PointMass* p = std::get_if<PointMass>(&element)) {
      p->mass *= factor;
      p->inertia *= factor;
    }
}

}  // namespace
}  // namespace nastran

NastranDeck read_nastran(const std::filesystem::path& path, const NastranOptions& options) {
  using namespace nastran;
  const Text text = read_text(path);
  Draft draft;
  NastranDeck& deck = draft.deck;
  deck.mesh.source = deck.model.source = path.string();
  deck.mesh.format = "nastran bulk data";
  sort_cards(text, draft);
  for (const CaseStatement& statement : text.case_control)
    if (const Assignment a = assignment(statement.text); is_command(a, "TITLE") && deck.title.empty())
      deck.title = a.value;
  if (text.has_case_control && !text.ended)
    draft.losses.add_physical("ENDDATA", "it is missing: the file may be cut off, with cards lost", text.end);

  const Place chosen{path.string(), 0, 0};
  draft.selection.has_case_control = text.has_case_control;
  draft.selection.spc = options.spc_set ? Choice{*options.spc_set, chosen} : choice(text, "SPC");
  draft.selection.mpc = options.mpc_set ? Choice{*options.mpc_set, chosen} : choice(text, "MPC");
  draft.selection.nsm = choice(text, "NSM");
  draft.selection.material_temperature = selects_material_temperature(text);
  refuse_direct_input(draft, text);

  read_parameters(draft, text);
  read_grids(draft);
  for (const SourceFile& file : text.files) file.pages.release(file.pages.bytes().size());
  if (deck.mesh.points.empty())
    throw InputError(chosen, "the deck defines no GRID", "Check that it is the right file and names its INCLUDE files");
  read_scalar_points(draft);
  read_elements(draft);
  lump_masses(draft);
  scale_masses(deck);
  read_links(draft);
  read_boundary(draft);
  read_supports(draft);
  read_equations(draft);
  classify_rest(draft);

  if (!options.allow_losses) draft.losses.refuse_physical();
  deck.mesh.losses = deck.model.losses = draft.losses.losses();
  return std::move(draft.deck);
}

}  // namespace tenon::fem
