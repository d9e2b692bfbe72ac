#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "assembly/scene/read.hpp"
#include "fem/error.hpp"
#include "fem/section_shapes.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "interfaces/report/svg.hpp"
#include "titop/beam_study.hpp"

namespace tenon::cli {
namespace {

using titop::BeamConvergence;
using titop::BeamStudy;
using titop::BeamStudyEntry;
using titop::End;
using titop::Ends;

const std::vector<std::string> end_names{"clamped", "free", "pinned", "sliding"};

End end_of(const std::string& word) {
  const auto at = std::find(end_names.begin(), end_names.end(), word);
  if (at == end_names.end()) {
    const std::string near = fem::near_miss(word, end_names);
    throw InputError({"--bc"}, fmt::format("'{}' is no end of a beam", word),
                     near.empty() ? "Ends are clamped, free, pinned and sliding: --bc clamped-free"
                                  : fmt::format("Did you mean '{}'?", near));
  }
  return static_cast<End>(at - end_names.begin());
}

std::vector<Ends> cases_of(const BeamOptions& options) {
  if (options.bc.empty()) return titop::paper_cases();
  const std::size_t dash = options.bc.find('-');
  if (dash == std::string::npos)
    throw InputError({"--bc"}, fmt::format("'{}' does not name two ends", options.bc), "Write e.g. clamped-free");
  return {{end_of(options.bc.substr(0, dash)), end_of(options.bc.substr(dash + 1))}};
}

std::vector<double> sizes_of(const std::string& text, std::size_t colon, std::size_t count) {
  std::vector<double> sizes;
  std::string rest = text.substr(colon + 1);
  for (std::size_t comma = 0; comma != std::string::npos; rest.erase(0, comma + 1)) {
    comma = rest.find(',');
    char* end = nullptr;
    const std::string word = rest.substr(0, comma);
    sizes.push_back(std::strtod(word.c_str(), &end));
    if (word.empty() || *end != '\0' || !(sizes.back() > 0.0)) sizes.back() = -1.0;
    if (comma == std::string::npos) break;
  }
  if (sizes.size() != count || *std::min_element(sizes.begin(), sizes.end()) <= 0.0)
    throw InputError({"--section"}, fmt::format("'{}' does not give {} sizes above zero", text, count),
                     "Write circle:R, tube:OUTER,INNER, rectangle:B,H (bends along B) or general:A,I, in metres");
  return sizes;
}

/// A and I of the plane of bending, x-y.
std::pair<double, double> section_of(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string shape = text.substr(0, colon);
  fem::BeamSection section;
  if (shape == "circle") {
    section = fem::circle(sizes_of(text, colon, 1)[0], 0.3);
  } else if (shape == "tube") {
    const auto s = sizes_of(text, colon, 2);
    section = fem::tube(s[0], s[1], 0.3);
  } else if (shape == "rectangle") {
    const auto s = sizes_of(text, colon, 2);
    section = fem::rectangle(s[0], s[1], 0.3);
  } else if (shape == "general") {
    const auto s = sizes_of(text, colon, 2);
    return {s[0], s[1]};
  } else {
    const std::string near = fem::near_miss(shape, {"circle", "tube", "rectangle", "general"});
    throw InputError(
        {"--section"}, fmt::format("there is no shape '{}'", shape),
        near.empty() ? "Shapes are circle, tube, rectangle and general" : fmt::format("Did you mean '{}'?", near));
  }
  return {section.A, section.Iz};
}

/// √(EI/ρSl⁴) of the user's beam [rad/s]; 1 when none is given.
double unit_of(const BeamOptions& options) {
  const int given = (options.length > 0.0) + !options.section.empty() + !options.material.empty();
  if (given == 0) return 1.0;
  if (given < 3)
    throw InputError({"--length, --section, --material"}, "a beam needs all three",
                     "E.g. --length 2 --section tube:0.05,0.046 --material aluminium");
  assembly::Value name;
  name.kind = assembly::Value::Kind::scalar;
  name.text = options.material;
  name.place = {"--material"};
  const fem::Material material = assembly::Materials(nullptr, {}).read(name);
  const auto [A, I] = section_of(options.section);
  return titop::bending_unit(material.E, I, material.rho, A, options.length);
}

std::string percent(const std::optional<double>& omega, const BeamStudyEntry& e) {
  return omega ? fmt::format("{:.2g}", 100.0 * titop::frequency_error(*omega, e.ends, e.mode)) : "refused";
}

Json to_json(const BeamStudy& s, const std::vector<BeamConvergence>& curves, double unit) {
  Json object{{"unit_rad_s", unit}, {"bases", s.bases}, {"cases", Json::array()}};
  for (const BeamStudyEntry& e : s.entries) {
    Json values = Json::array();
    for (const auto& value : e.omega) values.push_back(value ? Json(hertz(unit * *value)) : Json());
    object["cases"].push_back({{"ends", titop::name(e.ends.P) + "-" + titop::name(e.ends.C)},
                               {"mode", e.mode},
                               {"reference_hz", hertz(unit * e.exact)},
                               {"frequencies_hz", values}});
  }
  for (const auto& [n, omega] : titop::inverse_of_clamped_free())
    object["inverse_of_clamped_free_modes"].push_back({{"modes", n}, {"omega_normalised", {omega[0], omega[1]}}});
  for (const BeamConvergence& c : curves)
    object["convergence"].push_back(
        {{"against", c.against}, {"number", c.number}, {"relative_error_per_mode", c.error}});
  return object;
}

report::Plot picture(const std::vector<BeamConvergence>& curves, const Ends& ends) {
  report::Plot plot{
      .title = fmt::format("Beam {}-{}: error of the lowest modes", titop::name(ends.P), titop::name(ends.C)),
      .x_label = "finite elements, or modes kept beside constraint and inertia-relief shapes",
      .y_label = "relative error of the frequency",
      .curves = {}};
  for (const BeamConvergence& c : curves)
    for (std::size_t m = 0; m < c.error.size(); ++m)
      plot.curves.push_back({fmt::format("mode {}, {}", m + 1, c.against), c.number, c.error[m]});
  return plot;
}

void print_people(const BeamStudy& s, const std::vector<BeamConvergence>& curves, double unit,
                  const BeamOptions& options) {
  const bool own = unit != 1.0;
  print(own ? fmt::format("Bending in one plane: 1 = {:.6g} Hz (Euler-Bernoulli; shear and rotary inertia neglected)",
                          hertz(unit))
            : std::string("Bending of a uniform Euler-Bernoulli beam, frequencies in units of √(EI/ρSl⁴)"));
  std::vector<std::string> heads{"<case", "mode", own ? "exact [Hz]" : "exact", s.bases[0], "error [%]"};
  for (std::size_t b = 1; b < s.bases.size(); ++b) heads.push_back(s.bases[b] + " [%]");
  Table table(heads);
  for (const BeamStudyEntry& e : s.entries) {
    const auto text = [&](double omega) { return fmt::format("{:.6g}", own ? hertz(unit * omega) : omega); };
    std::vector<std::string> row{titop::name(e.ends.P) + "-" + titop::name(e.ends.C), std::to_string(e.mode),
                                 text(e.exact), e.omega[0] ? text(*e.omega[0]) : "refused", percent(e.omega[0], e)};
    for (std::size_t b = 1; b < s.bases.size(); ++b) row.push_back(percent(e.omega[b], e));
    table.row(std::move(row));
  }
  print(table);
  print(wrapped(fmt::format(
      "First port named first. G_pol: the quintic shapes of the TITOP paper (4 flexible shapes). CB, CB+IR: {} finite "
      "elements reduced to constraint shapes, {} fixed-interface modes and, with IR, inertia-relief shapes.",
      options.elements, options.modes)));
  if (!options.bc.empty()) {
    for (const BeamConvergence& c : curves) {
      Table numbers({c.against, "mode 1", "mode 2", "mode 3"});
      for (std::size_t k = 0; k < c.number.size(); ++k)
        numbers.row({fmt::format("{}", c.number[k]), fmt::format("{:.1e}", c.error[0][k]),
                     fmt::format("{:.1e}", c.error[1][k]), fmt::format("{:.1e}", c.error[2][k])});
      print(fmt::format("\n  Error against the number of {}", c.against));
      print(numbers);
    }
    return;
  }
  Table inverse({"clamped-free modes", "free-clamped 1", "free-clamped 2"});
  for (const auto& [n, omega] : titop::inverse_of_clamped_free())
    inverse.row({std::to_string(n), fmt::format("{:.5f}", omega[0]), fmt::format("{:.4f}", omega[1])});
  print("\n  Inverse of the model of n clamped-free modes, table 1 (exact: 3.51602, 22.0345)");
  print(inverse);
  print(wrapped(
      "The paper prints 4.4432/27.486, 3.9084/24.579 and 3.7508/23.585 for n = 4, 8 and 16; these are wrong, the "
      "values above come from channel inversion and from a null-space route alike."));
}

}  // namespace

int run(const BeamOptions& options) {
  const double unit = unit_of(options);
  const std::vector<Ends> cases = cases_of(options);
  const BeamStudy s = titop::beam_study(cases, options.modes, options.elements);
  std::vector<BeamConvergence> curves;
  const Ends shown = cases.front();
  if (!options.bc.empty() || !options.svg.empty() || options.json)
    curves = {titop::convergence_with_elements(shown, options.elements),
              titop::convergence_with_modes(shown, options.modes)};
  if (!options.svg.empty()) report::write_svg(options.svg, picture(curves, shown));
  if (options.json) {
    print(to_json(s, curves, unit));
    return done;
  }
  print_people(s, curves, unit, options);
  if (!options.svg.empty()) print(fmt::format("Written: {}", options.svg.string()));
  return done;
}

}  // namespace tenon::cli
