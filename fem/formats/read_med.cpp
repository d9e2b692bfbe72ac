#include "fem/formats/read_med.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <unordered_set>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/hdf5.hpp"
#include "fem/formats/med/kinds.hpp"
#include "fem/formats/rehearsal.hpp"
#include "fem/formats/vtk/grid.hpp"

// What MED calls its objects in HDF5: a mesh ENS_MAA/name/step has nodes NOE {COO, NUM, FAM} and cells MAI/type {NOD,
// NUM, FAM}, counted from 1; all lists run over the entities first, then over components. FAM is the family of each
// node or cell; FAS/name/NOEUD and /ELEME list the families and the groups (GRO/NOM) that each belongs to. A field
// CHA/name/step has values NOE/profile/CO and MAI.type/profile/CO.
namespace tenon::fem {
namespace {

using vtk::Values;

[[noreturn]] void med_fault(const std::string& what, const std::string& cure = "Write it again") {
  throw vtk::ArrayFault{what, cure};
}

/// Cells of one type, as they stand in the file.
struct TypeOfCells {
  std::string name, path;
  std::size_t first, n;  ///< place among all cells
};

/// The profile of values that all entities have.
constexpr std::string_view whole_mesh = "MED_NO_PROFILE_INTERNAL";

class MedReader {
 public:
  MedReader(const std::filesystem::path& path, std::size_t bytes) : file_(path), most_(100 * bytes), grid_(mesh_) {
    mesh_.source = path.string();
  }
  Mesh read();

 private:
  void read_heading();
  std::string find_mesh();
  std::string find_step(const std::string& mesh);
  void read_points(const std::string& nodes, const std::string& mesh);
  void read_cells(const std::string& cells);
  void read_families(const std::string& families, bool of_cells, const std::string& entities, std::size_t first,
                     std::size_t n);
  void read_fields(const std::string& mesh);
  void read_field(const std::string& name, const std::string& time, std::size_t components);
  std::vector<long> numbers_of(const std::string& entities, std::size_t n);
  void take_numbers();
  void charge(const std::string& what, std::uint64_t bytes);
  Values numbers(const std::string& dataset);
  Values rows(const std::string& dataset, std::size_t n, std::size_t components);
  void check_count(const std::string& dataset, std::size_t n) const;
  void check_profile(const std::string& entities) const;
  void lose_others(const std::string& group, const std::vector<std::string>& known, const std::string& note);
  void lose(const std::string& name, const std::string& note, long count = 1) {
    mesh_.losses.push_back({name, count, note});
  }

  hdf5::File file_;
  std::uint64_t most_;  ///< bytes that what is kept may still take
  Mesh mesh_;
  vtk::Grid grid_;
  std::string step_;  ///< path of the mesh's step
  std::size_t points_ = 0, cells_ = 0;
  std::vector<TypeOfCells> types_;
};

/// All that is kept together takes at most a hundred times the file.
void MedReader::charge(const std::string& what, std::uint64_t bytes) {
  if (bytes > most_) med_fault(fmt::format("{}: with all before, it takes more than a hundred times the file", what));
  most_ -= bytes;
}

Values MedReader::numbers(const std::string& dataset) {
  Values values = file_.values(dataset, most_);
  charge(dataset, sizeof(double) * values.size());
  return values;
}

void MedReader::check_count(const std::string& dataset, std::size_t n) const {
  const auto said = file_.number(dataset, "NBR");
  if (said && *said != static_cast<std::int64_t>(n))
    med_fault(fmt::format("'{}' holds {} entities, its NBR says {}", dataset, n, *said));
}

void MedReader::check_profile(const std::string& entities) const {
  const std::string profile = file_.text(entities, "PFL").value_or("");
  if (!profile.empty() && profile != whole_mesh)
    med_fault(fmt::format("'{}' is given on a part of the mesh, the profile '{}'", entities, profile),
              "Save the mesh without profiles");
}

void MedReader::lose_others(const std::string& group, const std::vector<std::string>& known, const std::string& note) {
  for (const std::string& name : file_.members(group))
    if (std::ranges::find(known, name) == known.end()) lose(fmt::format("{}/{}", group, name), note);
}

void MedReader::read_heading() {
  const auto major = file_.number("/INFOS_GENERALES", "MAJ");
  if (!major)
    med_fault("is an HDF5 file, but no MED file: it has no INFOS_GENERALES with a version", "Give a MED file");
  mesh_.format = fmt::format("med {}.{}", *major, file_.number("/INFOS_GENERALES", "MIN").value_or(0));
  if (*major != 3 && *major != 4)
    med_fault(fmt::format("found {}, expected version 3 or 4", mesh_.format),
              "Convert it: medimport in.med out.med, or save it from a later Salome");
}

std::string MedReader::find_mesh() {
  const std::vector<std::string> names = file_.members("/ENS_MAA");
  if (names.size() != 1)
    med_fault(names.empty() ? "holds no mesh"
                            : fmt::format("holds {} meshes, '{}', '{}'{}: which one is meant?", names.size(), names[0],
                                          names[1], names.size() > 2 ? ", …" : ""),
              "Save one mesh in the file");
  const std::string mesh = "/ENS_MAA/" + names[0];
  if (file_.number(mesh, "TYP").value_or(0) != 0)
    med_fault(fmt::format("the mesh '{}' is a structured grid", names[0]), "Convert it to an unstructured mesh");
  if (file_.number(mesh, "REP").value_or(0) != 0)
    med_fault(fmt::format("the mesh '{}' has cylindrical or spherical coordinates", names[0]),
              "Save it with cartesian ones");
  if (const std::string unit = file_.text(mesh, "UNI").value_or(""); unit.find_first_not_of(' ') != unit.npos)
    lose("UNI",
         fmt::format("coordinates in '{}': the scene states the unit of length", unit.substr(0, unit.find(' '))));
  return names[0];
}

/// The first computing step of the mesh; later ones move its nodes or change its cells.
std::string MedReader::find_step(const std::string& mesh) {
  std::vector<std::string> steps;
  for (const std::string& name : file_.members("/ENS_MAA/" + mesh))
    if (file_.has(fmt::format("/ENS_MAA/{}/{}/NOE", mesh, name)))
      steps.push_back(name);
    else
      lose(fmt::format("/ENS_MAA/{}/{}", mesh, name), "equivalences, joints or steps without nodes");
  if (steps.empty()) med_fault(fmt::format("the mesh '{}' has no nodes", mesh));
  if (steps.size() > 1) lose("ENS_MAA", "later steps of the mesh", std::ssize(steps) - 1);
  return fmt::format("/ENS_MAA/{}/{}", mesh, steps[0]);
}

void MedReader::read_points(const std::string& nodes, const std::string& mesh) {
  check_profile(nodes);
  const std::int64_t space = file_.number("/ENS_MAA/" + mesh, "ESP").value_or(3);
  if (space < 1 || space > 3)
    med_fault(fmt::format("the mesh '{}' lies in a space of {} dimensions (ESP), expected 1 to 3", mesh, space));
  const auto dimensions = static_cast<std::size_t>(space);
  const Values x = numbers(nodes + "/COO");
  if (x.size() % dimensions != 0)
    med_fault(fmt::format("'{}/COO' holds {} coordinates, expected {} of each node", nodes, x.size(), dimensions));
  points_ = x.size() / dimensions;
  check_count(nodes + "/COO", points_);
  if (file_.has(nodes + "/TRF"))
    med_fault(fmt::format("'{}' moves the nodes by a transformation (TRF)", nodes), "Save the nodes where they are");
  Values rows;
  rows.real = true;
  rows.reals.assign(3 * points_, 0.0);
  for (std::size_t d = 0; d < dimensions; ++d)
    for (std::size_t i = 0; i < points_; ++i) rows.reals[3 * i + d] = x.at(d * points_ + i);
  grid_.add_points(rows, points_);
}

void MedReader::read_cells(const std::string& cells) {
  Values nodes, ends, types;
  for (const std::string& name : file_.members(cells)) {
    const auto kind = std::ranges::find(med::kinds, name, &med::Kind::name);
    const std::string path = fmt::format("{}/{}", cells, name);
    if (kind == med::kinds.end())
      med_fault(fmt::format("'{}' are cells of MED's type {}, which is not read", path, name),
                "Convert them to points, lines, triangles, quadrilaterals or solids of first or second order");
    check_profile(path);
    const Values list = numbers(path + "/NOD");
    if (list.real) med_fault(fmt::format("'{}/NOD' holds reals, expected numbers of nodes", path));
    if (list.size() % kind->nodes != 0)
      med_fault(fmt::format("'{}/NOD' holds {} nodes, expected {} of each cell", path, list.size(), kind->nodes));
    const std::size_t n = list.size() / kind->nodes;
    check_count(path + "/NOD", n);
    for (const std::int64_t node : list.whole)
      if (node < 1 || node > static_cast<std::int64_t>(points_))
        med_fault(fmt::format("'{}/NOD' names node {} of {}", path, node, points_));
    for (std::size_t c = 0; c < n; ++c) {
      for (std::size_t i = 0; i < kind->nodes; ++i) nodes.whole.push_back(list.whole[kind->from(i) * n + c] - 1);
      ends.whole.push_back(std::ssize(nodes.whole));
      types.whole.push_back(kind->vtk);
    }
    lose_others(path, {"NOD", "NUM", "FAM"}, "no part of a mesh");
    if (n == 0) continue;
    types_.push_back({name, path, cells_, n});
    cells_ += n;
  }
  grid_.add_cells(nodes, ends, types, cells_);
}

/// Sets of the groups that the families of `entities` belong to: `n` points, or cells from `first` on.
void MedReader::read_families(const std::string& families, bool of_cells, const std::string& entities,
                              std::size_t first, std::size_t n) {
  if (!file_.has(entities + "/FAM")) return;
  const Values of = numbers(entities + "/FAM");
  if (of.real || of.size() != n)
    med_fault(fmt::format("'{}/FAM' holds {} {}, expected {} whole numbers", entities, of.size(),
                          of.real ? "reals" : "numbers", n));
  std::map<std::int64_t, Values> members;
  for (std::size_t i = 0; i < n; ++i)
    if (of.whole[i] != 0) members[of.whole[i]].whole.push_back(static_cast<std::int64_t>(first + i));
  for (const std::string& name : file_.members(families)) {
    const std::string family = fmt::format("{}/{}", families, name);
    const auto number = file_.number(family, "NUM");
    if (!number) med_fault(fmt::format("the family '{}' has no number (NUM)", family));
    const auto found = members.find(*number);
    if (found == members.end()) continue;
    if (file_.has(family + "/GRO/NOM"))
      for (const std::string& group : file_.texts(family + "/GRO/NOM", most_)) {
        charge(family + "/GRO/NOM", sizeof(std::string) + group.size() + sizeof(int) * found->second.size());
        if (!group.empty()) grid_.add_set(of_cells, group, found->second);
      }
    members.erase(found);
  }
  if (!members.empty())
    med_fault(
        fmt::format("'{}/FAM' names family {}, which '{}' does not hold", entities, members.begin()->first, families));
}

/// Values of `n` entities, component after component, as rows.
Values MedReader::rows(const std::string& dataset, std::size_t n, std::size_t components) {
  const Values columns = numbers(dataset);
  if (columns.size() != n * components)
    med_fault(fmt::format("'{}' holds {} values, expected {} of each of {} entities", dataset, columns.size(),
                          components, n));
  Values out;
  out.real = columns.real;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < components; ++c)
      if (columns.real)
        out.reals.push_back(columns.reals[c * n + i]);
      else
        out.whole.push_back(columns.whole[c * n + i]);
  return out;
}

void MedReader::read_fields(const std::string& mesh) {
  for (const std::string& name : file_.members("/CHA")) {
    const std::string field = "/CHA/" + name, what = fmt::format("field '{}'", name);
    if (file_.text(field, "MAI").value_or(mesh) != mesh) {
      lose(what, "values on another mesh");
      continue;
    }
    const std::vector<std::string> times = file_.members(field);
    if (times.empty()) continue;
    if (times.size() > 1) lose(what, "later times", std::ssize(times) - 1);
    const std::int64_t components = file_.number(field, "NCO").value_or(1);
    if (components < 1 || components > 1024)
      med_fault(fmt::format("'{}' has {} components (NCO), expected 1 to 1024", field, components));
    read_field(name, fmt::format("{}/{}", field, times[0]), static_cast<std::size_t>(components));
  }
}

/// The values at all nodes and at all cells of a type; others are lost.
void MedReader::read_field(const std::string& name, const std::string& time, std::size_t components) {
  Values at_cells;
  std::size_t covered = 0;
  for (const std::string& support : file_.members(time)) {
    const std::string path = fmt::format("{}/{}", time, support),
                      profile = file_.text(path, "PFL").value_or(std::string(whole_mesh)),
                      values = fmt::format("{}/{}", path, profile);
    const bool one_each = profile == whole_mesh && file_.number(values, "NGA").value_or(1) == 1;
    const auto type = std::ranges::find_if(types_, [&](const TypeOfCells& t) { return support == "MAI." + t.name; });
    if (one_each && support == "NOE") {
      grid_.add_data(false, name, rows(values + "/CO", points_, components), points_);
    } else if (one_each && type != types_.end()) {
      const Values found = rows(values + "/CO", type->n, components);
      if (covered == 0) charge(time, sizeof(double) * cells_ * components);
      at_cells.reals.resize(cells_ * components, std::numeric_limits<double>::quiet_NaN());
      for (std::size_t i = 0; i < found.size(); ++i) at_cells.reals[type->first * components + i] = found.at(i);
      at_cells.real = at_cells.real || found.real;
      covered += type->n;
    } else {
      lose(fmt::format("field '{}', {}", name, support), "values on a part of a mesh, or at several points of a cell");
    }
  }
  if (covered == 0) return;
  if (!at_cells.real && covered == cells_)
    at_cells.whole.assign(at_cells.reals.begin(), at_cells.reals.end());
  else
    at_cells.real = true;
  grid_.add_data(true, name, at_cells, cells_);
}

/// The file's numbers of `n` entities; none where it gives none.
std::vector<long> MedReader::numbers_of(const std::string& entities, std::size_t n) {
  if (!file_.has(entities + "/NUM")) return {};
  const Values given = numbers(entities + "/NUM");
  if (given.real || given.size() != n)
    med_fault(fmt::format("'{}/NUM' holds {} {}, expected {} whole numbers", entities, given.size(),
                          given.real ? "reals" : "numbers", n));
  return {given.whole.begin(), given.whole.end()};
}

/// Numbers of points and of cells as the file gives them, else counted from 1.
void MedReader::take_numbers() {
  const auto all_differ = [](const std::vector<long>& numbers) {
    return std::unordered_set<long>(numbers.begin(), numbers.end()).size() == numbers.size();
  };
  const std::vector<long> of_points = numbers_of(step_ + "/NOE", points_);
  if (!of_points.empty() && std::ranges::min(of_points) < 1)
    med_fault(
        fmt::format("'{}/NOE/NUM' gives a node the number {}, expected 1 or more", step_, std::ranges::min(of_points)),
        "Number the nodes anew");
  if (!all_differ(of_points))
    med_fault(fmt::format("'{}/NOE/NUM' gives two nodes the same number", step_), "Number the nodes anew");
  for (std::size_t i = 0; i < points_; ++i)
    mesh_.point_ids[i] = of_points.empty() ? static_cast<long>(i) + 1 : of_points[i];
  std::vector<long> of_cells;
  for (const TypeOfCells& type : types_) {
    const std::vector<long> given = numbers_of(type.path, type.n);
    of_cells.insert(of_cells.end(), given.begin(), given.end());
  }
  const bool given = of_cells.size() == cells_ && all_differ(of_cells) && std::ranges::min(of_cells) > 0;
  if (!given && !of_cells.empty())
    lose("NUM", "numbers of cells that are not one each from 1 on: they are counted from 1");
  for (std::size_t b = 0; b < types_.size(); ++b)
    for (std::size_t c = 0; c < types_[b].n; ++c) {
      const std::size_t cell = types_[b].first + c;
      mesh_.cells[b].ids[c] = given ? of_cells[cell] : static_cast<long>(cell) + 1;
    }
}

Mesh MedReader::read() {
  read_heading();
  const std::string mesh = find_mesh();
  step_ = find_step(mesh);
  const std::string nodes = step_ + "/NOE", cells = step_ + "/MAI", families = "/FAS/" + mesh;
  read_points(nodes, mesh);
  read_cells(cells);
  read_families(families + "/NOEUD", false, nodes, 0, points_);
  for (const TypeOfCells& type : types_) read_families(families + "/ELEME", true, type.path, type.first, type.n);
  read_fields(mesh);
  lose_others(step_, {"NOE", "MAI"}, "no part of a mesh");
  lose_others(nodes, {"COO", "NUM", "FAM"}, "no part of a mesh");
  grid_.finish();
  take_numbers();
  return std::move(mesh_);
}

}  // namespace

Mesh read_med(const std::filesystem::path& path, bool sound) {
  const MappedFile present(path);
  const auto read = [&] { return MedReader(path, present.bytes().size()).read(); };
  try {
    if (!sound) rehearse(path, read);
    return read();
  } catch (const vtk::ArrayFault& fault) {
    throw InputError({path.string()}, fault.what, fault.cure);
  }
}

}  // namespace tenon::fem
