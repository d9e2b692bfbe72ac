#pragma once

#include <string>
#include <vector>

#include "assembly/second_order.hpp"

namespace tenon::assembly {

/// What joints and ground transmit: for each closure row the force [N] or torque [N m] that the joint applies to its
/// child, or the ground to the body, along that row's direction; a column for each unit input.
struct Reactions {
  std::vector<std::string> names;  ///< of the rows: "joint 'tip', translation y"
  std::vector<std::string> units;  ///< "N" or "N m", per unit of the input
  Eigen::MatrixXcd value;          ///< rows×inputs
  std::vector<bool> determinate;   ///< equilibrium alone fixes the row; else its value is one of many, of least norm
};

/// Gᵀλ = M q̈ + C q̇ + K q − B u at ω [rad/s]: eq (4) of the TITOP paper with λ the wrench on the child. Where rows of G
/// are redundant, λ = (Gᵀ)⁺(...), torques weighed by the scene's size. Throws what response() throws.
Reactions reactions(const Network& network, const SecondOrderSystem& system, double omega);

}  // namespace tenon::assembly
