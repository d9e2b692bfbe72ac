#include "fem/shell_directors.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <span>

namespace tenon::fem {
namespace {

/// The shells of a model, and those around each node.
struct Cells {
  std::vector<std::span<const int>> nodes;
  std::vector<Vec3> normal;    ///< unit; zero of a degenerate element, which assembly will refuse
  std::vector<int> start, at;  ///< cells of node i: at[start[i]] … at[start[i + 1] − 1]

  std::span<const int> around(int node) const {
    const auto i = static_cast<std::size_t>(node);
    return std::span(at).subspan(static_cast<std::size_t>(start[i]), static_cast<std::size_t>(start[i + 1] - start[i]));
  }
};

Cells cells_of(const Model& model) {
  Cells c;
  const auto x = [&](int node) -> const Vec3& { return model.nodes[static_cast<std::size_t>(node)]; };
  for (const Element& element : model.elements) {
    if (const auto* t = std::get_if<Tria3>(&element)) {
      c.nodes.emplace_back(t->nodes);
      c.normal.push_back((x(t->nodes[1]) - x(t->nodes[0])).cross(x(t->nodes[2]) - x(t->nodes[0])));
    } else if (const auto* q = std::get_if<Quad4>(&element)) {
      c.nodes.emplace_back(q->nodes);
      c.normal.push_back((x(q->nodes[2]) - x(q->nodes[0])).cross(x(q->nodes[3]) - x(q->nodes[1])));
    }
  }
  if (c.nodes.empty()) return c;
  for (Vec3& n : c.normal) n.normalize();
  c.start.assign(model.nodes.size() + 1, 0);
  for (const auto& cell : c.nodes)
    for (const int node : cell) ++c.start[static_cast<std::size_t>(node) + 1];
  for (std::size_t i = 0; i + 1 < c.start.size(); ++i) c.start[i + 1] += c.start[i];
  c.at.resize(static_cast<std::size_t>(c.start.back()));
  std::vector<int> next(c.start.begin(), c.start.end() - 1);
  for (std::size_t k = 0; k < c.nodes.size(); ++k)
    for (const int node : c.nodes[k])
      c.at[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] = static_cast<int>(k);
  return c;
}

constexpr double cos_crease = 0.93969262078590838;  // 20°

/// Mean of the normals around a node, in the sense of the first; zero at a crease.
Vec3 mean_normal(const Cells& cells, int node) {
  const std::span<const int> around = cells.around(node);
  if (around.empty()) return Vec3::Zero();
  const auto normal = [&](int cell) -> const Vec3& { return cells.normal[static_cast<std::size_t>(cell)]; };
  Vec3 sum = Vec3::Zero();
  for (const int cell : around) sum += normal(cell).dot(normal(around[0])) < 0.0 ? Vec3(-normal(cell)) : normal(cell);
  sum.normalize();
  for (const int cell : around)
    if (!(std::abs(normal(cell).dot(sum)) > cos_crease)) return Vec3::Zero();
  return sum;
}

/// The nodes of the elements around a node; where these are few, at an edge, of the elements around those too. Creases
/// are not crossed.
void ring(const Cells& cells, const std::vector<Vec3>& mean, int node, std::vector<int>& nodes) {
  constexpr std::size_t enough = 8;
  nodes.assign(1, node);
  for (std::size_t first = 0, turn = 0; turn < 2 && nodes.size() <= enough; ++turn) {
    const std::size_t last = nodes.size();
    for (; first < last; ++first) {
      if (mean[static_cast<std::size_t>(nodes[first])].isZero(0.0)) continue;
      for (const int cell : cells.around(nodes[first]))
        for (const int other : cells.nodes[static_cast<std::size_t>(cell)])
          if (std::find(nodes.begin(), nodes.end(), other) == nodes.end()) nodes.push_back(other);
    }
  }
}

/// The normal at nodes[0] of the quadric through it that fits the others best; where they leave it open (a strip one
/// element wide) the flattest.
Vec3 fitted_normal(const std::vector<Vec3>& x, const std::vector<int>& nodes, const Vec3& n) {
  using Vec5 = Eigen::Matrix<double, 5, 1>;
  using Mat5 = Eigen::Matrix<double, 5, 5>;
  const Vec3 e1 = n.unitOrthogonal(), e2 = n.cross(e1), &origin = x[static_cast<std::size_t>(nodes[0])];
  double size2 = 0.0;
  for (const int i : nodes) size2 = std::max(size2, (x[static_cast<std::size_t>(i)] - origin).squaredNorm());
  Mat5 A = Mat5::Zero();
  Vec5 b = Vec5::Zero();
  for (const int i : nodes) {
    const Vec3 d = (x[static_cast<std::size_t>(i)] - origin) / std::sqrt(size2);
    const double u = d.dot(e1), v = d.dot(e2);
    const Vec5 row = (Vec5() << u, v, 0.5 * u * u, u * v, 0.5 * v * v).finished();
    A += row * row.transpose();
    b += d.dot(n) * row;
  }
  Eigen::CompleteOrthogonalDecomposition<Mat5> solver;
  solver.setThreshold(1e-9);
  const Vec5 g = solver.compute(A).solve(b);
  return (n - g[0] * e1 - g[1] * e2).normalized();
}

}  // namespace

std::vector<Vec3> shell_directors(const Model& model) {
  const Cells cells = cells_of(model);
  if (cells.nodes.empty()) return {};
  const int n = static_cast<int>(model.nodes.size());
  std::vector<Vec3> mean(model.nodes.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) mean[static_cast<std::size_t>(i)] = mean_normal(cells, i);
  std::vector<Vec3> directors = mean;
#pragma omp parallel
  {
    std::vector<int> nodes;
#pragma omp for schedule(static)
    for (int i = 0; i < n; ++i) {
      Vec3& director = directors[static_cast<std::size_t>(i)];
      if (director.isZero(0.0)) continue;
      ring(cells, mean, i, nodes);
      const Vec3 fitted = fitted_normal(model.nodes, nodes, director);
      director = fitted.dot(director) > cos_crease ? fitted : Vec3(Vec3::Zero());
    }
  }
  return directors;
}

}  // namespace tenon::fem
