#include <fmt/format.h>

#include <optional>

#include "assembly/scene/quantity.hpp"
#include "assembly/scene/read.hpp"
#include "fem/elements/section_line.hpp"
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
  if (const Value* centre = map.find("shear_centre")) {
    const std::vector<double> yz = quantities(*centre, 2, dimension::length, units);
    section.shear_y = yz[0];
    section.shear_z = yz[1];
  }
  return section;
}

/// Sizes of a shape; constants of `general` are none.
struct Sizes {
  std::vector<double> of;
  std::optional<fem::BeamSection> general;
};

Sizes read_sizes(const std::string& key, const Value& value, const Units& units) {
  if (key == "general") {
    if (value.kind != Value::Kind::map)
      throw InputError(value.place, "found no constants of a section", "Write {A: ..., Iy: ..., Iz: ..., J: ...}");
    return {{}, read_general(value, units)};
  }
  if (key == "circle") return {{positive(value, dimension::length, units)}, {}};
  std::size_t count = key == "tube" || key == "rectangle" ? 2 : key == "box" ? 3 : 4;
  if (key == "i" && value.items.size() == 6) count = 6;
  return {quantities(value, count, dimension::length, units), {}};
}

fem::BeamSection shape_of(const std::string& key, const std::vector<double>& size, double nu) {
  if (key == "circle") return fem::circle(size[0], nu);
  if (key == "tube") return fem::tube(size[0], size[1], nu);
  if (key == "rectangle") return fem::rectangle(size[0], size[1], nu);
  if (key == "box") return fem::box(size[0], size[1], size[2], nu);
  if (key == "tee") return fem::tee(size[0], size[1], size[2], size[3]);
  if (key == "channel") return fem::channel(size[0], size[1], size[2], size[3]);
  if (key == "angle") return fem::angle_section(size[0], size[1], size[2], size[3]);
  const bool equal = size.size() == 4;
  return fem::i_section(size[1], size[0], size[2], equal ? size[0] : size[4], equal ? size[2] : size[5], size[3]);
}

fem::BeamSection read_beam_shape(const std::string& key, const Value& value, const Sizes& sizes, double nu) {
  if (sizes.general) return *sizes.general;
  try {
    return shape_of(key, sizes.of, nu);
  } catch (const ModelError& fault) {
    throw InputError(value.place, fault.what(),
                     "Sizes are: tube [outer, inner] radii, rectangle [b, h], box [b, h, t], i, tee, channel and angle "
                     "[b, h, flange, web]");
  }
}

/// Sizes vary linearly from one end to the other, constants of `general` by their roots.
std::function<fem::BeamSection(double)> read_taper(const std::string& key, const Sizes& root, const Value& tip,
                                                   double nu, const Units& units) {
  const Sizes other = read_sizes(key, tip, units);
  const fem::BeamSection at_tip = read_beam_shape(key, tip, other, nu);  // refuses sizes that make no section
  if (root.of.size() != other.of.size())
    throw InputError(tip.place,
                     fmt::format("found {} sizes, expected {} as at the other end", other.of.size(), root.of.size()),
                     "Give the same sizes at both ends");
  if (root.general)
    return [from = *root.general, at_tip](double t) {
      fem::BeamSection section = from;
      fem::between(from, at_tip, t, section);
      return section;
    };
  return [key, from = root.of, to = other.of, nu](double t) {
    std::vector<double> sizes;
    for (std::size_t i = 0; i < from.size(); ++i) sizes.push_back((1.0 - t) * from[i] + t * to[i]);
    return shape_of(key, sizes, nu);
  };
}

std::array<Vec3, 2> read_way(const Value& value, const Units& units) {
  if (value.kind != Value::Kind::list || value.items.size() != 2)
    throw InputError(value.place, "found no two points", "Write for example along: [[0, 0, 0], [1, 0, 0]]");
  const std::array<Vec3, 2> way{vector(value.items[0], dimension::length, units),
                                vector(value.items[1], dimension::length, units)};
  if (!((way[1] - way[0]).norm() > 0.0))
    throw InputError(value.place, "the way has no length: both points are one", "Move one of them");
  return way;
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
    refuse(map, {"shear", "orientation", "tip", "along", "nsm_centre"}, "a shell");
    shell.thickness = positive(*map.find(key), dimension::length, units);
  } else {
    refuse(map, {"shear", "material", "tip", "along", "nsm_centre"}, "a laminate");
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
  const std::string key = one_of(
      map,
      {"shell", "laminate", "tube", "circle", "rectangle", "box", "i", "tee", "channel", "angle", "general", "rod"},
      what);
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
    refuse(map, {"shear", "orientation", "offset", "tip", "along", "nsm_centre"}, "a rod, which does not bend");
    const Value& rod = *map.find(key);
    fem::BeamSection bar{.name = entry.key};
    bar.A = positive(rod.kind == Value::Kind::map ? *rod.find("A") : rod, dimension::area, units);
    if (const Value* J = rod.find("J")) bar.J = positive(*J, dimension::second_moment, units, true);
    if (nsm) bar.nsm = positive(*nsm, dimension::mass_per_length, units, true);
    section.shape = bar;
    section.rod = true;
    return section;
  }

  const double nu = section.material.nu;
  const Sizes sizes = read_sizes(key, *map.find(key), units);
  fem::BeamSection beam = read_beam_shape(key, *map.find(key), sizes, nu);
  bool rigid_in_shear = false;
  if (const Value* shear = map.find("shear")) {
    if (const int theory = choice(*shear, {"timoshenko", "rayleigh", "euler-bernoulli"}); theory > 0) {
      rigid_in_shear = true;
      section.rotary_inertia = theory == 1;
    } else if (beam.kappa_y == 0.0 || beam.kappa_z == 0.0) {
      throw InputError(shear->place, fmt::format("{} has no shear coefficients", what), "Give kappa_y and kappa_z");
    }
  }
  if (rigid_in_shear) beam = fem::rigid_in_shear(beam);
  beam.name = entry.key;
  if (nsm) beam.nsm = positive(*nsm, dimension::mass_per_length, units, true);
  if (const Value* centre = map.find("nsm_centre")) {
    const std::vector<double> yz = quantities(*centre, 2, dimension::length, units);
    beam.nsm_y = yz[0];
    beam.nsm_z = yz[1];
  }
  section.shape = beam;
  if (const Value* tip = map.find("tip")) {
    section.taper = [shape = read_taper(key, sizes, *tip, nu, units), beam, rigid_in_shear](double t) {
      fem::BeamSection at = shape(t);
      if (rigid_in_shear) at = fem::rigid_in_shear(at);
      at.name = beam.name;
      at.nsm = beam.nsm;
      at.nsm_y = beam.nsm_y;
      at.nsm_z = beam.nsm_z;
      return at;
    };
    if (const Value* along = map.find("along")) section.along = read_way(*along, units);
  } else {
    refuse(map, {"along"}, "a section without `tip`");
  }
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
  refuse(section, {"shell", "laminate", "rod", "offset", "along"}, "a beam");
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
  const auto& shape = std::get<fem::BeamSection>(beam.section.shape);
  const bool centred = shape.shear_y == 0.0 && shape.shear_z == 0.0 && shape.nsm_y == 0.0 && shape.nsm_z == 0.0;
  if (beam.planar && (shape.Iyz != 0.0 || !centred))
    throw InputError(section.place,
                     "a section with a product of inertia, or with its shear centre or mass off the centroid, does not "
                     "bend in one plane",
                     "Leave `plane` out, or turn the orientation to a principal axis");
  if (beam.model != BeamSource::Model::fe && (!centred || beam.section.taper))
    throw InputError(section.place, "titop models are of uniform beams with shear centre and mass at the centroid",
                     "Take `model: fe`");
  return beam;
}

}  // namespace tenon::assembly
