#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <set>

#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "fem/formats/deck.hpp"
#include "fem/formats/read_mesh.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/init_sections.hpp"
#include "interfaces/cli/input.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

/// A name that the scene's words can point at.
std::string as_word(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name.front()))) name.insert(0, "n");
  return name;
}

/// The same, told apart from `taken`, which it joins: words of names that differed.
std::string new_word(const std::string& name, std::set<std::string>& taken) {
  std::string word = as_word(name);
  while (!taken.insert(word).second) word += "_";
  return word;
}

/// Points of which the deck holds a direction: no joint can take them.
std::vector<bool> held_points(const fem::Mesh& mesh, const fem::Model& model) {
  std::vector<bool> held(mesh.points.size(), false);
  const auto hold = [&](int node) {
    if (const auto point = static_cast<std::size_t>(node); point < held.size()) held[point] = true;
  };
  for (const fem::Support& support : model.supports) hold(support.dof.node);
  for (const fem::LinearConstraint& constraint : model.constraints) {  // one node alone: held in turned directions
    const auto other = [&](const auto& term) { return term.dof.node != constraint.terms.front().dof.node; };
    if (!constraint.terms.empty() && std::ranges::none_of(constraint.terms, other))
      hold(constraint.terms.front().dof.node);
  }
  return held;
}

/// The point of the cells nearest to the origin that is not held, by its number in the file.
std::string free_point(const fem::Mesh& mesh, const std::vector<bool>& held) {
  int nearest = -1;
  for (const fem::CellBlock& block : mesh.cells)
    for (const int p : block.nodes) {
      const auto squared = [&](int q) { return mesh.points[static_cast<std::size_t>(q)].squaredNorm(); };
      if (!held[static_cast<std::size_t>(p)] && (nearest < 0 || squared(p) < squared(nearest))) nearest = p;
    }
  if (nearest < 0) return "{nearest: [0, 0, 0]}";
  return fmt::format("{{node: {}}}", mesh.point_ids[static_cast<std::size_t>(nearest)]);
}

/// Lines of a scene that name ports, and the word of the first.
struct PortLines {
  std::string text, first;
};

/// Sets of points as ports, small ones first; one that the deck holds, that shares points with those before, or that
/// holds most of the mesh, is left as a comment. `names`: words that are taken, theirs too afterwards.
PortLines port_lines(const fem::Mesh& mesh, const std::vector<bool>& held, const std::filesystem::path& file,
                     std::set<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> sets;
  for (const auto& [set, points] : mesh.point_sets) sets.emplace_back(points.size(), set);
  std::ranges::sort(sets);
  std::vector<bool> taken(mesh.points.size(), false);
  PortLines ports;
  for (const auto& [size, set] : sets) {
    const std::vector<int>& points = mesh.point_sets.at(set);
    if (points.empty()) continue;
    const auto any_in = [&](const std::vector<bool>& marked) {
      return std::ranges::any_of(points, [&](int p) { return marked[static_cast<std::size_t>(p)]; });
    };
    const char* reason = nullptr;
    if (any_in(held))
      reason = "held by the deck: take that out to join it here";
    else if (2 * size > mesh.points.size() && size > 1)
      reason = "most of the points";
    else if (any_in(taken))
      reason = "shares points with a port above";
    const std::string word = new_word(set, names);
    ports.text += fmt::format("      {}{}: {{set: {}}}{}{}\n", reason ? "# " : "", quoted(word, file),
                              quoted(set, file), reason ? "  # " : "", reason ? reason : "");
    if (reason) continue;
    if (ports.first.empty()) ports.first = word;
    for (const int p : points) taken[static_cast<std::size_t>(p)] = true;
  }
  if (!ports.first.empty()) return ports;
  const bool any_held = std::ranges::find(held, true) != held.end();
  ports.first = new_word("root", names);
  ports.text += fmt::format("      {}: {}\n", ports.first, any_held ? free_point(mesh, held) : "{nearest: [0, 0, 0]}");
  return ports;
}

/// Sets of lines along edges of shells, as comments: stiffeners, or where a shell is held or joined.
std::string edge_lines(const fem::Mesh& mesh, const std::filesystem::path& file, std::set<std::string>& names) {
  using Edge = std::pair<int, int>;
  const auto edge = [](int a, int b) { return Edge(std::min(a, b), std::max(a, b)); };
  std::set<Edge> edges;
  for (const fem::CellBlock& block : mesh.cells)
    if (fem::dimension(block.type) == 2) {
      const int n = fem::node_count(block.type), corners = n == 3 || n == 6 ? 3 : 4;
      for (std::size_t first = 0; first < block.nodes.size(); first += static_cast<std::size_t>(n))
        for (int i = 0; i < corners; ++i)
          edges.insert(edge(block.nodes[first + static_cast<std::size_t>(i)],
                            block.nodes[first + static_cast<std::size_t>((i + 1) % corners)]));
    }
  std::string text;
  for (const auto& [set, blocks] : mesh.cell_sets) {
    bool along_edges = dimension_of(mesh, blocks) == 1;
    for (std::size_t b = 0; b < blocks.size() && along_edges; ++b) {
      const auto width = static_cast<std::size_t>(fem::node_count(mesh.cells[b].type));
      for (const int c : blocks[b]) {
        const int* const line = &mesh.cells[b].nodes[static_cast<std::size_t>(c) * width];
        along_edges = along_edges && width > 1 && edges.contains(edge(line[0], line[1]));
      }
    }
    if (along_edges && !mesh.point_sets.contains(set))
      text += fmt::format("      # {}: {{set: {}}}  # lines along edges: a port, if it has no section above\n",
                          quoted(new_word(set, names), file), quoted(set, file));
  }
  return text;
}

/// What a deck brings along, and what it holds: comments.
std::string deck_lines(const fem::Model& model, const std::filesystem::path& file) {
  std::string text = "    # sections, materials and masses are the deck's own: `tenon info` lists them\n";
  if (!model.supports.empty())
    text += fmt::format("    # the deck holds {} dofs to the inertial frame (SPC, *BOUNDARY)\n", model.supports.size());
  std::vector<std::string> names;
  for (const fem::Loss& loss : model.losses)
    if (loss.changes_physics) {
      text += fmt::format("    # read past, and it carries stiffness or mass: {} × {}\n", loss.count, loss.name);
      names.push_back(quoted(loss.name, file));
    }
  if (!names.empty()) text += fmt::format("    # allow: [{}]  # to go on without them\n", fmt::join(names, ", "));
  return text;
}

/// What only the user knows stands in capitals; `tenon check` points at each until it is filled in.
std::string scene_for(const fem::Mesh& mesh, const std::string& contents, const PortLines& ports,
                      const std::filesystem::path& file, const std::filesystem::path& scene) {
  Eigen::AlignedBox3d box;
  for (const fem::Vec3& point : mesh.points) box.extend(point);
  const fem::Vec3 size = box.isEmpty() ? fem::Vec3(0.0, 0.0, 0.0) : fem::Vec3(box.sizes());
  const std::string body = as_word(file.stem().string());
  const std::filesystem::path from_scene =
      scene.empty() ? file.filename()
                    : std::filesystem::proximate(file, std::filesystem::absolute(scene).parent_path());
  return fmt::format(
      "# A scene for {0}: {1} points, {2:g} x {3:g} x {4:g} in its unit of length.\n"
      "# Words in CAPITALS are for you to replace; `tenon check` points at those that are left.\n"
      "units: UNITS                    # SI, or e.g. {{length: mm, mass: t, time: s}}: of this file and of the mesh\n"
      "bodies:\n"
      "  {5}:\n"
      "    fe: {8}\n"
      "{6}"
      "    ports:                      # where it is held or joined\n"
      "{7}"
      "    damping: 0.005\n"
      "    reduction: auto             # or {{basis: craig-bampton, modes: 12}}, or rigid\n"
      "joints: {{}}                      # e.g. drive: {{parent: hub.east, child: {5}.{9}, revolute: y, angle: 30 "
      "deg}}\n"
      "ground: []                      # ports fixed to the inertial frame, e.g. [{5}.{9}]\n"
      "inputs: {{}}                      # e.g. push: {{at: {5}.{9}, force: z}}\n"
      "outputs: {{}}                     # e.g. tip: {{at: {5}.{9}, acceleration: [x, y, z]}}\n"
      "requires: {{band: [0, BAND Hz], tolerance: 1e-3}}\n",
      file.filename().string(), mesh.points.size(), size.x(), size.y(), size.z(), body, contents, ports.text,
      quoted(from_scene.generic_string(), file), ports.first);
}

std::string scene_of(const std::filesystem::path& file, InputKind kind, const std::filesystem::path& scene) {
  std::set<std::string> names;
  if (kind == InputKind::deck) {
    const fem::Deck deck = fem::read_deck(file, true);
    const PortLines ports = port_lines(deck.mesh, held_points(deck.mesh, deck.model), file, names);
    return scene_for(deck.mesh, deck_lines(deck.model, file), ports, file, scene);
  }
  const fem::Mesh mesh = fem::read_mesh(file);
  const std::string sections =
      "    material: aluminium         # or steel, titanium, {E: ..., nu: ..., rho: ...}\n"
      "    sections:                   # one for each set of cells\n" +
      section_lines(mesh, file);
  PortLines ports = port_lines(mesh, std::vector<bool>(mesh.points.size(), false), file, names);
  ports.text += edge_lines(mesh, file, names);
  return scene_for(mesh, sections, ports, file, scene);
}

}  // namespace

int run(const InitOptions& options) {
  const InputKind kind = kind_of(options.mesh);
  if (kind == InputKind::scene)
    throw InputError({options.mesh.string()}, "this is a scene already", "Name a mesh or a deck");
  if (!options.output.empty() && std::filesystem::exists(options.output))
    throw InputError({options.output.string()}, "exists already", "Name another file, or remove this one first");
  const std::string text = scene_of(options.mesh, kind, options.output);
  if (options.output.empty()) {
    fmt::print("{}", text);
    return done;
  }
  fem::AtomicFile file(options.output);
  file.stream() << text;
  file.commit();
  print(fmt::format("Written: {}", options.output.string()));
  return done;
}

}  // namespace tenon::cli
