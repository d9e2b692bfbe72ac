#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The commands of the program: what their options say, and a function that runs them and returns the exit status.
namespace tenon::cli {

/// What a mesh or deck holds.
struct InfoOptions {
  std::filesystem::path file;
  bool json = false;
};
int run(const InfoOptions& options);

/// A mesh, or the mesh of a deck, in another format.
struct ExportOptions {
  std::filesystem::path input, output;
  bool binary = false;
};
int run(const ExportOptions& options);

/// A commented scene for a mesh.
struct InitOptions {
  std::filesystem::path mesh, output;
};
int run(const InitOptions& options);

/// Reads and plans a scene and checks its bodies; or checks a mesh or deck alone.
struct CheckOptions {
  std::filesystem::path input;
  std::vector<std::string> allow;
  bool json = false;
};
int run(const CheckOptions& options);

/// Natural frequencies of a scene or a deck.
struct ModesOptions {
  std::filesystem::path file, vtu;
  int count = 20;
  std::vector<double> band_hz;
  std::vector<std::string> clamp, allow;
  bool full = false, json = false;
};
int run(const ModesOptions& options);

/// One body of a scene, reduced.
struct ReduceOptions {
  std::filesystem::path scene, output;
  std::string body;
  bool linear = false, json = false;
};
int run(const ReduceOptions& options);

/// The linear system of a scene.
struct AssembleOptions {
  std::filesystem::path scene, output;
  std::optional<double> reactions_hz;
  bool linearise = false;
  bool json = false;
};
int run(const AssembleOptions& options);

/// Frequency responses of a scene.
struct FrfOptions {
  std::filesystem::path scene, output, svg;
  std::string from;
  std::vector<std::string> to;
  std::vector<double> band_hz;
  int points = 400;
  bool json = false;
};
int run(const FrfOptions& options);

/// Modes against the angle of a joint.
struct SweepOptions {
  std::filesystem::path scene, output, svg, shapes;
  std::string joint, from = "0", to = "360";
  std::vector<double> at;
  int steps = 37, modes = 5;
  bool hold = false, json = false;
};
int run(const SweepOptions& options);

/// Large motion over time.
struct SimulateOptions {
  std::filesystem::path scene, out, resume;
  double time = 0.0, step = 0.0, tolerance = 0.0, sample = 0.0;
  std::string method;
  bool json = false;
};
int run(const SimulateOptions& options);

/// Analytic against finite-element beams.
struct BeamOptions {
  double length = 0.0;
  std::string section, material, bc;
  int modes = 2, elements = 64;
  std::filesystem::path svg;
  bool json = false;
};
int run(const BeamOptions& options);

/// What the program runs on, and what dynamics cost there.
struct DoctorOptions {
  bool cost = false;            ///< what forward dynamics costs, counted and measured
  std::filesystem::path scene;  ///< measured itself, in place of chains
  std::vector<int> bodies{10};  ///< of the chains
  std::filesystem::path svg;    ///< a picture of the ratios (Figure 2 of the paper); none when empty
  bool json = false;
};
int run(const DoctorOptions& options);

}  // namespace tenon::cli
