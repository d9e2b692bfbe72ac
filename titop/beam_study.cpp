#include "titop/beam_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/error.hpp"
#include "fem/structure.hpp"
#include "reduction/reduce.hpp"
#include "titop/beam.hpp"
#include "titop/beam_roots.hpp"
#include "titop/constrain.hpp"

namespace tenon::titop {

namespace {

using Kind = BeamBasis::Kind;

// EI = ρS = l = 1 in the x-y plane. So slender, and so stiff across, that the lowest modes are all of bending in the
// plane: r/l = 2e-4 leaves traction and torsion above the 40th of them.
constexpr double radius = 2e-4;
constexpr int most_modes = 32;

BeamProperties unit_beam() {
  const double I = radius * radius;  // of S = 1
  return {.length = 1.0, .E = 1.0 / I, .G = 0.4 / I, .rho = 1.0, .A = 1.0, .Iy = I, .Iz = I, .J = 2 * I, .Ip = 2 * I};
}

fem::Structure element_beam(int elements) {
  const BeamProperties b = unit_beam();
  fem::Model model;
  model.source = "unit beam";
  for (int k = 0; k <= elements; ++k) {
    model.nodes.emplace_back(static_cast<double>(k) / elements, 0.0, 0.0);
    model.node_ids.push_back(k + 1);
  }
  model.materials = {{.name = "unit", .E = b.E, .G = b.G, .nu = 0.25, .rho = b.rho}};
  model.beam_sections = {{.name = "unit", .A = b.A, .Iy = 1e6 * b.Iy, .Iz = b.Iz, .J = 1e6 * b.J}};
  for (int k = 0; k < elements; ++k)
    model.elements.push_back(fem::Beam{.nodes = {k, k + 1},
                                       .orientation = fem::Vec3::UnitY(),
                                       .mass = fem::BeamMass::consistent,
                                       .rotary_inertia = false,
                                       .id = k + 1});
  model.ports = {{"P", 0, fem::Mat3::Identity()}, {"C", elements, fem::Mat3::Identity()}};
  return fem::assemble(model);
}

reduction::ReducedBody body_of(const BeamBasis& basis) {
  if (basis.kind == Kind::polynomial || basis.kind == Kind::clamped_free)
    return beam_body("beam", unit_beam(),
                     {.model = basis.kind == Kind::polynomial ? BeamModel::polynomial : BeamModel::clamped_free,
                      .modes = basis.modes,
                      .bend_xz = false,
                      .traction = false,
                      .torsion = false,
                      .samples = 0});
  if (basis.modes > most_modes || basis.modes < 0)
    throw ModelError("the comparison of beams takes at most 32 modes of a beam", "Ask for fewer");
  return reduction::reduce(element_beam(basis.elements), "P",
                           {.basis = basis.kind == Kind::craig_bampton ? reduction::Basis::craig_bampton
                                                                       : reduction::Basis::craig_bampton_inertia_relief,
                            .modes = basis.modes,
                            .keep_shapes = false});
}

}  // namespace

std::string name(End end) {
  switch (end) {
    case End::clamped:
      return "clamped";
    case End::free:
      return "free";
    case End::pinned:
      return "pinned";
    default:
      return "sliding";
  }
}

std::string short_name(Ends e) {
  std::string text = name(e.P).substr(0, 1) + name(e.C).substr(0, 1);
  for (char& c : text) c = static_cast<char>(c - 'a' + 'A');
  return text;
}

std::vector<std::optional<Eigen::VectorXd>> beam_frequencies(const BeamBasis& basis, const std::vector<Ends>& ends,
                                                             int count) {
  const reduction::ReducedBody body = body_of(basis);
  std::vector<std::optional<Eigen::VectorXd>> all;
  for (const Ends& e : ends) {
    try {  // all four directions but those of bending in the plane are held
      Boundary held = boundary(body, {e.P, e.C}, Scope::bending);
      for (const int d : {0, 2, 3, 4})
        for (PortCondition& port : held.ports) port.fixed[static_cast<std::size_t>(d)] = true;
      const Eigen::VectorXd omega = constrained_modes(body, held).omega;
      all.emplace_back(omega.head(std::min<Eigen::Index>(count, omega.size())));
    } catch (const NumericalError&) {
      all.emplace_back(std::nullopt);
    }
  }
  return all;
}

double bending_unit(double E, double I, double rho, double S, double length) {
  return std::sqrt(E * I / (rho * S)) / (length * length);
}

double exact_frequency(const Ends& ends, int mode) {
  const double root = beam_roots(ends.P, ends.C, mode).back();
  return root * root;
}

double frequency_error(double omega, const Ends& ends, int mode) { return omega / exact_frequency(ends, mode) - 1.0; }

BeamStudy beam_study(const std::vector<Ends>& cases, int modes, int elements) {
  constexpr int lowest = 2;
  BeamStudy study;
  for (const Ends& ends : cases)
    for (int mode = 1; mode <= lowest; ++mode) study.entries.push_back({ends, mode, exact_frequency(ends, mode), {}});
  const std::vector<std::pair<std::string, BeamBasis>> bases{
      {"G_pol", {Kind::polynomial}},
      {fmt::format("CB 2+{}", modes), {Kind::craig_bampton, modes, elements}},
      {fmt::format("CB+IR 4+{}", modes), {Kind::craig_bampton_inertia_relief, modes, elements}}};
  for (const auto& [name, basis] : bases) {
    study.bases.push_back(name);
    const auto omega = beam_frequencies(basis, cases, lowest);
    for (std::size_t k = 0; k < study.entries.size(); ++k) {
      const auto& found = omega[k / lowest];
      const Eigen::Index mode = study.entries[k].mode - 1;
      study.entries[k].omega.push_back(found && mode < found->size() ? std::optional((*found)[mode]) : std::nullopt);
    }
  }
  return study;
}

std::vector<InverseOfClampedFree> inverse_of_clamped_free() {
  std::vector<InverseOfClampedFree> all;
  for (const int n : {4, 8, 16, 64})
    all.push_back({n, beam_frequencies({Kind::clamped_free, n}, {{End::free, End::clamped}}, 2)[0].value()});
  return all;
}

namespace {

void add_errors(const Ends& ends, const BeamBasis& basis, double number, BeamConvergence& c) {
  const auto omega = beam_frequencies(basis, {ends}, 3)[0];
  if (!omega) return;
  c.number.push_back(number);
  for (int m = 0; m < 3; ++m)
    c.error[static_cast<std::size_t>(m)].push_back(m < omega->size()
                                                       ? std::abs(frequency_error((*omega)[m], ends, m + 1))
                                                       : std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

BeamConvergence convergence_with_elements(const Ends& ends, int most) {
  BeamConvergence c{"elements", {}, {{}, {}, {}}};
  for (int n = 2; n <= 2 * std::max(most, 4) && n <= 512; n *= 2)
    add_errors(ends, {Kind::craig_bampton_inertia_relief, std::min(2 * n - 2, 16), n}, n, c);
  return c;
}

BeamConvergence convergence_with_modes(const Ends& ends, int most) {
  BeamConvergence c{"kept modes", {}, {{}, {}, {}}};
  for (int n = 1; n <= std::max(most, 2) + 6; ++n) add_errors(ends, {Kind::craig_bampton_inertia_relief, n, 128}, n, c);
  return c;
}

std::vector<Ends> paper_cases() {
  using enum End;
  return {{clamped, free},    {free, clamped},   {free, free},      {clamped, clamped},
          {pinned, free},     {pinned, clamped}, {pinned, pinned},  {sliding, free},
          {sliding, clamped}, {sliding, pinned}, {sliding, sliding}};
}

}  // namespace tenon::titop
