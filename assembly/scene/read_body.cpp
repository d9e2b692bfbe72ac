#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "assembly/scene/quantity.hpp"
#include "assembly/scene/read.hpp"
#include "fem/formats/deck.hpp"

namespace tenon::assembly {
namespace {

/// The one way in which a port or a mass says where it is.
NodeSelector read_selector(const Value& map, const std::vector<std::string>& ways, const std::string& what,
                           const Units& units) {
  NodeSelector where;
  where.place = map.place;
  const std::string way = one_of(map, ways, what);
  const Value& value = *map.find(way);
  where.place = value.place;
  if (way == "at" || way == "nearest") {
    where.kind = way == "at" ? NodeSelector::Kind::at : NodeSelector::Kind::nearest;
    where.point = vector(value, dimension::length, units);
  } else if (way == "node") {
    where.kind = NodeSelector::Kind::node;
    where.node = count(value, 1);
  } else {
    where.kind = way == "set" ? NodeSelector::Kind::set : NodeSelector::Kind::port;
    where.name = value.text;
  }
  return where;
}

Mat3 read_axes(const Value& map) {
  if (const Value* rotate = map.find("rotate")) {
    refuse(map, {"axes"}, "'rotate'");
    return Eigen::AngleAxisd(angle(*rotate->find("angle")), axis(*rotate->find("axis"))).toRotationMatrix();
  }
  const Value* axes = map.find("axes");
  if (!axes) return Mat3::Identity();
  if (axes->items.size() != 3)
    throw InputError(axes->place, fmt::format("found {} axes, expected 3", axes->items.size()),
                     "Write [[...], [...], [...]]: the port's x, y and z axes in the body frame");
  Mat3 R;
  for (int k = 0; k < 3; ++k) R.col(k) = axis(axes->items[static_cast<std::size_t>(k)]);
  if ((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-6 || R.determinant() < 0.0)
    throw InputError(axes->place, "the axes are not right-handed and at right angles",
                     "Correct them, or write `rotate: {axis, angle}`");
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

ScenePort read_mesh_port(const Member& entry, const Units& units) {
  const Value& map = entry.value;
  const std::string what = fmt::format("port '{}'", entry.key);
  if (map.kind != Value::Kind::map)
    throw InputError(map.place, fmt::format("{} of a mesh is a bare list", what),
                     "Write {nearest: [x, y, z]}, {at: [x, y, z]}, {node: N} or {set: name}");
  ScenePort port{.name = entry.key, .where = {}, .axes = read_axes(map), .place = entry.place};
  if (map.find("set")) {
    refuse(map, {"nearest", "node"}, "'set'");
    port.where = {
        .kind = NodeSelector::Kind::set, .centre = {}, .name = map.find("set")->text, .place = map.find("set")->place};
    if (const Value* at = map.find("at")) port.where.centre = vector(*at, dimension::length, units);
    if (const Value* kind = map.find("kind")) port.average = choice(*kind, {"rigid", "average"}) == 1;
  } else {
    refuse(map, {"kind"}, "a port of one node");
    port.where = read_selector(map, {"at", "nearest", "node"}, what, units);
  }
  return port;
}

ScenePort read_rigid_port(const Member& entry, const Units& units) {
  const Value& value = entry.value;
  ScenePort port{.name = entry.key, .where = {}, .place = entry.place};
  if (value.kind == Value::Kind::list) {
    port.where.point = vector(value, dimension::length, units);
  } else {
    refuse(value, {"set", "nearest", "node", "kind"}, "a rigid body");
    if (!value.find("at"))
      throw InputError(value.place, fmt::format("port '{}' has no place", entry.key), "Write `at: [x, y, z]`");
    port.where.point = vector(*value.find("at"), dimension::length, units);
    port.axes = read_axes(value);
  }
  return port;
}

fem::Directions read_directions(const Value& value) {
  fem::Directions directions = 0;
  for (const Value* word : words(value)) {
    const int k = choice(*word, {"x", "y", "z", "rx", "ry", "rz", "all"});
    directions |= static_cast<fem::Directions>(k == 6 ? fem::all_six : 1 << k);
  }
  return directions;
}

std::vector<std::string> texts(const Value* value) {
  std::vector<std::string> all;
  if (value)
    for (const Value* word : words(*value)) all.push_back(word->text);
  return all;
}

SceneReduction read_reduction(const Value& value) {
  using Kind = SceneReduction::Kind;
  if (value.kind == Value::Kind::scalar)
    return {.kind = choice(value, {"auto", "rigid"}) == 0 ? Kind::automatic : Kind::rigid, .modes = {}, .band = {}};
  SceneReduction reduction{.kind = Kind::chosen, .modes = {}, .band = {}};
  if (const Value* basis = value.find("basis"))  // in the order of the enumerators
    reduction.basis = static_cast<reduction::Basis>(choice(
        *basis, {"craig-bampton", "craig-bampton-inertia-relief", "clamped-free", "clamped-free-static", "rubin"}));
  if (one_of(value, {"modes", "band"}, "a reduction") == "band") {
    reduction.band = frequency(*value.find("band"));
  } else if (value.find("modes")->text == "all") {
    reduction.all = true;
  } else {
    reduction.modes = count(*value.find("modes"));
  }
  return reduction;
}

SceneSpring read_spring(const Member& entry, const Units& units) {
  const Value& map = entry.value;
  const std::string what = fmt::format("spring '{}'", entry.key);
  const std::vector<std::string> ways{"at", "nearest", "node", "set", "port"};
  SceneSpring spring{.name = entry.key,
                     .from = read_selector(*map.find("from"), ways, what, units),
                     .to = {},
                     .axes = read_axes(map),
                     .at = {}};
  if (const Value* to = map.find("to")) spring.to = read_selector(*to, ways, what, units);
  if (const Value* at = map.find("at")) spring.at = vector(*at, dimension::length, units);
  const auto stiffness = [&](const char* key, std::size_t first, const Dimension& unit) {
    const Value* const value = map.find(key);
    if (!value) return;
    const std::vector<double> k = quantities(*value, 3, unit, units);
    for (std::size_t i = 0; i < 3; ++i) {
      if (k[i] < 0.0)
        throw InputError(value->place, fmt::format("{} has a negative stiffness", what), "Give numbers of at least 0");
      spring.k[first + i] = k[i];
    }
  };
  stiffness("k", 0, {-1, 0, 0, 1});
  stiffness("kr", 3, {1, 0, 0, 1});
  if (!map.find("k") && !map.find("kr"))
    throw InputError(map.place, fmt::format("{} has no stiffness", what), "Add `k: [kx, ky, kz]` or `kr`");
  return spring;
}

/// ½ tr(J) − J = ∫ x xᵀ dm has no negative principal value: no moment is above the sum of the other two. Inertias are
/// known to few digits, and flat bodies lie on the limit: 1 % more passes.
void require_body(const Value& value, const Mat3& J) {
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Mat3>(J, Eigen::EigenvaluesOnly).eigenvalues();
  if (moments[2] <= 1.01 * (moments[0] + moments[1])) return;
  throw InputError(
      value.place,
      fmt::format("no body has the principal moments {:g}, {:g}, {:g} kg m²: the last is more than the sum "
                  "of the others",
                  moments[0], moments[1], moments[2]),
      "Check units and products; a flat body reaches the sum, a thin one has two equal moments");
}

MatrixFiles read_matrix_files(const Value& map, const std::filesystem::path& folder) {
  using Program = MatrixFiles::Program;
  static const std::map<std::string, Program> programs{{"K", Program::matrix_market},
                                                       {"nastran", Program::nastran},
                                                       {"calculix", Program::calculix},
                                                       {"abaqus", Program::abaqus}};
  const auto file = [&](const char* key) {
    const Value* const value = map.find(key);
    if (!value) throw InputError(map.place, fmt::format("matrices without '{}'", key), "Name K, M and labels together");
    return folder / value->text;
  };
  const std::string way = one_of(map, {"K", "nastran", "calculix", "abaqus"}, "`matrices`");
  MatrixFiles files{.program = programs.at(way), .K = {}, .M = {}, .labels = {}, .job = {}, .deck = {}};
  if (files.program == Program::matrix_market) {
    refuse(map, {"deck"}, "labels, which tell where nodes are");
    files.K = file("K");
    files.M = file("M");
    files.labels = file("labels");
    return files;
  }
  refuse(map, {"M", "labels"}, "the files of another program, which hold them");
  files.job = folder / map.find(way)->text;
  if (const Value* const deck = map.find("deck")) {
    if (files.program == Program::nastran) refuse(map, {"deck"}, "a superelement, which tells where its grids are");
    files.deck = folder / deck->text;
  }
  return files;
}

FeSource read_fe(const Member& entry, const std::filesystem::path& folder, const Materials& materials,
                 const Units& units) {
  const Value& body = entry.value;
  FeSource fe;
  fe.units = units;
  const Value* sections = body.find("sections");
  if (const Value* matrices = body.find("matrices")) {
    refuse(body, {"sections", "material", "ignore", "beam_mass"}, "matrices, which hold all stiffness and mass");
    fe.matrices = read_matrix_files(*matrices, folder);
    fe.file = fe.matrices->program == MatrixFiles::Program::matrix_market ? fe.matrices->K : fe.matrices->job;
  } else {
    fe.file = folder / body.find("fe")->text;
  }
  if (!fe.matrices && fem::is_deck(fe.file)) {
    refuse(body, {"sections", "material", "ignore"}, "a deck, which carries its own");
  } else if (!fe.matrices && (!sections || sections->members.empty())) {
    throw InputError(
        entry.place,
        fmt::format("body '{}' has no sections, and {} carries none", entry.key, fe.file.filename().string()),
        "Add `sections: {set: {shell: ...}}`, one for each set of cells");
  }
  if (sections)
    for (const Member& section : sections->members)
      fe.sections.push_back(read_section(section, body.find("material"), materials, units));
  if (const Value* fix = body.find("fix"))
    for (const Member& support : fix->members)
      fe.supports.push_back({support.key, read_directions(support.value), support.place});
  if (const Value* masses = body.find("masses"))
    for (const Member& mass : masses->members) {
      SceneNodeMass node_mass{.name = mass.key,
                              .where = read_selector(mass.value, {"at", "nearest", "node", "set", "port"},
                                                     fmt::format("mass '{}'", mass.key), units),
                              .mass = positive(*mass.value.find("mass"), dimension::mass, units, true)};
      if (const Value* J = mass.value.find("inertia")) node_mass.inertia = inertia(*J, units);
      if (const Value* offset = mass.value.find("offset")) node_mass.offset = vector(*offset, dimension::length, units);
      fe.masses.push_back(std::move(node_mass));
    }
  if (const Value* springs = body.find("springs"))
    for (const Member& spring : springs->members) fe.springs.push_back(read_spring(spring, units));
  if (const Value* mass = body.find("beam_mass"))
    fe.beam_mass = static_cast<fem::BeamMass>(choice(*mass, {"high-order", "consistent", "nastran"}));
  if (const Value* ignore = body.find("ignore"))
    for (const Value* set : words(*ignore)) fe.ignore.push_back({set->text, set->place});
  fe.allow = texts(body.find("allow"));
  return fe;
}

}  // namespace

SceneBody read_body(const Member& entry, const std::filesystem::path& folder, const Materials& materials,
                    const Units& units) {
  check_name(entry);
  const Value& map = entry.value;
  const std::string what = fmt::format("body '{}'", entry.key);
  SceneBody body;
  body.name = entry.key;
  body.place = entry.place;
  const std::string kind = one_of(map, {"rigid", "fe", "matrices", "reduced", "beam"}, what);

  if (kind == "rigid") {
    refuse(map,
           {"material", "sections", "beam_mass", "fix", "masses", "springs", "ignore", "allow", "damping", "reduction"},
           "a rigid body");
    const Value& rigid = *map.find("rigid");
    RigidSource source{.mass = positive(*rigid.find("mass"), dimension::mass, units, true),
                       .inertia = inertia(*rigid.find("inertia"), units)};
    require_body(*rigid.find("inertia"), source.inertia);
    if (const Value* com = rigid.find("com")) source.centre = vector(*com, dimension::length, units);
    body.source = source;
  } else if (kind == "fe" || kind == "matrices") {
    body.source = read_fe(entry, folder, materials, units);
  } else if (kind == "beam") {
    refuse(map, {"material", "sections", "beam_mass", "fix", "masses", "springs", "ignore", "allow", "ports"},
           "a beam, which says it itself and has the ports P and C");
    const BeamSource beam = read_beam(*map.find("beam"), materials, units);
    body.ports = {{.name = "P", .where = {}, .place = entry.place}, {.name = "C", .where = {}, .place = entry.place}};
    body.ports[0].where.point = beam.from;
    body.ports[1].where.point = beam.to;
    body.parent_port = body.ports.front().name;
    body.source = beam;
  } else {
    refuse(map,
           {"material", "sections", "beam_mass", "fix", "masses", "springs", "ignore", "allow", "damping", "reduction",
            "ports"},
           "a reduced body: its file says it");
    body.source = ReducedSource{folder / map.find("reduced")->text, units};
  }

  if (const Value* ports = map.find("ports"))
    for (const Member& port : ports->members) {
      check_name(port);
      body.ports.push_back(kind == "rigid" ? read_rigid_port(port, units) : read_mesh_port(port, units));
    }
  if (const Value* parent = map.find("parent_port")) {
    body.parent_port = parent->text;
    std::vector<std::string> names;
    for (const ScenePort& port : body.ports) names.push_back(port.name);
    if (kind != "reduced") choice(*parent, names);
  }
  if (const Value* damping = map.find("damping")) {
    body.damping = positive(*damping, dimension::none, units, true);
    if (body.damping >= 1.0)
      throw InputError(damping->place, fmt::format("a damping ratio of {} is not below 1", body.damping),
                       "It is a fraction of critical damping: 0.005 means half a per cent");
  }
  if (const Value* reduction = map.find("reduction")) body.reduction = read_reduction(*reduction);
  return body;
}

}  // namespace tenon::assembly
