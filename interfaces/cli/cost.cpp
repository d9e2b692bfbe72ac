#include "interfaces/cli/cost.hpp"

#include <fmt/format.h>

#include "assembly/build.hpp"
#include "assembly/integration/simulation.hpp"
#include "assembly/recursion/cost.hpp"
#include "interfaces/cli/output.hpp"
#include "interfaces/report/svg.hpp"

namespace tenon::cli {
namespace {

constexpr int most_modes = 15;  // as far as Figure 2 of the paper goes

/// One chain: section 8 of the spatial-operator paper beside the clock.
struct Row {
  int bodies, modes;
  double composite_flops, articulated_flops;
  assembly::MeasuredCost measured;

  double counted_ratio() const { return composite_flops / articulated_flops; }
  double measured_ratio() const { return measured.composite / measured.articulated; }
};

Row measure(int bodies, int modes) {
  return {bodies, modes, assembly::composite_flops(bodies, modes).total(),
          assembly::articulated_flops(bodies, modes).total(),
          assembly::measure_cost(assembly::beam_chain(bodies, modes))};
}

Json to_json(const Row& row) {
  return {{"bodies", row.bodies},
          {"modes", row.modes},
          {"composite_flops", row.composite_flops},
          {"articulated_flops", row.articulated_flops},
          {"counted_ratio", row.counted_ratio()},
          {"composite_s", row.measured.composite},
          {"articulated_s", row.measured.articulated},
          {"measured_ratio", row.measured_ratio()},
          {"cheaper", row.measured.articulated_is_cheaper() ? "articulated" : "composite"}};
}

report::Plot picture(const std::vector<Row>& rows) {
  report::Plot plot;
  plot.title = "Forward dynamics of a chain: what articulated bodies spare";
  plot.x_label = "modes of each body";
  plot.y_label = "cost of composite / articulated bodies";
  plot.log_x = false;
  for (const Row& row : rows) {
    if (row.modes == 0) {
      plot.curves.push_back({fmt::format("{} bodies, counted", row.bodies), {}, {}});
      plot.curves.push_back({fmt::format("{} bodies, measured", row.bodies), {}, {}});
    }
    report::Curve &measured = plot.curves.back(), &counted = plot.curves[plot.curves.size() - 2];
    counted.x.push_back(row.modes);
    counted.y.push_back(row.counted_ratio());
    measured.x.push_back(row.modes);
    measured.y.push_back(row.measured_ratio());
  }
  return plot;
}

void print_people(const std::vector<Row>& rows) {
  print(wrapped(
      "Forward dynamics of chains of flexible bodies: operations as section 8 of Jain and Rodriguez counts "
      "them (free-free modes), and the time of a chain of cantilevers here, which take fewer operations than counted.",
      0));
  Table table(
      {"bodies", "modes", "composite", "articulated", "ratio", "composite", "articulated", "ratio", "<cheaper here"});
  table.row({"", "", "[flop]", "[flop]", "", "[us]", "[us]", "", ""});
  for (const Row& row : rows)
    table.row({fmt::format("{}", row.bodies), fmt::format("{}", row.modes), fmt::format("{:.0f}", row.composite_flops),
               fmt::format("{:.0f}", row.articulated_flops), fmt::format("{:.2f}", row.counted_ratio()),
               fmt::format("{:.4g}", 1e6 * row.measured.composite),
               fmt::format("{:.4g}", 1e6 * row.measured.articulated), fmt::format("{:.2f}", row.measured_ratio()),
               row.measured.articulated_is_cheaper() ? "articulated" : "composite"});
  print(table);
}

/// The system that `tenon simulate` makes of a scene.
int run_scene(const DoctorOptions& options) {
  const assembly::Scene scene = assembly::read_moving_scene(options.scene);
  const assembly::SceneSimulation section = assembly::read_simulation(scene);
  ProgressBar bar;
  const assembly::Network network =
      assembly::build_network(scene, assembly::plan_motion(scene, section), bar.callback());
  const assembly::Simulation simulation = assembly::make_simulation(network, section);
  const assembly::Multibody& system = simulation.bodies.system;
  int modes = 0;
  for (const assembly::HingedBody& body : system.bodies) modes += body.modes();
  const assembly::MeasuredCost measured = assembly::measure_cost(system);
  if (options.json) {
    print(Json{{"bodies", system.bodies.size()},
               {"modes", modes},
               {"closures", system.closures.size()},
               {"composite_s", measured.composite},
               {"articulated_s", measured.articulated},
               {"cheaper", measured.articulated_is_cheaper() ? "articulated" : "composite"}});
    return done;
  }
  print(wrapped(
      fmt::format(
          "Forward dynamics of the tree of {}, {} bodies with {} modes and {} degrees of freedom of joints: {:.4g} us "
          "by articulated bodies, {:.4g} us by composite bodies. Cheaper: {}.",
          options.scene.filename().string(), system.bodies.size(), modes, system.nv - modes, 1e6 * measured.articulated,
          1e6 * measured.composite, assembly::cheaper(measured)),
      0));
  return done;
}

}  // namespace

int run_cost(const DoctorOptions& options) {
  if (!options.scene.empty()) return run_scene(options);
  std::vector<Row> rows;
  {
    ProgressBar bar;
    const reduction::Progress progress = bar.callback();
    const double all = static_cast<double>(options.bodies.size()) * (most_modes + 1);
    for (const int bodies : options.bodies)
      for (int modes = 0; modes <= most_modes; ++modes) {
        if (progress) progress(static_cast<double>(rows.size()) / all, "measuring");
        rows.push_back(measure(bodies, modes));
      }
  }
  if (!options.svg.empty()) report::write_svg(options.svg, picture(rows));
  if (options.json) {
    Json object{{"chains", Json::array()}};
    for (const Row& row : rows) object["chains"].push_back(to_json(row));
    print(object);
    return done;
  }
  print_people(rows);
  if (!options.svg.empty()) print(fmt::format("\nWritten: {}", options.svg.string()));
  return done;
}

}  // namespace tenon::cli
