#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/frequency_response.hpp"
#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "interfaces/report/svg.hpp"

namespace tenon::cli {
namespace {

using assembly::FrequencyResponse;

/// What was computed, with names and units.
struct ResponseResult {
  titop::Channel input;
  std::vector<titop::Channel> outputs;
  std::vector<FrequencyResponse> responses;
};

/// Channels named `word`, or all of a family "word.x", "word.y".
std::vector<int> channels_named(const std::vector<titop::Channel>& channels, const std::string& word, const char* what,
                                const std::filesystem::path& scene) {
  std::vector<int> found;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (channels[k].name == word || channels[k].name.starts_with(word + ".")) found.push_back(static_cast<int>(k));
    names.push_back(channels[k].name);
  }
  if (found.empty()) {
    const std::string near = fem::near_miss(word, names);
    throw InputError({scene.string()}, fmt::format("there is no {} '{}'", what, word),
                     !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                     : names.empty() ? fmt::format("The scene names none: add `{}s`", what)
                                     : fmt::format("There are: {}", fmt::join(names, ", ")));
  }
  return found;
}

std::pair<double, double> band_of(const FrfOptions& options, const assembly::Scene& scene,
                                  const assembly::SystemModes& modes) {
  double low = 0.0, high = 0.0;
  if (!options.band_hz.empty()) {
    low = 2.0 * std::numbers::pi * options.band_hz[0];
    high = 2.0 * std::numbers::pi * options.band_hz[1];
  } else if (scene.requirement.band) {
    low = (*scene.requirement.band)[0];
    high = (*scene.requirement.band)[1];
  } else {
    throw InputError({scene.file.string()}, "no band is given",
                     "Add --band F0 F1 in Hz, or `requires: {band: [0, 20 Hz]}`");
  }
  if (low <= 0.0) {  // the logarithmic axis begins a decade below the first flexible mode, or three below the top
    const bool flexible = modes.omega.size() > modes.rigid && modes.omega[modes.rigid] < high;
    low = flexible ? modes.omega[modes.rigid] / 10.0 : high / 1000.0;
  }
  if (!(low < high)) throw InputError({"--band"}, "the band is empty", "Write the lower frequency first");
  return {low, high};
}

ResponseResult compute(const FrfOptions& options) {
  const assembly::Scene scene = assembly::read_scene(options.scene);
  assembly::Network network;
  {
    ProgressBar bar;
    network = assembly::build_network(scene, assembly::plan(scene), bar.callback());
  }
  const assembly::SecondOrderSystem system = assembly::second_order(network);
  const titop::StateSpace ss = assembly::state_space(network, system);
  const std::vector<int> inputs = channels_named(ss.inputs, options.from, "input", options.scene);
  if (inputs.size() > 1)
    throw InputError({"--from"}, fmt::format("'{}' names {} inputs", options.from, inputs.size()),
                     fmt::format("Choose one, e.g. {}", ss.inputs[static_cast<std::size_t>(inputs.front())].name));
  std::vector<int> outputs;
  for (const std::string& word : options.to)
    for (const int k : channels_named(ss.outputs, word, "output", options.scene)) outputs.push_back(k);

  const assembly::SystemModes modes = assembly::modes(system);
  const auto [low, high] = band_of(options, scene, modes);
  ResponseResult result{ss.inputs[static_cast<std::size_t>(inputs.front())], {}, {}};
  for (const int k : outputs) result.outputs.push_back(ss.outputs[static_cast<std::size_t>(k)]);
  result.responses = assembly::frequency_responses(system, outputs, inputs.front(),
                                                   assembly::response_grid(modes, low, high, options.points));
  return result;
}

double degrees(const std::complex<double>& value) { return std::arg(value) * 180.0 / std::numbers::pi; }

std::string ratio_unit(const ResponseResult& result, std::size_t k) {
  return fmt::format("({})/({})", result.outputs[k].unit, result.input.unit);
}

Json to_json(const ResponseResult& result) {
  Json object{{"from", result.input.name}, {"frequencies_hz", Json::array()}, {"responses", Json::array()}};
  for (const double omega : result.responses.front().omega) object["frequencies_hz"].push_back(hertz(omega));
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    Json gain = Json::array(), phase = Json::array();
    for (const auto& value : result.responses[k].value) {
      gain.push_back(std::abs(value));
      phase.push_back(degrees(value));
    }
    object["responses"].push_back(
        {{"to", result.outputs[k].name}, {"unit", ratio_unit(result, k)}, {"gain", gain}, {"phase_deg", phase}});
  }
  return object;
}

void write_csv(const std::filesystem::path& path, const ResponseResult& result) {
  fem::AtomicFile file(path);
  std::string line = "frequency_hz";
  for (std::size_t k = 0; k < result.outputs.size(); ++k)
    line += fmt::format(",{0} gain {1},{0} phase_deg", result.outputs[k].name, ratio_unit(result, k));
  file.stream() << line << '\n';
  for (std::size_t i = 0; i < result.responses.front().omega.size(); ++i) {
    line = fmt::format("{}", hertz(result.responses.front().omega[i]));
    for (const FrequencyResponse& response : result.responses)
      line += fmt::format(",{},{}", std::abs(response.value[i]), degrees(response.value[i]));
    file.stream() << line << '\n';
  }
  file.commit();
}

void write_output(const std::filesystem::path& path, const ResponseResult& result) {
  if (path.extension() == ".csv") return write_csv(path, result);
  if (path.extension() != ".json")
    throw InputError({path.string()}, "the response can be written as .csv or .json", "Choose one of the two endings");
  fem::AtomicFile file(path);
  file.stream() << to_json(result).dump() << '\n';
  file.commit();
}

report::Plot picture(const ResponseResult& result) {
  bool one_unit = true;
  for (const titop::Channel& output : result.outputs) one_unit = one_unit && output.unit == result.outputs.front().unit;
  report::Plot plot{.title = result.outputs.size() == 1
                                 ? fmt::format("{} to {}", result.input.name, result.outputs.front().name)
                                 : fmt::format("Responses to {}", result.input.name),
                    .x_label = "frequency [Hz]",
                    .y_label = one_unit ? fmt::format("gain [{}]", ratio_unit(result, 0)) : std::string("gain [SI]"),
                    .curves = {}};
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    report::Curve curve{result.outputs[k].name, {}, {}};
    for (std::size_t i = 0; i < result.responses[k].omega.size(); ++i) {
      curve.x.push_back(hertz(result.responses[k].omega[i]));
      curve.y.push_back(std::abs(result.responses[k].value[i]));
    }
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

/// Peaks of each response, highest first, at most eight.
void print_people(const ResponseResult& result) {
  const FrequencyResponse& first = result.responses.front();
  print(fmt::format("Response to {} [{}], {:.4g} to {:.4g} Hz, {} points", result.input.name, result.input.unit,
                    hertz(first.omega.front()), hertz(first.omega.back()), first.omega.size()));
  Table table({"<output", "peak at [Hz]", "gain", "phase [deg]", "<unit"});
  for (std::size_t k = 0; k < result.responses.size(); ++k) {
    const FrequencyResponse& response = result.responses[k];
    std::vector<std::size_t> peaks;
    for (std::size_t i = 1; i + 1 < response.value.size(); ++i)
      if (std::abs(response.value[i]) > std::abs(response.value[i - 1]) &&
          std::abs(response.value[i]) >= std::abs(response.value[i + 1]))
        peaks.push_back(i);
    std::sort(peaks.begin(), peaks.end(),
              [&](std::size_t a, std::size_t b) { return std::abs(response.value[a]) > std::abs(response.value[b]); });
    peaks.resize(std::min<std::size_t>(peaks.size(), 8));
    std::sort(peaks.begin(), peaks.end());
    if (peaks.empty()) table.row({result.outputs[k].name, "none", "", "", ratio_unit(result, k)});
    for (const std::size_t i : peaks)
      table.row({result.outputs[k].name, fmt::format("{:.6g}", hertz(response.omega[i])),
                 fmt::format("{:.4g}", std::abs(response.value[i])), fmt::format("{:.1f}", degrees(response.value[i])),
                 ratio_unit(result, k)});
  }
  print(table);
}

}  // namespace

int run(const FrfOptions& options) {
  const ResponseResult result = compute(options);
  if (!options.output.empty()) write_output(options.output, result);
  if (!options.svg.empty()) report::write_svg(options.svg, picture(result));
  if (options.json) {
    print(to_json(result));
    return done;
  }
  print_people(result);
  for (const auto& path : {options.output, options.svg})
    if (!path.empty()) print(fmt::format("Written: {}", path.string()));
  return done;
}

}  // namespace tenon::cli
