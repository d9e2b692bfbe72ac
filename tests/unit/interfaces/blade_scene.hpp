#pragma once

#include <string>

namespace tenon {

/// A blade on a flywheel too heavy to feel it, without inputs and motion: ρA 1.2, EI 1.4e4, L 10. Of the tests' own
/// choice: `rest` is what follows in the scene.
inline std::string blade_scene(const std::string& rest) {
  return R"(units: SI
materials: {m: {E: 2e11, nu: 0.25, rho: 1200}}
bodies:
  hub: {rigid: {mass: 1, inertia: [1, 1, 1]}, ports: {base: [0, 0, 0], axle: [0, 0, 0]}}
  blade:
    beam:
      from: [0, 0, 0]
      to: [10, 0, 0]
      section: {general: {A: 1e-3, Iy: 7e-8, Iz: 7e-8, J: 1.4e-7}, shear: euler-bernoulli, orientation: [0, 1, 0]}
      material: m
      elements: 20
    reduction: {modes: 6}
joints: {axle: {parent: hub.axle, child: blade.P, revolute: z, inertia: 1e10}}
ground: [hub.base]
)" + rest;
}

}  // namespace tenon
