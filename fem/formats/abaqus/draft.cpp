#include "fem/formats/abaqus/draft.hpp"

#include <fmt/format.h>

namespace tenon::fem::abaqus {
namespace {

using Sets = std::map<std::string, std::pair<std::string, std::vector<int>>>;

const std::vector<int>& find_set(const Sets& sets, const char* kind, const std::string& name, const Place& place) {
  const auto found = sets.find(upper(name));
  if (found != sets.end()) return found->second.second;
  std::vector<std::string> names;
  for (const auto& [key, set] : sets) names.push_back(key);
  const std::string near = near_miss(upper(name), names);
  throw InputError(place, fmt::format("there is no {} set '{}'", kind, name),
                   near.empty() ? fmt::format("Define it by *{}SET", *kind == 'n' ? "N" : "EL")
                                : fmt::format("Did you mean '{}'?", sets.at(near).first));
}

}  // namespace

void LossReport::add(const std::string& name, const std::string& note, long count) {
  for (Entry& entry : entries_)
    if (entry.loss.name == name && entry.loss.note == note) {
      entry.loss.count += count;
      return;
    }
  entries_.push_back({{name, count, note, false}, {}});
}

void LossReport::add_physical(const std::string& name, const std::string& note, const Place& place, long count) {
  add(name, note, count);
  for (Entry& entry : entries_)
    if (entry.loss.name == name && entry.loss.note == note && !entry.loss.changes_physics) {
      entry.loss.changes_physics = true;
      entry.first = place;
    }
}

std::vector<Loss> LossReport::losses() const {
  std::vector<Loss> result;
  for (const Entry& entry : entries_) result.push_back(entry.loss);
  return result;
}

void LossReport::refuse_physical() const {
  const Entry* first = nullptr;
  std::string all;
  for (const Entry& e : entries_) {
    if (!e.loss.changes_physics) continue;
    if (!first) first = &e;
    all += fmt::format("{}{} ({} found, first at {}): {}", all.empty() ? "" : "; ", e.loss.name, e.loss.count,
                       to_string(e.first), e.loss.note);
  }
  if (first)
    throw InputError(first->first, "reading on would change stiffness or mass: " + all,
                     "Replace what is named by keywords that are read, or allow losses when it does not matter");
}

int Draft::node(const DataLines& line, std::size_t field, const char* what) const {
  if (line.at(field).find('.') != std::string_view::npos && !parse_real(line.at(field))) {  // "arm-1.7"
    const std::vector<int> named = nodes(line, field, what);
    if (named.size() == 1) return named.front();
  }
  const long id = line.integer(field, what);
  const auto found = node_of.find(number(line.block(), id));
  if (found == node_of.end())
    line.refuse(field, fmt::format("node {} is not defined", id), "Add it to a *NODE block or correct the number");
  return found->second;
}

std::vector<int> Draft::nodes(const DataLines& line, std::size_t field, const char* what) const {
  if (parse_integer(line.at(field))) return {node(line, field, what)};
  if (line.at(field).empty()) line.fail(field, what);
  const std::string name(line.at(field));
  const std::size_t dot = name.rfind('.');  // "arm-1.7"
  if (const auto id = dot == name.npos ? std::nullopt : parse_integer(std::string_view(name).substr(dot + 1)))
    if (const auto of = instance_of.find(upper(name.substr(0, dot))); of != instance_of.end())
      if (const auto found = node_of.find(numbered_in(instances[static_cast<std::size_t>(of->second)], *id));
          found != node_of.end())
        return {found->second};
  return node_set(name, line.block(), line.place(field));
}

const std::vector<int>& Draft::node_set(const std::string& name, const Block& user, const Place& place) const {
  return find_set(node_sets, "node", full_name(name, user), place);
}

const std::vector<int>& Draft::element_set(const std::string& name, const Block& user, const Place& place) const {
  return find_set(element_sets, "element", full_name(name, user), place);
}

const Instance& Draft::scope(const Block& block) const {
  return block.scope < 0 ? model : instances[static_cast<std::size_t>(block.scope)];
}

std::string Draft::full_name(const std::string& name, const Block& block) const {
  return block.scope < 0 ? name : fmt::format("{}.{}", scope(block).name, name);
}

int Draft::instance(const Block& block) const {
  if (const auto found = instance_of.find(block.upper_value("INSTANCE")); found != instance_of.end())
    return found->second;
  std::vector<std::string> names;
  for (const Instance& instance : instances) names.push_back(instance.name);
  const std::string near = near_miss(block.value("INSTANCE"), names);
  block.refuse(fmt::format("there is no instance '{}'", block.value("INSTANCE")),
               near.empty() ? "Define it by *INSTANCE" : fmt::format("Did you mean '{}'?", near));
}

const DraftMaterial& Draft::material(const Block& section, const std::string& name) {
  const auto found = materials.find(upper(name));
  if (found == materials.end()) {
    std::vector<std::string> names;
    for (const auto& [key, m] : materials) names.push_back(key);
    const std::string near = near_miss(upper(name), names);
    section.refuse(name.empty() ? fmt::format("*{} names no material", section.keyword)
                                : fmt::format("there is no material '{}'", name),
                   near.empty() ? "Define it by *MATERIAL" : fmt::format("Did you mean '{}'?", near));
  }
  if (!(found->second.material.E > 0.0) && found->second.isotropic)
    section.refuse(fmt::format("material '{}' has no *ELASTIC", name), "Give its E and ν");
  if (found->second.varies)
    losses.add_physical(fmt::format("*MATERIAL {}", name),
                        "it varies with temperature, and its first numbers alone are read", section.place);
  return found->second;
}

std::vector<int> Draft::nodes_of(int element) const {
  const ListedElement& e = elements[static_cast<std::size_t>(element)];
  const auto first = element_nodes.begin() + e.first_node;
  return {first, first + e.nodes};
}

const Mat3& Draft::axes(int node) const {
  static const Mat3 basic = Mat3::Identity();
  const auto found = node_axes.find(node);
  return found == node_axes.end() ? basic : found->second;
}

}  // namespace tenon::fem::abaqus
