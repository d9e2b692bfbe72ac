#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "assembly/build.hpp"
#include "assembly/integration/checkpoint.hpp"
#include "assembly/integration/deflection.hpp"
#include "assembly/integration/deformation_plan.hpp"
#include "assembly/integration/simulation.hpp"
#include "assembly/recursion/stiffening.hpp"
#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "interfaces/report/npz.hpp"
#include "interfaces/report/svg.hpp"

namespace tenon::cli {
namespace {

const char* word(assembly::Flexibility level) {
  constexpr const char* words[] = {"full", "dropped", "rigid", "auto"};
  return words[static_cast<int>(level)];
}

/// A body with modes, and how far they moved a port.
struct Deforming {
  std::size_t index;
  std::string name;
  bool full;  ///< or dropped
  double deflection = 0.0;
};

struct RunResult {
  assembly::IntegrationOptions run;
  std::vector<assembly::Channel> channels;
  std::size_t outputs = 0;
  std::vector<double> t;
  std::vector<std::vector<double>> columns;
  assembly::Integration integration;
  assembly::IntegrationState state;
  std::vector<Deforming> bodies;
  std::vector<assembly::DeformationPlan> plan;
  double moved = 0.0, wall = 0.0;
  std::vector<std::string> notes;
};

/// Which method when none is named: fixed steps where a step and no tolerance is given, the command line before the
/// scene.
assembly::Method choose_method(const SimulateOptions& options, const assembly::SceneSimulation& scene) {
  const std::string& named = options.method.empty() ? scene.method : options.method;
  if (!named.empty()) return assembly::method_named(named);
  const bool by_line = options.step > 0.0 || options.tolerance > 0.0;
  const bool fixed = by_line ? options.tolerance == 0.0 : scene.step && !scene.tolerance;
  return fixed ? assembly::Method::generalized_alpha : assembly::Method::bdf;
}

/// The command line before the scene, the scene before what we choose.
assembly::IntegrationOptions run_options(const SimulateOptions& options, const assembly::SceneSimulation& scene) {
  const auto either = [](double given, const std::optional<double>& written) {
    return given > 0.0 ? given : written.value_or(0.0);
  };
  const Place place{options.scene.string()};
  assembly::IntegrationOptions run;
  run.until = either(options.time, scene.time);
  if (run.until == 0.0)
    throw InputError(place, "no duration is given", "Add --time T in s, or `simulation: {time: 10}`");
  run.step = either(options.step, scene.step);
  run.method = choose_method(options, scene);
  const bool fixed = assembly::fixed_steps(run.method);
  if (fixed && (options.tolerance > 0.0 || (scene.tolerance && options.method.empty() && options.step == 0.0)))
    throw InputError(
        place, fmt::format("a tolerance is given, and {} takes fixed steps, whatever their error", name(run.method)),
        "Leave the tolerance out, or choose --method bdf");
  if (!fixed) run.tolerance.relative = options.tolerance > 0.0 ? options.tolerance : scene.tolerance.value_or(1e-6);
  run.tolerance.absolute = 1e-2 * run.tolerance.relative;
  run.sample = either(options.sample, scene.sample);
  if (run.sample == 0.0) run.sample = run.until / 1000.0;
  if (fixed && run.step == 0.0 && options.resume.empty())
    throw InputError(place, fmt::format("{} takes fixed steps and none is given", name(run.method)),
                     "Add --step h in s, or choose --method bdf");
  return run;
}

/// A run that goes on keeps what it began with, unless the command line says otherwise.
assembly::IntegrationState resume(const SimulateOptions& options, const assembly::Multibody& system,
                                  assembly::IntegrationOptions& run) {
  assembly::Checkpoint checkpoint = assembly::read_checkpoint(options.resume, system);
  if (!options.method.empty() && checkpoint.method != run.method)
    throw InputError(
        {options.resume.string()},
        fmt::format("was written by {}, and the run would go on by {}", name(checkpoint.method), name(run.method)),
        fmt::format("Add --method {}", name(checkpoint.method)));
  if (options.tolerance > 0.0 && assembly::fixed_steps(checkpoint.method))
    throw InputError({options.resume.string()},
                     fmt::format("was written by {}, which takes no tolerance", name(checkpoint.method)),
                     "Leave --tolerance out");
  run.method = checkpoint.method;
  if (options.tolerance == 0.0) run.tolerance = checkpoint.tolerance;
  run.step = options.step;
  if (options.sample == 0.0) run.sample = checkpoint.state.sample;
  return std::move(checkpoint.state);
}

std::vector<Deforming> deforming(const assembly::Multibody& system) {
  std::vector<Deforming> bodies;
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    if (const assembly::HingedBody& body = system.bodies[k]; body.modes() > 0)
      bodies.push_back({k, body.name, body.deformation == assembly::Deformation::full});
  return bodies;
}

/// What the motion left out of bodies whose deformation is dropped, where it is not small.
void note_deflections(double tolerance, RunResult& result) {
  for (const Deforming& body : result.bodies)
    if (!body.full && body.deflection > tolerance)
      result.notes.push_back(
          fmt::format("Body '{}' deformed by {:.2g} of its size while its deformation is dropped: its ports and mass "
                      "stay where they were, and what follows from them is wrong by about that.",
                      body.name, body.deflection));
}

void note_spin(const assembly::Multibody& system, const assembly::SpinRatio& spin, RunResult& result) {
  if (spin.body < 0 || spin.ratio < 0.1) return;
  result.notes.push_back(fmt::format(
      "Body '{}' turned at {:.2g} of its first frequency and carries no geometric stiffening: its bending comes "
      "out wrong by about the square of that.",
      system.bodies[static_cast<std::size_t>(spin.body)].name, spin.ratio));
}

/// The folder of a run, made before it begins; gone again when the run is refused and nothing was written.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& path) : path_(path) {
    if (path.empty()) return;
    std::error_code fault;
    made_ = std::filesystem::create_directories(path, fault);
    if (fault) throw InputError({path.string()}, fault.message(), "Choose a folder that can be made");
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder() {
    std::error_code kept;  // a folder that holds something stays
    if (made_ && std::uncaught_exceptions() > 0) std::filesystem::remove(path_, kept);
  }

 private:
  std::filesystem::path path_;
  bool made_ = false;
};

RunResult compute(const SimulateOptions& options) {
  const assembly::Scene scene = assembly::read_moving_scene(options.scene);
  assembly::SceneSimulation section = assembly::read_simulation(scene);
  RunResult result;
  result.run = run_options(options, section);
  ProgressBar bar;
  const auto progress = bar.callback();
  const assembly::Network network = assembly::build_network(scene, assembly::plan_motion(scene, section), progress);
  const double band = scene.requirement.band ? (*scene.requirement.band)[1] : 0.0;
  result.plan =
      assembly::plan_deformation(network, section, result.run.until, scene.requirement.tolerance, band, progress);
  section = assembly::with_levels(std::move(section), result.plan);
  const assembly::Simulation simulation = assembly::make_simulation(network, section);
  const assembly::Multibody& system = simulation.bodies.system;
  if (options.method.empty() && section.method.empty() && result.run.method == assembly::Method::bdf &&
      !system.closures.empty())
    result.run.method = assembly::Method::dormand_prince;  // cheaper while the loops are not stiff
  const assembly::Loads loads = assembly::make_loads(network, simulation, section);
  result.moved = simulation.moved;
  result.notes = simulation.notes;
  result.state =
      options.resume.empty() ? assembly::begin(system, simulation.start) : resume(options, system, result.run);
  assembly::Recorder recorder(network, simulation);
  result.channels = recorder.channels();
  result.outputs = recorder.outputs();
  result.columns.resize(result.channels.size());
  result.bodies = deforming(system);
  assembly::SpinRatio spin;
  const auto observe = [&](const assembly::Sample& sample) {
    const std::vector<double>& row = recorder.record(sample);
    result.t.push_back(sample.t);
    for (std::size_t k = 0; k < row.size(); ++k) result.columns[k].push_back(row[k]);
    if (const auto now = assembly::spin_ratio(system, sample.dynamics.sweeps); now.ratio >= spin.ratio) spin = now;
    for (Deforming& body : result.bodies)
      body.deflection = std::max(body.deflection, assembly::deflection(system, body.index, sample.state.q));
    if (progress) progress(sample.t / result.run.until, "integrating");
    return true;
  };
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  auto written = begun;
  const auto save = [&](const assembly::IntegrationState& state) {
    written = Clock::now();
    assembly::write_checkpoint(options.out / "checkpoint.json", system,
                               {result.run.method, result.run.tolerance, state});
  };
  // every half minute: after a power cut the state is there to go on from, the rows are not
  const auto keep = [&](const assembly::IntegrationState& state) {
    if (!options.out.empty() && Clock::now() - written >= std::chrono::seconds(30)) save(state);
  };
  const OutputFolder folder(options.out);
  result.integration = assembly::integrate(system, loads, result.state, result.run, observe, keep);
  result.wall = std::chrono::duration<double>(Clock::now() - begun).count();
  if (!options.out.empty()) save(result.state);
  note_spin(system, spin, result);
  note_deflections(scene.requirement.tolerance, result);
  if (result.moved > 1e-9 && options.resume.empty())
    result.notes.push_back(fmt::format("The loops gaped by {:.2g} m at the start and were closed.", result.moved));
  return result;
}

void write_csv(const std::filesystem::path& path, const RunResult& result) {
  fem::AtomicFile file(path);
  file.stream() << "t_s";
  for (const assembly::Channel& c : result.channels) file.stream() << fmt::format(",{} [{}]", c.name, c.unit);
  file.stream() << '\n';
  for (std::size_t i = 0; i < result.t.size(); ++i) {
    file.stream() << fmt::format("{}", result.t[i]);
    for (const auto& column : result.columns) file.stream() << fmt::format(",{}", column[i]);
    file.stream() << '\n';
  }
  if (!result.integration.failure.empty()) file.stream() << "# incomplete: " << result.integration.failure << '\n';
  file.commit();
}

/// One picture for the outputs of each unit, one for the energies.
std::vector<std::filesystem::path> write_pictures(const SimulateOptions& options, const RunResult& result) {
  std::vector<std::filesystem::path> written;
  const auto draw = [&](const std::string& file, const std::string& title, const std::string& label, auto&& take) {
    report::Plot plot{
        .title = title, .x_label = "time [s]", .y_label = label, .curves = {}, .log_x = false, .log_y = false};
    for (std::size_t k = 0; k < result.channels.size(); ++k)
      if (take(k)) plot.curves.push_back({result.channels[k].name, result.t, result.columns[k]});
    if (plot.curves.empty()) return;
    written.push_back(options.out / file);
    report::write_svg(written.back(), plot);
  };
  std::vector<std::string> units;
  for (std::size_t k = 0; k < result.outputs; ++k)
    if (std::find(units.begin(), units.end(), result.channels[k].unit) == units.end())
      units.push_back(result.channels[k].unit);
  for (const std::string& unit : units) {
    std::string word = unit;
    std::replace(word.begin(), word.end(), '/', '_');
    draw(fmt::format("outputs_{}.svg", word), fmt::format("{}: outputs", options.scene.filename().string()),
         fmt::format("[{}]", unit),
         [&](std::size_t k) { return k < result.outputs && result.channels[k].unit == unit; });
  }
  draw("energy.svg", fmt::format("{}: energies", options.scene.filename().string()), "[J]",
       [&](std::size_t k) { return k >= result.outputs && result.channels[k].name.starts_with("energy."); });
  return written;
}

std::vector<std::filesystem::path> write_files(const SimulateOptions& options, const RunResult& result) {
  const std::string stem = options.resume.empty() ? "history" : fmt::format("history_from_{:g}", result.t.front());
  std::vector<std::filesystem::path> written{options.out / (stem + ".csv"), options.out / (stem + ".npz")};
  write_csv(written[0], result);
  std::vector<report::NamedArray> arrays{{"t_s", result.t}};
  for (std::size_t k = 0; k < result.channels.size(); ++k)
    arrays.push_back({result.channels[k].name, result.columns[k]});
  report::write_npz(written[1], arrays);
  for (auto& picture : write_pictures(options, result)) written.push_back(std::move(picture));
  written.push_back(options.out / "checkpoint.json");
  return written;
}

Json to_json(const RunResult& result, const std::vector<std::filesystem::path>& files) {
  const assembly::Integration& i = result.integration;
  Json object{{"method", name(result.run.method)},
              {"begin_s", result.t.front()},
              {"end_s", result.t.back()},
              {"complete", i.failure.empty()},
              {"failure", i.failure},
              {"samples", result.t.size()},
              {"steps", i.steps},
              {"rejected_steps", i.rejected},
              {"iterations", i.iterations},
              {"most_iterations_of_a_step", i.most_iterations},
              {"evaluations", i.evaluations},
              {"worst_closure_gap_m", i.worst_gap},
              {"wall_s", result.wall},
              {"channels", Json::array()},
              {"plan", Json::array()},
              {"deformation", Json::array()},
              {"notes", result.notes},
              {"files", Json::array()}};
  for (std::size_t k = 0; k < result.channels.size(); ++k) {
    const auto& c = result.columns[k];
    object["channels"].push_back({{"name", result.channels[k].name},
                                  {"unit", result.channels[k].unit},
                                  {"note", result.channels[k].note},
                                  {"first", c.front()},
                                  {"last", c.back()},
                                  {"least", *std::min_element(c.begin(), c.end())},
                                  {"most", *std::max_element(c.begin(), c.end())}});
  }
  for (const assembly::DeformationPlan& body : result.plan)
    object["plan"].push_back({{"body", body.body},
                              {"taken", word(body.level)},
                              {"deflection_of_size", body.deflection},
                              {"stiffness_change", body.softening},
                              {"why", body.why}});
  for (const Deforming& body : result.bodies)
    object["deformation"].push_back({{"body", body.name},
                                     {"taken", body.full ? "full" : "dropped"},
                                     {"largest_deflection_of_size", body.deflection}});
  for (const auto& file : files) object["files"].push_back(file.string());
  return object;
}

void print_deformation(const RunResult& result) {
  for (const assembly::DeformationPlan& body : result.plan)
    print(wrapped(fmt::format("Body '{}' is taken as {}: {}.", body.body, word(body.level), body.why), 0));
  if (result.bodies.empty()) return;
  Table table({"<body", "<deformation", "largest deflection / size"});
  for (const Deforming& body : result.bodies)
    table.row({body.name, body.full ? "full" : "dropped", fmt::format("{:.2g}", body.deflection)});
  print(table);
}

}  // namespace

int run(const SimulateOptions& options) {
  const RunResult result = compute(options);
  const assembly::Integration& i = result.integration;
  if (result.t.empty() && !i.failure.empty()) throw Error(i.failure);
  if (result.t.empty())
    throw InputError({options.resume.string()}, fmt::format("the run stands at {:.6g} s already", result.state.seen),
                     "Give a later --time");
  std::vector<std::filesystem::path> files;
  if (!options.out.empty()) files = write_files(options, result);
  const int status = i.failure.empty() ? done : check_failed;
  if (options.json) {
    print(to_json(result, files));
    return status;
  }
  print(fmt::format("{}: {:.6g} to {:.6g} s by {}, {} steps, {:.3g} s of computing", options.scene.string(),
                    result.t.front(), result.t.back(), name(result.run.method), i.steps, result.wall));
  Table table({"<of the motion", "first", "last", "least", "most", "<unit"});
  for (std::size_t k = 0; k < result.channels.size(); ++k) {
    const auto& c = result.columns[k];
    table.row({result.channels[k].name, fmt::format("{:.6g}", c.front()), fmt::format("{:.6g}", c.back()),
               fmt::format("{:.6g}", *std::min_element(c.begin(), c.end())),
               fmt::format("{:.6g}", *std::max_element(c.begin(), c.end())), result.channels[k].unit});
  }
  print(table);
  print_deformation(result);
  if (i.most_iterations > 0)
    print(fmt::format("At most {} iterations a step, {:.3g} on average.", i.most_iterations,
                      static_cast<double>(i.iterations) / static_cast<double>(std::max(1L, i.steps))));
  for (const std::string& note : result.notes) print(wrapped(note, 0));
  for (const assembly::Channel& c : result.channels)
    if (!c.note.empty()) print(wrapped(fmt::format("{} {}.", c.name, c.note), 0));
  if (!i.failure.empty()) print(wrapped(fmt::format("Incomplete: {}", i.failure), 0));
  for (const auto& file : files) print(fmt::format("Written: {}", file.string()));
  return status;
}

}  // namespace tenon::cli
