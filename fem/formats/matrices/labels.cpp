#include "fem/formats/matrices/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "fem/error.hpp"
#include "fem/formats/matrices/text.hpp"

namespace tenon::fem {
namespace {

constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
constexpr long largest_number = std::numeric_limits<int>::max();

class Labels {
 public:
  explicit Labels(const std::filesystem::path& path)
      : text_(path, "Each line is `NODE DIRECTION [X Y Z]`, `scalar [NUMBER]` or `set NAME NODE ...`") {
    data_.source = path.string();
  }

  MatrixData read() {
    while (text_.next_line('#')) {
      const std::string_view first = text_.word("a node number, `scalar` or `set`");
      if (first == "scalar")
        scalar();
      else if (first == "set")
        set();
      else
        dof(first);
      text_.end_line('#');
    }
    if (data_.rows.empty()) throw InputError({text_.file()}, "the file labels no row", "Write one line a row");
    for (const auto& [node, at] : named_in_sets_)
      if (!nodes_.contains(node))
        text_.fail(at, fmt::format("a set names node {}, which has no row", node), "Name nodes of the matrices");
    number_scalars();
    return std::move(data_);
  }

 private:
  void dof(std::string_view first) {
    const std::size_t at = text_.offset();
    long node = 0;
    const auto [end, error] = std::from_chars(first.data(), first.data() + first.size(), node);
    if (error != std::errc() || end != first.data() + first.size() || node < 1 || node > largest_number) {
      const std::string near = near_miss(std::string(first), {"scalar", "set"});
      text_.fail(at, fmt::format("found {}, expected a node number, `scalar` or `set`", gmsh::quoted(first)),
                 near.empty() ? std::string() : fmt::format("Did you mean '{}'?", near));
    }
    const std::string_view word = text_.word("a direction");
    auto direction = static_cast<int>(std::find(directions.begin(), directions.end(), word) - directions.begin());
    if (direction == 6 && word.size() == 1 && word[0] >= '1' && word[0] <= '6') direction = word[0] - '1';
    if (direction == 6)
      text_.fail(text_.offset(), fmt::format("found the direction {}", gmsh::quoted(word)),
                 "Directions are ux uy uz rx ry rz, or 1 to 6");
    Seen& seen = nodes_[node];
    if ((seen.directions >> direction & 1U) != 0)
      text_.fail(at, fmt::format("node {} {} has a row already", node, directions[static_cast<std::size_t>(direction)]),
                 "Label each row with a dof of its own");
    seen.directions |= 1U << direction;
    data_.rows.push_back({node, direction, false});
    if (!text_.line_ends('#')) place(node);
  }

  void place(long node) {
    Vec3 x;
    for (const int i : {0, 1, 2}) x[i] = text_.real("a coordinate");
    const auto [known, made] = data_.positions.try_emplace(node, x);
    if (!made && known->second != x)
      text_.fail(text_.offset(),
                 fmt::format("node {} stands at ({}, {}, {}) here and at ({}, {}, {}) before", node, x.x(), x.y(),
                             x.z(), known->second.x(), known->second.y(), known->second.z()),
                 "Give its place once");
  }

  void scalar() {
    const bool numbered = !text_.line_ends('#');
    scalar_at_.push_back(text_.offset());
    data_.rows.push_back({numbered ? text_.whole("a number", 1, largest_number) : 0, 0, true});
  }

  void set() {
    std::vector<long>& set = data_.sets[std::string(text_.word("the name of the set"))];
    do {
      set.push_back(text_.whole("a node number", 1, largest_number));
      named_in_sets_.try_emplace(set.back(), text_.offset());
    } while (!text_.line_ends('#'));
  }

  /// Those without a number follow on the largest of all.
  void number_scalars() {
    long largest = 0;
    for (const MatrixRow& row : data_.rows) largest = std::max(largest, row.node);
    std::unordered_set<long> taken;
    std::size_t k = 0;
    for (MatrixRow& row : data_.rows) {
      if (!row.scalar) continue;
      if (row.node == 0) row.node = ++largest;
      if (nodes_.contains(row.node) || !taken.insert(row.node).second)
        text_.fail(scalar_at_[k], fmt::format("the number {} is taken already", row.node),
                   "Number scalar dofs apart from each other and from the nodes");
      ++k;
    }
  }

  struct Seen {
    unsigned directions = 0;
  };
  market::Text text_;
  MatrixData data_;
  std::unordered_map<long, Seen> nodes_;
  std::map<long, std::size_t> named_in_sets_;
  std::vector<std::size_t> scalar_at_;
};

}  // namespace

MatrixData read_matrix_labels(const std::filesystem::path& path) { return Labels(path).read(); }

}  // namespace tenon::fem
