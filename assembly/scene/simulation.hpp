#pragma once

#include "assembly/scene.hpp"

/// The section `simulation:` of a scene: what large motion needs beyond the linear commands.
namespace tenon::assembly {

/// A number that changes with time, in the SI unit of what it drives.
struct Signal {
  enum class Kind { constant, step, sine, table };
  Kind kind = Kind::constant;
  double value = 0.0;                 ///< constant; height of the step; amplitude
  double at = 0.0;                    ///< of the step [s]
  double omega = 0.0, phase = 0.0;    ///< of the sine [rad/s, rad]
  std::vector<double> times, values;  ///< of the table: linear between, held outside
};

double value(const Signal& signal, double t);

/// Where a joint or a floating body starts.
struct InitialMotion {
  std::string name;  ///< of a revolute joint or of a body that floats
  Place place;
  bool joint = false;
  std::optional<double> angle;                           ///< of a joint, as its `angle` [rad]
  double rate = 0.0;                                     ///< of a joint [rad/s]
  Vec3 velocity = Vec3::Zero(), turning = Vec3::Zero();  ///< of a body's reference, world axes [m/s, rad/s]
};

struct SignalOn {
  std::string input;
  Place place;
  Signal signal;
};

/// What a body's modes do in motion: everything; bend it without moving its ports or shifting its mass; nothing; what
/// plan_deformation() finds to be enough (everything, where it is not asked).
enum class Flexibility { full, dropped, rigid, automatic };

struct SceneSimulation {
  std::optional<double> time, step, tolerance, sample;  ///< [s], relative
  std::string method;                                   ///< "" when not said
  std::map<std::string, Flexibility> deformation;       ///< of bodies; full where none is said
  Vec3 gravity = Vec3::Zero();                          ///< world axes [m/s²]
  std::vector<InitialMotion> initial;
  std::vector<SignalOn> forces;

  Flexibility of(const std::string& body) const {
    const auto found = deformation.find(body);
    return found == deformation.end() ? Flexibility::full : found->second;
  }
};

/// As read_scene(), and takes a gravity in `run`, which the linear commands would drop and therefore refuse.
Scene read_moving_scene(const std::filesystem::path& path);

/// The section of the scene's file, duration and gravity from `run` where it is silent; empty when there is neither.
/// Throws InputError like read_scene(), for joints, bodies and inputs that the scene does not have as well.
SceneSimulation read_simulation(const Scene& scene);

}  // namespace tenon::assembly
