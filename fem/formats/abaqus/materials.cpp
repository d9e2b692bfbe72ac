#include <fmt/format.h>

#include <utility>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {
namespace {

void elastic(const Block& block, DraftMaterial& current) {
  const std::string type = block.upper_value("TYPE");
  if (!type.empty() && type != "ISO" && type != "ISOTROPIC") {
    current.isotropic = false;
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
