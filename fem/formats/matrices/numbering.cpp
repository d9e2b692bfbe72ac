#include "fem/formats/matrices/numbering.hpp"

#include <algorithm>
#include <numeric>

namespace tenon::fem::matrices {

int Numbering::operator()(std::size_t word, const Label& label) {
  auto& [node, numbers] = last_.at(word);
  if (!numbers || node != label.first) {
    numbers = &numbers_[label.first];  // a map's elements stay where they are
    node = label.first;
  }
  int& number = numbers->at(static_cast<std::size_t>(label.second + 1));
  if (number == 0) {
    labels_.push_back(label);
    number = static_cast<int>(labels_.size());
  }
  return number - 1;
}

std::vector<std::size_t> Numbering::order() const {
  std::vector<std::size_t> order(labels_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return labels_[i]; });
  return order;
}

}  // namespace tenon::fem::matrices
