#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {
namespace {

/// `place`: where E1, E2, ν12, G12, G13, G23 stand among the numbers of one temperature, eight a line.
void lamina(const Block& block, const std::array<std::size_t, 6>& place, DraftMaterial& current) {
  constexpr std::array names{"E1", "E2", "ν12", "G12", "G13", "G23"};
  const auto read = [&](DataLines& line) {
    std::array<double, 6> values{};
    std::size_t first = 0;  // of the line at hand
    for (std::size_t i = 0; i < 6; ++i) {
      if (place[i] >= first + 8) {
        first += 8;
        if (!line.next()) block.refuse(fmt::format("*ELASTIC has no {}", names[i]), "Add the line that holds it");
      }
      values[i] = i == 2 ? line.real(place[i] - first, names[i]) : line.positive(place[i] - first, names[i]);
      if (i == 2 && !(values[2] * values[2] * values[1] < values[0]))
        line.fail(place[2] - first,
                  fmt::format("a ν12 below √(E1/E2) = {:.4g} in size", std::sqrt(values[0] / values[1])));
    }
    return values;
  };
  DataLines line(block);
  if (!line.next()) block.refuse("*ELASTIC has no data line", "Give E1, E2 and ν12");
  const auto [E1, E2, nu12, G12, G13, G23] = read(line);
  current.lamina = {.E1 = E1, .E2 = E2, .nu12 = nu12, .G12 = G12, .G13 = G13, .G23 = G23};
  while (line.next()) current.varies |= read(line) != std::array{E1, E2, nu12, G12, G13, G23};
}

void elastic(const Block& block, DraftMaterial& current) {
  const std::string type = block.upper_value("TYPE");
  if (!type.empty() && type != "ISO" && type != "ISOTROPIC") {
    current.isotropic = false;
    if (type == "LAMINA") lamina(block, {0, 1, 2, 3, 4, 5}, current);
    if (type == "ENGINEERING CONSTANTS" || type == "ENGINEERINGCONSTANTS") lamina(block, {0, 1, 3, 6, 7, 8}, current);
    return;
  }
  DataLines line(block);
  if (!line.next()) block.refuse("*ELASTIC has no data line", "Give E and ν");
  Material& m = current.material;
  m.E = line.positive(0, "Young's modulus");
  m.nu = line.real(1, "Poisson's ratio", 0.0);
  if (!(m.nu > -1.0 && m.nu <= 0.5)) line.fail(1, "Poisson's ratio above −1 and at most 0.5");
  m.G = 0.5 * m.E / (1.0 + m.nu);
  while (line.next())
    current.varies |= line.real(0, "Young's modulus") != m.E || line.real(1, "Poisson's ratio", 0.0) != m.nu;
}

void density(const Block& block, DraftMaterial& current) {
  DataLines line(block);
  if (!line.next()) block.refuse("*DENSITY has no data line", "Give the density");
  current.material.rho = line.real(0, "the density");
  if (!(current.material.rho >= 0.0)) line.fail(0, "a density that is not negative");
  while (line.next()) current.varies |= line.real(0, "the density") != current.material.rho;
}

}  // namespace

void read_materials(Draft& draft) {
  DraftMaterial* current = nullptr;
  bool has_elastic = false, has_density = false;
  for (const Block& block : draft.text.blocks) {
    if (block.keyword == "MATERIAL") {
      const std::string name = block.value("NAME");
      if (name.empty()) block.refuse("*MATERIAL has no NAME", "Write *MATERIAL, NAME=steel");
      const auto [entry, added] = draft.materials.try_emplace(upper(name), DraftMaterial{});
      if (!added)
        block.refuse(fmt::format("material '{}' stands already at {}", name, to_string(entry->second.place)),
                     "Give it a name of its own or remove one of the two");
      current = &entry->second;
      current->place = block.place;
      current->material.name = name;
      has_elastic = has_density = false;
    } else if (block.keyword == "ELASTIC" || block.keyword == "DENSITY") {
      if (!current) block.refuse(fmt::format("*{} stands under no *MATERIAL", block.keyword), "Put it behind one");
      if (bool& given = block.keyword == "ELASTIC" ? has_elastic : has_density; std::exchange(given, true))
        block.refuse(fmt::format("found a second *{} of material '{}'", block.keyword, current->material.name),
                     "Keep one of the two");
      block.keyword == "ELASTIC" ? elastic(block, *current) : density(block, *current);
    }
  }
}

}  // namespace tenon::fem::abaqus
