#include <fmt/format.h>

#include <cmath>

#include "assembly/build.hpp"
#include "fem/error.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"
#include "reduction/body_file.hpp"

namespace tenon::cli {
namespace {

const char* const directions[] = {"x", "y", "z", "rx", "ry", "rz"};

Json to_json(const reduction::ReducedBody& body) {
  const reduction::EffectiveMass table = reduction::effective_mass(body);
  const reduction::Certificate& certificate = body.certificate;
  Json object{{"body", body.name},
              {"parent_port", body.parent >= 0 ? body.ports[static_cast<std::size_t>(body.parent)].name : ""},
              {"ports", Json::array()},
              {"mass_kg", body.D(0, 0)},
              {"frequencies_hz", Json::array()},
              {"damping_ratios", Json::array()}};
  for (const reduction::BodyPort& port : body.ports) object["ports"].push_back(port.name);
  for (Eigen::Index k = 0; k < body.omega.size(); ++k) {
    object["frequencies_hz"].push_back(hertz(body.omega[k]));
    object["damping_ratios"].push_back(body.zeta[k]);
  }
  Json effective = Json::object();
  for (int d = 0; d < 6; ++d) {
    const std::string key = std::string(directions[d]) + (d < 3 ? "_kg" : "_kg_m2");
    Json& column = effective[key];
    for (Eigen::Index k = 0; k < table.per_mode.rows(); ++k) column["per_mode"].push_back(table.per_mode(k, d));
    column["total"] = table.total[d];
    column["remainder"] = table.remainder[d];
  }
  object["effective_mass"] = effective;
  object["certificate"] = {{"basis", certificate.basis},
                           {"source", certificate.source},
                           {"source_hash", certificate.source_hash},
                           {"nodes", certificate.nodes},
                           {"elements", certificate.elements},
                           {"dofs", certificate.dofs},
                           {"modes_found", certificate.modes_found},
                           {"modes_counted", certificate.modes_counted},
                           {"max_residual", certificate.max_residual},
                           {"max_orthogonality", certificate.max_orthogonality},
                           {"valid_below_hz", hertz(certificate.valid_below)},
                           {"left_out", certificate.left_out}};
  object["large_motion"] = {{"shape_integrals", body.shape_integrals != nullptr},
                            {"geometric_stiffness", body.stiffening != nullptr}};
  return object;
}

void print_certificate(const reduction::Certificate& c) {
  print(wrapped(fmt::format("basis: {}", c.basis)));
  if (c.dofs > 0)
    print(
        fmt::format("  from {}: {} nodes, {} elements, {} degrees of freedom", c.source, c.nodes, c.elements, c.dofs));
  if (c.modes_counted >= 0)
    print(fmt::format("  eigenpairs kept {}, counted by inertia below {:.6g} Hz: {}", c.modes_found,
                      hertz(std::sqrt(std::max(c.count_shift, 0.0))), c.modes_counted));
  if (c.modes_found > 0)
    print(fmt::format("  residuals at most {:.1e}, |ΦᵀMΦ - 1| at most {:.1e}", c.max_residual, c.max_orthogonality));
  if (c.valid_below > 0.0) print(fmt::format("  valid below {:.6g} Hz", hertz(c.valid_below)));
  for (const std::string& sentence : c.left_out) print(wrapped("left out: " + sentence));
}

void print_people(const reduction::ReducedBody& body) {
  std::vector<std::string> ports;
  for (const reduction::BodyPort& port : body.ports) ports.push_back(port.name);
  print(
      fmt::format("{}: {} modes, ports {}, mass {:.6g} kg", body.name, body.n(), fmt::join(ports, ", "), body.D(0, 0)));
  print_certificate(body.certificate);
  if (body.n() == 0) return;
  const reduction::EffectiveMass effective = reduction::effective_mass(body);
  print("\n  Effective mass at the parent port, % of the body's own, by direction:");
  Table table({"mode", "[Hz]", "x", "y", "z", "rx", "ry", "rz"});
  const auto percent = [&](double part, int d) {
    return body.D(d, d) > 0.0 ? fmt::format("{:.3f}", 100.0 * part / body.D(d, d)) : std::string("-");
  };
  for (Eigen::Index k = 0; k < effective.per_mode.rows(); ++k) {
    std::vector<std::string> row{std::to_string(k + 1), fmt::format("{:.6g}", hertz(body.omega[k]))};
    for (int d = 0; d < 6; ++d) row.push_back(percent(effective.per_mode(k, d), d));
    table.row(std::move(row));
  }
  std::vector<std::string> total{"sum", ""}, missing{"missing", ""};
  for (int d = 0; d < 6; ++d) {
    total.push_back(percent(effective.total[d], d));
    missing.push_back(percent(effective.remainder[d], d));
  }
  table.row(std::move(total));
  table.row(std::move(missing));
  print(table);
}

}  // namespace

int run(const ReduceOptions& options) {
  const assembly::Scene scene = assembly::read_scene(options.scene);
  const assembly::SceneBody& body = assembly::body_named(scene, options.body);
  assembly::BodyPlan plan = assembly::plan(scene).bodies[static_cast<std::size_t>(&body - scene.bodies.data())];
  plan.options.nonlinear = !options.linear;
  reduction::ReducedBody reduced;
  {
    ProgressBar bar;
    reduced = assembly::build_body(body, plan, bar.callback());
  }
  if (!options.output.empty()) reduction::write_body(options.output, reduced);
  if (options.json) {
    print(to_json(reduced));
    return done;
  }
  print_people(reduced);
  if (!options.output.empty()) print(fmt::format("\nWritten: {}", options.output.string()));
  return done;
}

}  // namespace tenon::cli
