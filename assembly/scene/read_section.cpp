#include <fmt/format.h>

#include <optional>

#include "assembly/scene/quantity.hpp"
#include "assembly/scene/read.hpp"
#include "fem/section_shapes.hpp"

namespace tenon::assembly {
namespace {

/// Typical handbook values at room temperature, SI (docs/scene.md): aluminium 6061-T6, structural steel, Ti-6Al-4V.
const std::vector<fem::Material>& shipped_materials() {
  static const std::vector<fem::Material> table{
      {.name = "aluminium", .E = 68.9e9, .G = 68.9e9 / 2.66, .nu = 0.33, .rho = 2700.0},
      {.name = "steel", .E = 200e9, .G = 200e9 / 2.6, .nu = 0.3, .rho = 7850.0},
      {.name = "titanium", .E = 113.8e9, .G = 113.8e9 / 2.684, .nu = 0.342, .rho = 4430.0}};
  return table;
}

fem::Material read_material(const Value& map, const Units& units) {
  fem::Material material;
  material.E = positive(*map.find("E"), dimension::pressure, units);
  material.nu = number(*map.find("nu"));
  if (!(material.nu > -1.0 && material.nu < 0.5))
    throw InputError(map.find("nu")->place, fmt::format("Poisson's ratio is {}, expected -1 < nu < 0.5", material.nu),
                     "Correct it; give G apart when the two do not belong together");
  material.rho = positive(*map.find("rho"), dimension::density, units, true);
  const Value* G = map.find("G");
  material.G = G ? positive(*G, dimension::pressure, units) : material.E / (2.0 * (1.0 + material.nu));
  return material;
}

fem::BeamSection read_general(const Value& map, const Units& units) {
  fem::BeamSection section{.name = "general"};
  section.A = positive(*map.find("A"), dimension::area, units);
  section.Iy = positive(*map.find("Iy"), dimension::second_moment, units);
  section.Iz = positive(*map.find("Iz"), dimension::second_moment, units);
  section.J = positive(*map.find("J"), dimension::second_moment, units, true);
  if (const Value* Iyz = map.find("Iyz")) section.Iyz = quantity(*Iyz, dimension::second_moment, units);
  if (section.Iyz * section.Iyz >= section.Iy * section.Iz)
    throw InputError(map.find("Iyz")->place, "Iyz² is not below Iy Iz", "Check the section's moments");
  if (const Value* kappa = map.find("kappa_y")) section.kappa_y = positive(*kappa, dimension::none, units, true);
  if (const Value* kappa = map.find("kappa_z")) section.kappa_z = positive(*kappa, dimension::none, units, true);
  return section;
}

fem::BeamSection read_beam_shape(const std::string& key, const Value& value, double nu, const Units& units) {
  try {
    if (key == "circle") return fem::circle(positive(value, dimension::length, units), nu);
    if (key == "general") return read_general(value, units);
    const std::vector<double> size = quantities(value, key == "box" ? 3 : 2, dimension::length, units);
    if (key == "tube") return fem::tube(size[0], size[1], nu);
    if (key == "rectangle") return fem::rectangle(size[0], size[1], nu);
    return fem::box(size[0], size[1], size[2], nu);
  } catch (const ModelError& fault) {
    throw InputError(value.place, fault.what(),
                     "Sizes are: tube [outer, inner] radii, rectangle [b, h], box [b, h, t]");
  }
}

/// Plies of `laminate`; angles from direction 1 of the section.
std::vector<fem::Ply> read_plies(const Value& map, const Materials& materials, const Units& units) {
  std::optional<fem::Ply> common;
  if (const Value* of = map.find("ply")) {
    const auto modulus = [&](const char* key) { return positive(*of->find(key), dimension::pressure, units); };
    common.emplace();
    common->E1 = modulus("E1");
    common->E2 = modulus("E2");
    common->nu12 = number(*of->find("nu12"));
    common->G12 = modulus("G12");
    common->G13 = of->find("G13") ? modulus("G13") : common->G12;
    common->G23 = of->find("G23") ? modulus("G23") : common->G13;
    common->rho = positive(*of->find("rho"), dimension::density, units, true);
    if (!(common->nu12 * common->nu12 * common->E2 < common->E1))
      throw InputError(of->find("nu12")->place, fmt::format("nu12 is {}, expected nu12² < E1/E2", common->nu12),
                       "Is it nu21? nu12 = nu21 E1/E2");
  }
  std::vector<fem::Ply> plies;
  for (const Value& item : map.find("plies")->items) {
    if (item.kind != Value::Kind::list || item.items.size() < 2 || item.items.size() > 3)
      throw InputError(item.place, "found no ply, expected [thickness, angle] or [thickness, angle, material]",
                       "Write for example [0.125, 45 deg]");
    fem::Ply ply;
    if (item.items.size() == 3) {
      const fem::Material m = materials.read(item.items[2]);
      ply = {.E1 = m.E, .E2 = m.E, .nu12 = m.nu, .G12 = m.G, .G13 = m.G, .G23 = m.G, .rho = m.rho};
    } else if (common) {
      ply = *common;
    } else {
      throw InputError(item.place, "the ply has no material", "Add `ply: {E1, E2, nu12, G12, rho}` or name a material");
    }
    ply.thickness = positive(item.items[0], dimension::length, units);
    ply.angle = angle(item.items[1]);
    plies.push_back(ply);
  }
  if (plies.empty()) throw InputError(map.place, "the laminate has no plies", "List them under `plies`");
  if (const Value* symmetric = map.find("symmetric"); symmetric && truth(*symmetric))
    for (std::size_t k = plies.size(); k-- > 0;) plies.push_back(fem::Ply(plies[k]));
  return plies;
}

/// `shell` or `laminate`.
void read_shell(const std::string& key, const Value& map, const Materials& materials, const Units& units,
                SceneSection& section) {
  fem::ShellSection shell{.name = section.set};
  if (key == "shell") {
    refuse(map, {"shear", "orientation"}, "a shell");
    shell.thickness = positive(*map.find(key), dimension::length, units);
  } else {
    refuse(map, {"shear", "material"}, "a laminate");
    shell.plies = read_plies(*map.find(key), materials, units);
    for (const fem::Ply& ply : shell.plies) shell.thickness += ply.thickness;
    if (const Value* orientation = map.find("orientation")) section.orientation = axis(*orientation);
  }
  if (const Value* nsm = map.find("nsm")) shell.nsm = positive(*nsm, dimension::mass_per_area, units, true);
  if (const Value* offset = map.find("offset")) section.normal_offset = quantity(*offset, dimension::length, units);
  section.shape = shell;
}

}  // namespace

Materials::Materials(const Value* table, const Units& units) : units_(units) {
  if (table)
    for (const Member& entry : table->members) {
      known_.push_back(read_material(entry.value, units));
      known_.back().name = entry.key;
    }
  for (const fem::Material& material : shipped_materials()) known_.push_back(material);
}

fem::Material Materials::read(const Value& value) const {
  if (value.kind == Value::Kind::map) {
    fem::Material material = read_material(value, units_);
    material.name = fmt::format("line {}", value.place.line);
    return material;
  }
  std::vector<std::string> names;
  for (const fem::Material& material : known_) names.push_back(material.name);
  return known_[static_cast<std::size_t>(choice(value, names))];
}

SceneSection read_section(const Member& entry, const Value* body_material, const Materials& materials,
                          const Units& units) {
  const Value& map = entry.value;
  const std::string what = fmt::format("section '{}'", entry.key);
  const Value* material = map.find("material") ? map.find("material") : body_material;
  const std::string key =
      one_of(map, {"shell", "laminate", "tube", "circle", "rectangle", "box", "general", "rod"}, what);
  if (!material && key != "laminate")
    throw InputError(entry.place, fmt::format("{} has no material", what),
                     "Add `material: {E, nu, rho}` or a name (aluminium, steel, titanium) to the section or its body");

  SceneSection section{.set = entry.key,
                       .shape = {},
                       .material = key == "laminate" ? fem::Material{.name = entry.key} : materials.read(*material),
                       .orientation = {},
                       .place = entry.place};
  const Value* nsm = map.find("nsm");
  if (key == "shell" || key == "laminate") {
    read_shell(key, map, materials, units, section);
    return section;
  }

  if (key == "rod") {
    refuse(map, {"shear", "orientation", "offset"}, "a rod, which does not bend");
    const Value& rod = *map.find(key);
    fem::BeamSection bar{.name = entry.key};
    bar.A = positive(rod.kind == Value::Kind::map ? *rod.find("A") : rod, dimension::area, units);
    if (const Value* J = rod.find("J")) bar.J = positive(*J, dimension::second_moment, units, true);
    if (nsm) bar.nsm = positive(*nsm, dimension::mass_per_length, units, true);
    section.shape = bar;
    section.rod = true;
    return section;
  }

  fem::BeamSection beam = read_beam_shape(key, *map.find(key), section.material.nu, units);
  if (const Value* shear = map.find("shear")) {
    if (const int theory = choice(*shear, {"timoshenko", "rayleigh", "euler-bernoulli"}); theory > 0) {
      beam = fem::rigid_in_shear(beam);
      section.rotary_inertia = theory == 1;
    } else if (beam.kappa_y == 0.0 || beam.kappa_z == 0.0) {
      throw InputError(shear->place, fmt::format("{} has no shear coefficients", what), "Give kappa_y and kappa_z");
    }
  }
  beam.name = entry.key;
  if (nsm) beam.nsm = positive(*nsm, dimension::mass_per_length, units, true);
  section.shape = beam;
  section.round = key == "tube" || key == "circle";
  if (const Value* orientation = map.find("orientation")) section.orientation = axis(*orientation);
  if (!section.round && !section.orientation)
    throw InputError(entry.place, fmt::format("{} is not round and has no orientation", what),
                     "Add `orientation: [x, y, z]`, a vector that spans with the beam's axis its x-y plane");
  if (const Value* offset = map.find("offset")) section.offset = vector(*offset, dimension::length, units);
  return section;
}

BeamSource read_beam(const Value& map, const Materials& materials, const Units& units) {
  BeamSource beam;
  beam.from = vector(*map.find("from"), dimension::length, units);
  beam.to = vector(*map.find("to"), dimension::length, units);
  if (!((beam.to - beam.from).norm() > 0.0))
    throw InputError(map.find("to")->place, "the beam has no length: `from` and `to` are one point",
                     "Move one of them");
  const Value& section = *map.find("section");
  refuse(section, {"shell", "laminate", "rod", "offset"}, "a beam");
  beam.section = read_section({"section", section.place, section}, map.find("material"), materials, units);
  const Vec3 axis = (beam.to - beam.from).normalized();
  if (!beam.section.orientation) beam.section.orientation = axis.unitOrthogonal();
  if (axis.cross(*beam.section.orientation).norm() < 1e-6)
    throw InputError(section.place, "the orientation lies along the beam's axis", "Give a vector across the axis");
  if (const Value* model = map.find("model"))
    beam.model = static_cast<BeamSource::Model>(choice(*model, {"fe", "titop-polynomial", "titop-clamped-free"}));
  if (beam.model != BeamSource::Model::fe) refuse(map, {"elements"}, "a titop model");
  if (beam.model != BeamSource::Model::clamped_free) refuse(map, {"modes"}, "this model");
  if (const Value* elements = map.find("elements")) beam.elements = count(*elements, 1);
  if (const Value* modes = map.find("modes")) beam.modes = count(*modes, 1);
  if (const Value* plane = map.find("plane")) beam.planar = choice(*plane, {"xy"}) == 0;
  if (beam.planar && std::get<fem::BeamSection>(beam.section.shape).Iyz != 0.0)
    throw InputError(section.place, "a section with a product of inertia does not bend in one plane",
                     "Leave `plane` out, or turn the orientation to a principal axis");
  return beam;
}

}  // namespace tenon::assembly
