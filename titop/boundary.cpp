#include "titop/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/error.hpp"

namespace tenon::titop {

Boundary boundary(const reduction::ReducedBody& body, const std::vector<End>& ends, Scope scope, BendingPlane plane) {
  if (ends.size() != body.ports.size())
    throw ModelError(fmt::format("{} ends for the {} ports of body '{}'", ends.size(), body.ports.size(), body.name),
                     "Give one end per port, in the order of the ports");
  if (scope != Scope::spatial && body.parent < 0)
    throw ModelError(fmt::format("body '{}' is free-free: nothing holds the directions outside the plane", body.name),
                     "Rebase it to a port, or give spatial ends");
  const std::size_t transverse = plane == BendingPlane::xy ? 1 : 2, rotation = plane == BendingPlane::xy ? 5 : 4;
  Boundary result;
  for (std::size_t p = 0; p < ends.size(); ++p) {
    PortCondition condition;
    for (std::size_t i = 0; i < 6; ++i) {
      const bool bends = i == transverse || i == rotation;
      if (!bends && (scope == Scope::bending || (scope == Scope::planar && i != 0)))
        condition.fixed[i] = static_cast<int>(p) == body.parent;
      else
        condition.fixed[i] = ends[p] == End::clamped || (ends[p] == End::pinned && i != rotation) ||
                             (ends[p] == End::sliding && i != transverse);
    }
    result.ports.push_back(condition);
  }
  return result;
}

std::vector<int> inverted_channels(const PortModel& model, const Boundary& boundary) {
  std::vector<int> I;
  const auto add = [&](int port, const std::vector<int>& channels, bool when_fixed) {
    const auto& fixed = boundary.ports.at(static_cast<std::size_t>(port)).fixed;
    for (std::size_t i = 0; i < 6; ++i)
      if (fixed[i] == when_fixed) I.push_back(channels[i]);
  };
  for (std::size_t k = 0; k < model.children.size(); ++k)
    add(model.children[k], model.child_channels(static_cast<int>(k)), true);
  add(model.parent, model.parent_channels(), false);
  return I;
}

Boundary boundary_of(const PortModel& model, const std::vector<int>& I) {
  Boundary result;
  result.ports.resize(model.children.size() + 1);
  const auto inverted = [&](int channel) { return std::find(I.begin(), I.end(), channel) != I.end(); };
  for (std::size_t k = 0; k < model.children.size(); ++k)
    for (std::size_t i = 0; i < 6; ++i)
      result.ports.at(static_cast<std::size_t>(model.children[k])).fixed[i] =
          inverted(model.child_channels(static_cast<int>(k))[i]);
  for (std::size_t i = 0; i < 6; ++i)
    result.ports.at(static_cast<std::size_t>(model.parent)).fixed[i] = !inverted(model.parent_channels()[i]);
  return result;
}

}  // namespace tenon::titop
