#pragma once

#include "assembly/integration/integrate.hpp"
#include "assembly/scene/simulation.hpp"

/// A network in large motion: where it starts, what drives it, and what is seen of it.
namespace tenon::assembly {

struct Simulation {
  NetworkMultibody bodies;
  MotionState start;               ///< loops closed
  double moved = 0.0;              ///< the gap of the loops before they were closed [m]
  std::vector<std::string> notes;  ///< sentences: what the bodies' data leave out
};

/// Throws ModelError or InputError for motions that joints and bodies cannot have, NumericalError for loops that do not
/// close.
Simulation make_simulation(const Network& network, const SceneSimulation& scene);

/// The forces of the section on the network's inputs. Refers to the simulation, which must stay where it is.
Loads make_loads(const Network& network, const Simulation& simulation, const SceneSimulation& scene);

/// Names of what is recorded of a sample, with units: outputs, energies, momenta, reactions of joints, closure gap.
struct Channel {
  std::string name, unit;
  std::string note{};  ///< what the number leaves out; mostly empty
};

/// Records samples; keeps work space. Outputs are taken as the linear commands take them: displacements and rotation
/// vectors of ports from the placed position, world axes; joint angles as the scene writes them, counting turns (that
/// of a joint which closes a loop from within half a turn at the first sample). Reactions: force and torque of a joint
/// on its child at the child's port, world axes; where joints hold more than they need to, those of least norm.
class Recorder {
 public:
  Recorder(const Network& network, const Simulation& simulation);
  const std::vector<Channel>& channels() const { return channels_; }
  std::size_t outputs() const { return network_.outputs.size(); }  ///< the first channels
  /// A row in the order of channels().
  const std::vector<double>& record(const Sample& sample);

 private:
  double output(const Output& output, const Sample& sample);
  double unwrap(std::size_t output, double angle, double rate, double t);
  void reactions(const Sample& sample);

  struct Turned {
    bool known = false;
    double angle = 0.0, rate = 0.0, t = 0.0;
  };
  const Network& network_;
  const Simulation& simulation_;
  std::vector<Channel> channels_;
  std::vector<RigidMotion> rest_;  ///< of the port of each output
  std::vector<Turned> turned_;     ///< the last of each output
  std::vector<double> row_;
  Eigen::VectorXd column_, T_;
  ClosureRows rows_;
  Mat6X closing_;  ///< 6×closures: wrench on the outer port, world axes
};

}  // namespace tenon::assembly
