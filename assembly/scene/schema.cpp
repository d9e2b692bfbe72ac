#include "assembly/scene/schema.hpp"

#include <fmt/format.h>

#include "assembly/integration/method.hpp"
#include "fem/mesh.hpp"

namespace tenon::assembly {
namespace {

const Schema material{"a material",
                      {{"E", scalar, "Young's modulus", true},
                       {"nu", scalar, "Poisson's ratio", true},
                       {"rho", scalar, "density", true},
                       {"G", scalar, "shear modulus; E/2(1+nu) when absent"}}};

const Key one_material{"material", map, "", false, &material};
const Schema materials{"materials", {}, &one_material};

const Schema general_section{"a general beam section",
                             {{"A", scalar, "area", true},
                              {"Iy", scalar, "second moment about y: bending in the x-z plane", true},
                              {"Iz", scalar, "second moment about z: bending in the x-y plane", true},
                              {"Iyz", scalar, "product of inertia"},
                              {"J", scalar, "torsion constant", true},
                              {"kappa_y", scalar, "shear coefficient for forces along y"},
                              {"kappa_z", scalar, "shear coefficient for forces along z"},
                              {"shear_centre", list, "[y, z] from the centroid"}}};

const Schema ply{"a ply",
                 {{"E1", scalar, "Young's modulus along the fibres", true},
                  {"E2", scalar, "across them", true},
                  {"nu12", scalar, "Poisson's ratio of a pull along the fibres", true},
                  {"G12", scalar, "shear modulus in the plane", true},
                  {"G13", scalar, "transverse, along the fibres; G12 when absent"},
                  {"G23", scalar, "transverse, across them; G13 when absent"},
                  {"rho", scalar, "density", true}}};

const Schema laminate{"a laminate",
                      {{"plies", list, "[thickness, angle] each, from -z to z; a third word names a material", true},
                       {"ply", map, "what plies without a named material are of", false, &ply},
                       {"symmetric", scalar, "true: `plies` lists the lower half"}}};

const Schema rod_section{"a rod", {{"A", scalar, "area", true}, {"J", scalar, "torsion constant; 0 when absent"}}};

const Schema section{
    "a section",
    {{"shell", scalar, "thickness"},
     {"laminate", map, "a shell in layers", false, &laminate},
     {"tube", list, "[outer, inner] radii"},
     {"circle", scalar, "radius"},
     {"rectangle", list, "[b along y, h along z]"},
     {"box", list, "[b along y, h along z, wall thickness], outer sizes"},
     {"i", list,
      "[b along y, h along z, flange, web] or with a top flange of its own [b, h, flange, web, b top, flange top]"},
     {"tee", list, "[b along y, h along z, flange, web], the flange at +z"},
     {"channel", list, "[b along y, h along z, flanges, web], the web at -y"},
     {"angle", list, "[b along y, h along z, leg along y, leg along z], the corner at -y, -z"},
     {"general", map, "section constants", false, &general_section},
     {"tip", scalar | list | map, "the same sizes at the other end of a tapered beam", false, &general_section},
     {"along", list, "where the sizes hold and where those of `tip` do: two points; of a `beam` its ends"},
     {"nsm_centre", list, "[y, z] of the non-structural mass, from the beam's centroid"},
     {"rod", scalar | map, "area of a bar that does not bend, or {A, J}", false, &rod_section},
     {"shear", scalar, "timoshenko (default), rayleigh (rotary inertia, no shear) or euler-bernoulli (neither)"},
     {"orientation", list,
      "a vector that spans, with the beam's axis, its x-y plane; of a laminate: its projection is direction 1"},
     {"offset", scalar | list, "from the nodes to the beam's axis; of a shell: to its middle, along the normal"},
     {"material", scalar | map, "in place of the body's", false, &material},
     {"nsm", scalar, "non-structural mass per length (beams) or area (shells)"}}};

const Schema rotation_schema{
    "a rotation", {{"axis", scalar | list, "x, y, z or a vector", true}, {"angle", scalar, "e.g. 180 deg", true}}};

const Schema port{
    "a port",
    {{"at", list, "a point: of a rigid body, of a node there, or (with `set`) of the node made for the set"},
     {"set", scalar, "a set of the mesh; more than one node is joined to a node of its own"},
     {"nearest", list, "the node nearest to this point"},
     {"node", scalar, "the file's own node number"},
     {"kind", scalar, "rigid (default) or average: how a set follows its port"},
     {"axes", list, "the port's x, y and z axes in the body frame"},
     {"rotate", map, "the port's axes by a rotation", false, &rotation_schema}}};

const Schema node_mass{"a mass inside a body",
                       {{"at", list, "the node at this point"},
                        {"set", scalar, "a set of one node"},
                        {"nearest", list, "the node nearest to this point"},
                        {"node", scalar, "the file's own node number"},
                        {"port", scalar, "the node of a port"},
                        {"mass", scalar, "mass", true},
                        {"inertia", list, "about its own centre: three moments or a 3x3 matrix, body axes"},
                        {"offset", list, "from the node to the centre of mass"}}};

const Schema selector{"a node",
                      {{"at", list, "the node at this point"},
                       {"set", scalar, "a set of one node"},
                       {"nearest", list, "the node nearest to this point"},
                       {"node", scalar, "the file's own node number"},
                       {"port", scalar, "the node of a port"}}};

const Schema node_spring{"a spring inside a body",
                         {{"from", map, "the node at one end", true, &selector},
                          {"to", map, "the node at the other; ground when absent", false, &selector},
                          {"k", list, "stiffness along x, y, z of its axes"},
                          {"kr", list, "stiffness about x, y, z of its axes"},
                          {"at", list, "where it acts; midway between the nodes when absent"},
                          {"axes", list, "its x, y and z axes in the body frame"},
                          {"rotate", map, "its axes by a rotation", false, &rotation_schema}}};

const Schema rigid{"a rigid body",
                   {{"mass", scalar, "mass", true},
                    {"inertia", list, "about the centre of mass: three moments or a 3x3 matrix", true},
                    {"com", list, "centre of mass in the body frame; the origin when absent"}}};

const Schema beam{"a straight beam",
                  {{"from", list, "where port P is", true},
                   {"to", list, "where port C is", true},
                   {"section", map, "the section of all of it", true, &section},
                   {"material", scalar | map, "of the section", false, &material},
                   {"model", scalar, "fe (default), titop-polynomial or titop-clamped-free"},
                   {"elements", scalar, "of an fe beam; 32 when absent"},
                   {"modes", scalar, "of a titop-clamped-free beam, in each bending plane; 4 when absent"},
                   {"plane", scalar, "xy: moves in the section's x-y plane alone"}}};

const Schema reduction{"a reduction",
                       {{"basis", scalar,
                         "craig-bampton-inertia-relief (default), craig-bampton, clamped-free, "
                         "clamped-free-static or rubin"},
                        {"modes", scalar, "how many modes, or `all`"},
                        {"band", scalar, "every mode below this frequency, e.g. 50 Hz"}}};

const Schema matrices{"matrices",
                      {{"K", scalar, "stiffness, a Matrix Market file (.mtx) relative to the scene"},
                       {"M", scalar, "mass, likewise"},
                       {"labels", scalar, "a text file: `NODE DIRECTION [X Y Z]` for each row, sets"},
                       {"nastran", scalar, "a superelement's .asm or .pch, its .op4 beside it"},
                       {"calculix", scalar, "the common name of .sti, .mas and .dof"},
                       {"abaqus", scalar, "the common name of _STIFn.mtx and _MASSn.mtx"},
                       {"deck", scalar, "of `calculix` and `abaqus`: the .inp that tells where nodes are"}}};

const Key one_section{"section", map, "", false, &section};
const Key one_port{"port", list | map, "", false, &port};
const Key one_node_mass{"mass", map, "", false, &node_mass};
const Key one_node_spring{"spring", map, "", false, &node_spring};
const Key one_support{"support", scalar | list, ""};
const Schema sections{"sections", {}, &one_section};
const Schema ports{"ports", {}, &one_port};
const Schema node_masses{"masses", {}, &one_node_mass};
const Schema node_springs{"springs", {}, &one_node_spring};
const Schema supports{"supports", {}, &one_support};

const Schema body{
    "a body",
    {{"rigid", map, "a rigid body", false, &rigid},
     {"fe", scalar, "a mesh (.msh, .inp, .vtu, .vtk) or deck (.bdf, .dat, .inp), relative to the scene"},
     {"matrices", map, "K and M of another program", false, &matrices},
     {"reduced", scalar, "a *.body.json file, or the .f06 of a clamped modal run, its deck beside it"},
     {"beam", map, "a straight beam without a mesh", false, &beam},
     {"material", scalar | map, "of every section without one of its own", false, &material},
     {"sections", map, "set of cells -> section", false, &sections},
     {"beam_mass", scalar, "high-order (default), consistent or nastran"},
     {"fix", map, "set -> directions held, e.g. [x, y, rz], or all", false, &supports},
     {"masses", map, "lumped masses on nodes", false, &node_masses},
     {"springs", map, "between two nodes, or from one to ground", false, &node_springs},
     {"ignore", list, "sets whose cells carry no structure, or everywhere: all but solids that no section names"},
     {"allow", list, "cards of the file that may be read past although they carry stiffness or mass"},
     {"ports", map, "where the body can be joined", false, &ports},
     {"parent_port", scalar, "the port the body hangs by"},
     {"damping", scalar, "damping ratio of every mode"},
     {"reduction", scalar | map, "auto (default), rigid, or how to reduce", false, &reduction}}};

const Schema joint{"a joint",
                   {{"parent", scalar, "body.port", true},
                    {"child", scalar, "body.port", true},
                    {"weld", scalar, "true"},
                    {"revolute", scalar | list, "axis: x, y, z or a vector in the parent port's axes"},
                    {"angle", scalar, "at rest, e.g. 30 deg"},
                    {"near", scalar, "the angle follows from the loops, near this one"},
                    {"stiffness", scalar, "about the axis"},
                    {"damping", scalar, "about the axis"},
                    {"inertia", scalar, "of the drive, on the relative rotation"}}};

const Schema lumped_mass{"a mass",
                         {{"at", scalar, "body.port", true},
                          {"mass", scalar, "mass", true},
                          {"inertia", list, "about the port: three moments or a 3x3 matrix, body axes"}}};

const Schema input{"an input",
                   {{"at", scalar, "body.port, a body, or a joint", true},
                    {"force", scalar | list, "x, y, z or a list of them, world axes"},
                    {"torque", scalar | list, "x, y, z or a list of them, world axes"}}};

const Schema output{"an output",
                    {{"at", scalar, "body.port, a body, or a joint", true},
                     {"displacement", scalar | list, "x, y, z or a list of them, world axes"},
                     {"velocity", scalar | list, ""},
                     {"acceleration", scalar | list, ""},
                     {"rotation", scalar | list, ""},
                     {"angular_rate", scalar | list, ""},
                     {"angular_acceleration", scalar | list, ""},
                     {"measure", scalar, "of a joint: angle, rate or acceleration"}}};

const Schema units{"a system of units",
                   {{"length", scalar, "m, mm, cm, km, in or ft", true},
                    {"mass", scalar, "kg, g, t, lb, slug or slinch", true},
                    {"time", scalar, "s or ms", true},
                    {"force", scalar, "lbf, N, kN or kgf, where it is not mass · length / time²"}}};

const Schema requirement{"requirements",
                         {{"band", list, "[lowest, highest] frequency that matters, e.g. [0, 20 Hz]"},
                          {"tolerance", scalar, "relative error of frequencies that is accepted"}}};

const Schema run{"a run",
                 {{"duration", scalar, "as `time` of `simulation`"},
                  {"gravity", list, "as that of `simulation`; 0 for linear commands"}}};

const Schema force{"a force",
                   {{"constant", scalar, "a value in the unit of the input"},
                    {"step", scalar, "zero before `at`, then this value"},
                    {"at", scalar, "time of the step; 0 when absent"},
                    {"sine", scalar, "amplitude"},
                    {"frequency", scalar, "of the sine, e.g. 2 Hz"},
                    {"phase", scalar, "of the sine at time 0, e.g. 90 deg"},
                    {"table", list, "[[time, value], ...], linear between, held outside"}}};

const Schema initial{"an initial motion",
                     {{"angle", scalar, "of a joint, as in `joints`, e.g. 30 deg"},
                      {"rate", scalar, "of a joint, radians per unit of time"},
                      {"velocity", list, "of a floating body's reference, world axes"},
                      {"angular_rate", list, "of a floating body, world axes, radians per unit of time"}}};

const Key one_force{"force", scalar | map, "", false, &force};
const Key one_initial{"initial motion", map, "", false, &initial};
const Schema forces{"forces", {}, &one_force};
const Schema initials{"initial motions", {}, &one_initial};

const Key one_level{"level", scalar, "full, dropped, rigid or auto"};
const Schema levels{"deformation", {}, &one_level};

const Schema simulation{
    "a simulation",
    {{"time", scalar, "how long"},
     {"step", scalar, "of methods with fixed steps; the first one of others"},
     {"tolerance", scalar, "relative, of methods that choose their steps"},
     {"method", scalar, method_choice},
     {"sample", scalar, "time between samples"},
     {"gravity", list, "acceleration of gravity, world axes"},
     {"deformation", scalar | map,
      "full (default): moves ports and shifts mass; dropped; rigid; auto: what is enough; or body -> one", false,
      &levels},
     {"initial", map, "joint or floating body -> where and how fast it starts", false, &initials},
     {"forces", map, "input -> a value, or a force over time", false, &forces}}};

const Key one_body{"body", map, "", false, &body};
const Key one_joint{"joint", map, "", false, &joint};
const Key one_mass{"mass", map, "", false, &lumped_mass};
const Key one_input{"input", map, "", false, &input};
const Key one_output{"output", map, "", false, &output};
const Schema bodies{"bodies", {}, &one_body};
const Schema joints{"joints", {}, &one_joint};
const Schema lumped_masses{"masses", {}, &one_mass};
const Schema inputs{"inputs", {}, &one_input};
const Schema outputs{"outputs", {}, &one_output};

const Schema scene{
    "a scene",
    {{"units", scalar | map, "SI or {length, mass, time}: of this file and of unit-less files it names", false, &units},
     {"materials", map, "name -> material, for use by name", false, &materials},
     {"bodies", map, "name -> body", true, &bodies},
     {"joints", map, "name -> joint", false, &joints},
     {"masses", map, "name -> lumped mass at a port", false, &lumped_masses},
     {"ground", list, "ports held in the inertial frame"},
     {"inputs", map, "name -> input", false, &inputs},
     {"outputs", map, "name -> output", false, &outputs},
     {"requires", map, "what the scene is for", false, &requirement},
     {"run", map, "of a simulation, where `simulation` is silent", false, &run},
     {"simulation", map, "large motion, see `tenon simulate`", false, &simulation}}};

unsigned form_of(const Value& value) {
  switch (value.kind) {
    case Value::Kind::scalar:
      return scalar;
    case Value::Kind::list:
      return list;
    case Value::Kind::map:
      return map;
    case Value::Kind::null:
      break;
  }
  return 0;
}

std::string words(unsigned forms) {
  std::vector<std::string_view> names;
  if (forms & scalar) names.push_back("a value");
  if (forms & list) names.push_back("a list [...]");
  if (forms & map) names.push_back("a map {key: value}");
  return fmt::format("{}", fmt::join(names, " or "));
}

void check_form(const Value& value, const std::string& key, const Key& rule) {
  const unsigned form = form_of(value);
  if (form & rule.forms) return;
  throw InputError(value.place,
                   fmt::format("'{}' is {}, expected {}", key, form ? words(form) : "empty", words(rule.forms)),
                   rule.meaning.empty() ? "See the guide, docs/scene.md" : fmt::format("It means: {}", rule.meaning));
}

void refuse_unknown(const Member& member, const Schema& schema) {
  std::vector<std::string> known;
  for (const Key& key : schema.keys) known.emplace_back(key.name);
  const std::string near = fem::near_miss(member.key, known);
  throw InputError(
      member.place, fmt::format("{} has no key '{}'", schema.what, member.key),
      near.empty() ? fmt::format("Its keys are: {}", fmt::join(known, ", ")) : fmt::format("Did you mean '{}'?", near));
}

}  // namespace

const Schema& scene_schema() { return scene; }

void validate(const Value& value, const Schema& schema) {
  for (const Member& member : value.members) {
    const Key* rule = schema.each;
    for (const Key& key : schema.keys)
      if (key.name == member.key) rule = &key;
    if (!rule) refuse_unknown(member, schema);
    check_form(member.value, member.key, *rule);
    if (rule->inside && member.value.kind == Value::Kind::map) validate(member.value, *rule->inside);
  }
  for (const Key& key : schema.keys)
    if (key.required && !value.find(key.name))
      throw InputError(value.place, fmt::format("{} without '{}'", schema.what, key.name),
                       fmt::format("Add it: {}", key.meaning));
}

}  // namespace tenon::assembly
