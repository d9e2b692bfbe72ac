#include "assembly/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "assembly/build.hpp"
#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "interfaces/report/motion_svg.hpp"
#include "interfaces/report/svg.hpp"

namespace tenon::cli {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct SweepResult {
  std::string joint;
  std::vector<std::string> joints;  ///< names of all
  std::vector<assembly::SweepPoint> points;
  std::vector<assembly::SweepPoint> pictures;  ///< with shapes
};

int joint_named(const assembly::Network& network, const std::string& word, const std::filesystem::path& scene) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < network.joints.size(); ++k) {
    if (network.joints[k].name == word) return static_cast<int>(k);
    names.push_back(network.joints[k].name);
  }
  const std::string near = fem::near_miss(word, names);
  throw InputError({scene.string()}, fmt::format("there is no joint '{}'", word),
                   !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                   : names.empty() ? "The scene has none: add `joints`"
                                   : fmt::format("There are: {}", fmt::join(names, ", ")));
}

/// "90", "90 deg" or "1.2 rad" [rad].
double angle_of(const std::string& text, const char* option) {
  std::size_t end = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = std::string::npos;
  }
  std::string unit = end == std::string::npos ? "?" : text.substr(end);
  unit.erase(0, unit.find_first_not_of(' ') == std::string::npos ? unit.size() : unit.find_first_not_of(' '));
  if (!std::isfinite(value) || (unit != "" && unit != "deg" && unit != "rad"))
    throw InputError({option}, fmt::format("'{}' is no angle", text), "Write degrees: 90, '90 deg' or '1.57 rad'");
  return unit == "rad" ? value : value * degree;
}

SweepResult compute(const SweepOptions& options) {
  const assembly::Scene scene = assembly::read_scene(options.scene);
  ProgressBar bar;
  const assembly::Network network = assembly::build_network(scene, assembly::plan(scene), bar.callback());
  const int joint = joint_named(network, options.joint, options.scene);
  SweepResult result{options.joint, {}, {}, {}};
  for (const assembly::Joint& j : network.joints) result.joints.push_back(j.name);
  assembly::SweepOptions sweep{.from = angle_of(options.from, "--from"),
                               .to = angle_of(options.to, "--to"),
                               .steps = options.steps,
                               .modes = options.modes,
                               .hold = options.hold};
  result.points = assembly::sweep(network, joint, sweep, bar.callback());
  sweep.shapes = true;
  for (const double at : options.at) {  // from the start on, so that loops follow to the same configuration
    sweep.to = at * degree;
    sweep.steps = std::max(2, 1 + static_cast<int>(std::abs(sweep.to - sweep.from) / (5.0 * degree)));
    result.pictures.push_back(assembly::sweep(network, joint, sweep, bar.callback()).back());
  }
  return result;
}

std::size_t flexible_modes(const SweepResult& result, int asked) {
  std::size_t most = 0;
  for (const assembly::SweepPoint& point : result.points)
    most = std::max(most, static_cast<std::size_t>(point.omega.size() - point.rigid));
  return std::min(most, static_cast<std::size_t>(asked));
}

double flexible(const assembly::SweepPoint& point, std::size_t k) {
  const Eigen::Index at = point.rigid + static_cast<Eigen::Index>(k);
  return at < point.omega.size() ? point.omega[at] : std::numeric_limits<double>::quiet_NaN();
}

Json to_json(const SweepResult& result, const SweepOptions& options) {
  Json object{{"joint", result.joint}, {"held", options.hold}, {"points", Json::array()}};
  for (const assembly::SweepPoint& point : result.points) {
    Json entry{{"angle_deg", point.angle / degree}, {"rigid_modes", point.rigid}, {"frequencies_hz", Json::array()}};
    for (const double omega : point.omega) entry["frequencies_hz"].push_back(hertz(omega));
    for (std::size_t j = 0; j < result.joints.size(); ++j)
      entry["joint_angles_deg"][result.joints[j]] = point.angles[j] / degree;
    object["points"].push_back(std::move(entry));
  }
  return object;
}

void write_csv(const std::filesystem::path& path, const SweepResult& result, std::size_t modes) {
  fem::AtomicFile file(path);
  file.stream() << result.joint << "_deg,rigid_modes";
  for (std::size_t k = 0; k < modes; ++k) file.stream() << fmt::format(",f{}_hz", k + 1);
  file.stream() << '\n';
  for (const assembly::SweepPoint& point : result.points) {
    file.stream() << fmt::format("{},{}", point.angle / degree, point.rigid);
    for (std::size_t k = 0; k < modes; ++k) file.stream() << fmt::format(",{}", hertz(flexible(point, k)));
    file.stream() << '\n';
  }
  file.commit();
}

report::Plot picture(const SweepResult& result, std::size_t modes, bool hold) {
  report::Plot plot{.title = fmt::format("Natural frequencies against the angle of '{}'{}", result.joint,
                                         hold ? ", held at each angle" : ""),
                    .x_label = "angle [deg]",
                    .y_label = "frequency [Hz]",
                    .curves = {},
                    .log_x = false,
                    .log_y = false};
  for (std::size_t k = 0; k < modes; ++k) {
    report::Curve curve{fmt::format("mode {}", k + 1), {}, {}};
    for (const assembly::SweepPoint& point : result.points) {
      curve.x.push_back(point.angle / degree);
      curve.y.push_back(hertz(flexible(point, k)));
    }
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

/// PREFIX_0.svg, PREFIX_180.svg ... of --shapes PREFIX.svg; the file itself when there is one angle.
std::vector<std::filesystem::path> write_shapes(const SweepResult& result, const SweepOptions& options) {
  std::vector<std::filesystem::path> written;
  for (std::size_t p = 0; p < result.pictures.size(); ++p) {
    const assembly::SweepPoint& point = result.pictures[p];
    report::MotionPicture motion{
        .title = fmt::format("'{}' at {:.4g} deg{}", result.joint, point.angle / degree, options.hold ? ", held" : ""),
        .bodies = {},
        .captions = {}};
    for (assembly::BodyShapes body : point.shapes) {
      body.translations = body.translations.rightCols(body.translations.cols() - point.rigid).eval();
      if (!body.skeleton || body.nodes.size() > 1) motion.bodies.push_back(std::move(body));
    }
    for (Eigen::Index k = point.rigid; k < point.omega.size(); ++k)
      motion.captions.push_back(
          fmt::format("mode {}: {:.5g} Hz ({:.5g} rad/s)", k - point.rigid + 1, hertz(point.omega[k]), point.omega[k]));
    std::filesystem::path path = options.shapes;
    if (result.pictures.size() > 1)
      path.replace_filename(fmt::format("{}_{:g}{}", path.stem().string(), options.at[p], path.extension().string()));
    report::write_motion_svg(path, motion);
    written.push_back(path);
  }
  return written;
}

}  // namespace

int run(const SweepOptions& given) {
  SweepOptions options = given;
  if (!options.shapes.empty() && options.at.empty()) options.at = {0.0, 180.0};
  if (options.shapes.empty() && !options.at.empty())
    throw InputError({"--at"}, "angles are given for pictures that are not asked for", "Add --shapes FILE.svg");
  const SweepResult result = compute(options);
  const std::size_t modes = flexible_modes(result, options.modes);
  std::vector<std::filesystem::path> written;
  if (!options.output.empty()) write_csv(options.output, result, modes), written.push_back(options.output);
  if (!options.svg.empty())
    report::write_svg(options.svg, picture(result, modes, options.hold)), written.push_back(options.svg);
  for (auto& path : write_shapes(result, options)) written.push_back(path);
  if (options.json) {
    print(to_json(result, options));
    return done;
  }
  print(fmt::format("{}: flexible modes [Hz] against the angle of '{}'{}, {} rigid", options.scene.string(),
                    result.joint, options.hold ? ", held" : "", result.points.front().rigid));
  std::vector<std::string> heads{"angle [deg]"};
  const std::size_t shown = std::min<std::size_t>(modes, 6);
  for (std::size_t k = 0; k < shown; ++k) heads.push_back(fmt::format("mode {}", k + 1));
  Table table(heads);
  for (const assembly::SweepPoint& point : result.points) {
    std::vector<std::string> row{fmt::format("{:.5g}", point.angle / degree)};
    for (std::size_t k = 0; k < shown; ++k) row.push_back(fmt::format("{:.6g}", hertz(flexible(point, k))));
    table.row(std::move(row));
  }
  print(table);
  for (const auto& path : written) print(fmt::format("Written: {}", path.string()));
  return done;
}

}  // namespace tenon::cli
