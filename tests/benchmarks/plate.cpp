#include "tests/benchmarks/plate.hpp"

namespace tenon::benchmarks {

fem::Model plate_model(const Plate& plate) {
  using fem::Vec3;
  fem::Model model;
  model.source = "benchmark plate";
  const fem::Mat3 R = plate.tilted ? Eigen::AngleAxisd(0.83, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix()
                                   : fem::Mat3(fem::Mat3::Identity());
  const int n = plate.n;
  const auto node = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      model.nodes.push_back(R * Vec3(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0));
      model.node_ids.push_back(node(i, j) + 1);
    }
  model.materials.push_back({"aluminium", 70e9, 70e9 / 2.66, 0.33, 2700.0});
  model.shell_sections.push_back({"skin", 0.01});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      model.elements.emplace_back(fem::Quad4{{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)},
                                             0,
                                             0,
                                             static_cast<long>(model.elements.size()) + 1});
  if (plate.clamped) {
    for (int j = 0; j <= n; ++j)
      for (int d = 0; d < 6; ++d) model.supports.push_back({{node(0, j), d}});
    return model;
  }
  for (const int i : {0, n}) {
    fem::RigidLink edge{static_cast<int>(model.nodes.size()), {}, fem::all_six, fem::Mat3::Identity(), 0};
    for (int j = 0; j <= n; ++j) edge.dependents.push_back(node(i, j));
    model.nodes.push_back(R * Vec3(i == 0 ? 0.0 : 1.0, 0.5, 0.0));
    model.node_ids.push_back(-1);
    model.ports.push_back({i == 0 ? "root" : "tip", edge.independent, R});
    model.rigid_links.push_back(std::move(edge));
  }
  return model;
}

}  // namespace tenon::benchmarks
