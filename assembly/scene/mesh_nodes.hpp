#pragma once

#include <unordered_map>
#include <vector>

#include "assembly/scene.hpp"
#include "fem/model.hpp"

namespace tenon::assembly {

/// The nodes of a model as a scene names them: by number, by place, by set. Complaints point into the scene.
class MeshNodes {
 public:
  /// `mesh` gives the sets; nodes that no element, link or constraint of `model` uses are passed over.
  MeshNodes(const fem::Mesh& mesh, const fem::Model& model);

  /// Nodes of a set ("everywhere": all), sorted. Throws InputError at `place` when there is none, with near misses.
  std::vector<int> of_set(const std::string& set, const Place& place) const;
  /// The one node that a selector of kind at, nearest or node names, or of a set that has one node.
  int single(const NodeSelector& where) const;

 private:
  int nearest(const Vec3& point) const;
  std::string number(int node) const;

  const fem::Mesh& mesh_;
  const fem::Model& model_;
  std::vector<bool> used_;
  std::vector<bool> placed_;  // used, and at a known place: neither scalar points nor nodes of unplaced matrices
  std::unordered_map<long, int> by_id_;
  double size_ = 0.0;  // diagonal of the bounding box
};

}  // namespace tenon::assembly
