#pragma once

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tenon::fem::matrices {

/// A node and a direction 0..5, or a scalar point and −1.
using Label = std::pair<long, int>;

/// Numbers the dofs of a file in the order in which they are met.
class Numbering {
 public:
  /// @param word  0 for rows, 1 for columns: each stays at a node for several lines
  int operator()(std::size_t word, const Label& label);
  /// By number.
  const std::vector<Label>& labels() const { return labels_; }
  /// The numbers by rising labels.
  std::vector<std::size_t> order() const;

 private:
  using Numbers = std::array<int, 7>;  ///< by direction + 1, from 1 on; 0: not met yet
  std::unordered_map<long, Numbers> numbers_;
  std::array<std::pair<long, Numbers*>, 2> last_{};
  std::vector<Label> labels_;
};

}  // namespace tenon::fem::matrices
