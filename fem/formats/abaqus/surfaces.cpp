#include "fem/formats/abaqus/surfaces.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <set>

namespace tenon::fem::abaqus {
namespace {

/// ∫ N_i dA of three or four nodes in order; of others nothing.
std::vector<double> shares_of_area(const Model& model, const std::vector<int>& nodes) {
  const auto at = [&](std::size_t i) { return model.nodes[static_cast<std::size_t>(nodes[i])]; };
  if (nodes.size() == 3) return std::vector<double>(3, (at(1) - at(0)).cross(at(2) - at(0)).norm() / 6.0);
  if (nodes.size() != 4) return {};
  static constexpr std::array<double, 4> xi{-1, 1, 1, -1}, eta{-1, -1, 1, 1};  // corners, and √3 times the points
  std::vector<double> shares(4, 0.0);
  for (std::size_t p = 0; p < 4; ++p) {
    const double x = xi[p] / std::numbers::sqrt3, y = eta[p] / std::numbers::sqrt3;
    Vec3 along_xi = Vec3::Zero(), along_eta = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      along_xi += 0.25 * xi[i] * (1.0 + eta[i] * y) * at(i);
      along_eta += 0.25 * eta[i] * (1.0 + xi[i] * x) * at(i);
    }
    const double dA = along_xi.cross(along_eta).norm();
    for (std::size_t i = 0; i < 4; ++i) shares[i] += 0.25 * (1.0 + xi[i] * x) * (1.0 + eta[i] * y) * dA;
  }
  return shares;
}

const Block& surface_block(const Draft& draft, const Block& asker, const std::string& name) {
  const Block* found = nullptr;
  const std::string key = draft.key(name, asker);
  for (const Block& block : draft.text.blocks) {
    if (block.keyword != "SURFACE" || draft.key(block.value("NAME"), block) != key) continue;
    if (found)
      block.refuse(fmt::format("surface '{}' stands already at {}", block.value("NAME"), to_string(found->place)),
                   "Give it a name of its own or remove one of the two");
    found = &block;
  }
  if (!found) asker.refuse(fmt::format("there is no surface '{}'", name), "Define it by *SURFACE");
  return *found;
}

}  // namespace

Surface read_surface(const Draft& draft, const Block& asker, const std::string& name) {
  const Block& block = surface_block(draft, asker, name);
  Surface result;
  std::set<int> elements;
  DataLines line(block);
  while (line.next()) {
    if (block.upper_value("TYPE") == "NODE") {
      const double weight = line.real(1, "the weight of the nodes", 1.0);
      if (!(weight > 0.0)) line.fail(1, "a weight above 0");
      for (const int node : draft.nodes(line, 0, "a node or a node set")) result.weights[node] = weight;
      continue;
    }
    const std::string side = upper(line.at(1));
    if (!side.empty() && side != "SPOS" && side != "SNEG")
      line.refuse(1, fmt::format("side {} of elements is not read", side),
                  "Give the surface as a list of nodes (*SURFACE, TYPE=NODE)");
    if (const auto id = parse_integer(line.at(0))) {
      const auto element = draft.element_of.find(draft.number(block, *id));
      if (element == draft.element_of.end())
        line.refuse(0, fmt::format("element {} is not defined", *id), "Correct the number");
      elements.insert(element->second);
    } else {
      for (const int e : draft.element_set(std::string(line.at(0)), block, line.place(0))) elements.insert(e);
    }
  }
  for (const int e : elements) {
    const std::vector<int> nodes = draft.nodes_of(e);
    const std::vector<double> shares = shares_of_area(draft.deck.model, nodes);
    result.weighed = result.weighed && !shares.empty();
    for (std::size_t i = 0; i < nodes.size(); ++i) result.weights[nodes[i]] += shares.empty() ? 1.0 : shares[i];
  }
  return result;
}

}  // namespace tenon::fem::abaqus
