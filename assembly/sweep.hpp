#pragma once

#include <vector>

#include "assembly/mode_shapes.hpp"
#include "assembly/second_order.hpp"
#include "reduction/modes.hpp"

namespace tenon::assembly {

/// Modes of a network at one angle of a joint.
struct SweepPoint {
  double angle = 0.0;          ///< of the swept joint [rad]
  std::vector<double> angles;  ///< of every joint, those that follow from loops solved [rad]
  int rigid = 0;
  Eigen::VectorXd omega;           ///< rigid ones first (0), as many as were asked for [rad/s]
  std::vector<BodyShapes> shapes;  ///< one column a mode; empty unless asked for
};

struct SweepOptions {
  double from = 0.0, to = 0.0;  ///< [rad]
  int steps = 2;                ///< points, both ends included
  int modes = 5;                ///< flexible modes kept at each point
  bool hold = false;            ///< the swept joint is clamped at each angle
  bool shapes = false;
};

/// The network at each angle of a revolute joint; joints that follow (Joint::follows) start each search from the
/// solution before. Throws ModelError for a joint that does not turn and, naming the angle, where a loop does not
/// close.
std::vector<SweepPoint> sweep(const Network& network, int joint, const SweepOptions& options,
                              const reduction::Progress& progress = {});

}  // namespace tenon::assembly
