#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "assembly/network.hpp"
#include "assembly/scene/units.hpp"
#include "fem/error.hpp"
#include "reduction/reduce.hpp"

/// A scene as its file says it, in SI and radians: values only, nothing opened, nothing computed.
/// What is kept of it and why is plan.hpp's business; build.hpp makes models and networks from it.
namespace tenon::assembly {

/// Chooses nodes of a mesh.
struct NodeSelector {
  enum class Kind { at, nearest, node, set, port };
  Kind kind = Kind::at;
  Vec3 point = Vec3::Zero();   ///< at, nearest [m]
  std::optional<Vec3> centre;  ///< of a set: where its own node is made; the set's centroid when absent [m]
  long node = 0;               ///< the file's own number
  std::string name;            ///< of the set or port
  Place place;
};

struct ScenePort {
  std::string name;
  NodeSelector where;
  bool average = false;          ///< a set follows its port on average (RBE3), not rigidly (RBE2)
  Mat3 axes = Mat3::Identity();  ///< columns: the port's axes in the body frame
  Place place;
};

struct SceneSection {
  std::string set;  ///< of cells; "everywhere": all that no other section names
  std::variant<fem::BeamSection, fem::ShellSection> shape;
  fem::Material material;
  std::optional<Vec3> orientation;  ///< beams: needed unless the section is round; a laminate's direction 1
  bool round = false;
  std::function<fem::BeamSection(double)> taper{};  ///< the section at a fraction 0..1 of the way, where it varies
  std::optional<std::array<Vec3, 2>> along{};       ///< where the way begins and ends; of a `beam`: its ends [m]
  bool rod = false;                                 ///< bears axial force and torque alone: A and J of the shape
  bool rotary_inertia = true;
  Vec3 offset = Vec3::Zero();  ///< beams [m]
  double normal_offset = 0.0;  ///< shells: from the nodes to the middle surface, along the normal [m]
  Place place;
};

/// A set that the scene names; "everywhere": all lines and surfaces that no section names.
struct SceneSet {
  std::string name;
  Place place;
};

struct SceneSupport {
  std::string set;  ///< "everywhere": all nodes
  fem::Directions directions = fem::all_six;
  Place place;
};

struct SceneNodeMass {
  std::string name;
  NodeSelector where;
  double mass = 0.0;
  Mat3 inertia = Mat3::Zero();
  Vec3 offset = Vec3::Zero();
};

/// Springs in six directions between two nodes, or from one to ground.
struct SceneSpring {
  std::string name;
  NodeSelector from;
  std::optional<NodeSelector> to;  ///< absent: ground
  std::array<double, 6> k{};       ///< along and about `axes` [N/m, N m/rad]
  Mat3 axes = Mat3::Identity();    ///< columns, body frame
  std::optional<Vec3> at;          ///< where they act; absent: midway between the nodes [m]
};

struct RigidSource {
  double mass = 0.0;
  Vec3 centre = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();  ///< about the centre
};

/// K and M of another program.
struct MatrixFiles {
  enum class Program { matrix_market, nastran, calculix, abaqus };
  Program program = Program::matrix_market;
  std::filesystem::path K, M, labels;  ///< Matrix Market, and the labels of its rows
  std::filesystem::path job;           ///< Nastran: the .asm or .pch; of others the files' common name
  std::filesystem::path deck;          ///< tells where nodes are, and node sets; empty: none
};

struct FeSource {
  std::filesystem::path file;           ///< mesh, deck, or K of `matrices`
  std::optional<MatrixFiles> matrices;  ///< in place of a mesh
  Units units;                          ///< of the file
  std::vector<SceneSection> sections;
  std::vector<SceneSupport> supports;
  std::vector<SceneNodeMass> masses;
  std::vector<SceneSpring> springs;
  std::optional<fem::BeamMass> beam_mass;  ///< absent: high order for meshes, the deck's own for decks
  std::vector<SceneSet> ignore;            ///< sets that carry no structure
  std::vector<std::string> allow;          ///< losses that may change the physics
};

struct ReducedSource {
  std::filesystem::path file;
  Units units;  ///< of an .f06 and its deck; a body's file is in SI
};

/// A straight uniform beam without a mesh: ports P at `from`, C at `to`.
struct BeamSource {
  enum class Model { fe, polynomial, clamped_free };
  Model model = Model::fe;
  Vec3 from = Vec3::Zero(), to = Vec3::UnitX();  ///< [m]
  SceneSection section;                          ///< a beam's
  int elements = 32;                             ///< fe
  int modes = 4;                                 ///< clamped_free: a bending plane
  bool planar = false;  ///< moves in its x-y plane alone (axis and orientation span it); rigid out of it
};

struct SceneReduction {
  enum class Kind { automatic, rigid, chosen };
  Kind kind = Kind::automatic;
  reduction::Basis basis = reduction::Basis::craig_bampton_inertia_relief;
  std::optional<int> modes;
  std::optional<double> band;  ///< [rad/s]
  bool all = false;
};

struct SceneBody {
  std::string name;
  std::variant<RigidSource, FeSource, ReducedSource, BeamSource> source;
  std::vector<ScenePort> ports;  ///< of a reduced body: none, they stand in its file
  std::string parent_port;       ///< "" for a reduced body that keeps its own
  double damping = 0.0;
  SceneReduction reduction;
  Place place;

  /// Has a finite-element model of its own.
  bool has_model() const {
    return std::holds_alternative<FeSource>(source) || std::holds_alternative<BeamSource>(source);
  }
};

/// "body.port", or a body or a joint alone where the grammar allows it.
struct SceneTarget {
  std::string body, port;
  Place place;
};

struct SceneJoint {
  Joint joint;  ///< its ports are still names
  SceneTarget parent, child;
  Place place;
};

struct SceneMass {
  std::string name;
  SceneTarget at;
  double mass = 0.0;
  Mat3 inertia = Mat3::Zero();
};

/// One scalar input or output; `at.port` is empty for a body or a joint. A rigid body alone means its centre of mass,
/// another body alone its parent port.
struct SceneInput {
  std::string name;
  SceneTarget at;
  bool joint = false;
  int direction = 0;
};

struct SceneOutput {
  std::string name;
  SceneTarget at;
  bool joint = false;
  Quantity quantity = Quantity::acceleration;
  int direction = 0;
};

/// What the scene is for.
struct Requirement {
  std::optional<std::array<double, 2>> band;  ///< [rad/s]
  double tolerance = 1e-3;                    ///< of frequencies, relative
};

struct Scene {
  std::filesystem::path file;
  Units units;
  std::vector<SceneBody> bodies;
  std::vector<SceneJoint> joints;
  std::vector<SceneMass> masses;
  std::vector<SceneTarget> ground;
  std::vector<SceneInput> inputs;
  std::vector<SceneOutput> outputs;
  Requirement requirement;
};

/// Reads a scene (YAML or JSON). Throws InputError with line and column for anything that the grammar does not know:
/// unknown keys (with a near miss), missing keys, values of another kind, joints between unknown ports, units missing.
Scene read_scene(const std::filesystem::path& path);

/// The body of that name; throws InputError with a near miss.
const SceneBody& body_named(const Scene& scene, const std::string& name);

}  // namespace tenon::assembly
