#include <fmt/format.h>

#include "fem/formats/read_mesh.hpp"
#include "interfaces/cli/check_mesh.hpp"
#include "interfaces/cli/findings.hpp"
#include "interfaces/cli/input.hpp"

namespace tenon::cli {

int check_mesh(const CheckOptions& options, bool deck) {
  std::vector<Subjected> findings;
  std::vector<std::string> losses;
  fem::MassProperties mass;
  std::size_t nodes = 0;
  std::vector<fem::Finding> found;
  if (deck) {
    const fem::Model model = read_deck(options.input, options.allow).model;
    losses = loss_lines(model.losses);
    nodes = model.nodes.size();
    mass = fem::geometric_mass_properties(model);
    found = fem::check_model(model);
  } else {
    const fem::Mesh mesh = fem::read_mesh(options.input);
    losses = loss_lines(losses_of(mesh));
    nodes = mesh.points.size();
    found = fem::check_mesh(mesh);
  }
  const std::string subject = options.input.filename().string();
  for (fem::Finding& finding : found) findings.push_back({subject, std::move(finding)});
  if (options.json) {
    Json object{{"source", options.input.string()}, {"nodes", nodes}};
    if (deck) object["mass_file_units"] = mass.mass;
    object["read_past"] = losses;
    object["checks"] = to_json(findings);
    object["good"] = good(findings);
    print(object);
  } else {
    print(fmt::format("{}: {} nodes{}", options.input.string(), nodes,
                      deck ? fmt::format(", mass {:.6g} in the deck's units", mass.mass)
                           : "; a mesh alone: no sections, so no stiffness and no mass are looked at"));
    print_people(findings);
    for (const std::string& line : losses) print(wrapped(fmt::format("read past: {}", line), 4));
  }
  return good(findings) ? done : check_failed;
}

}  // namespace tenon::cli
