#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fem/elements/beam_frame.hpp"
#include "fem/elements/section_line.hpp"
#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem::nastran {
namespace {

/// Copies of materials and sections without mass, made when first needed.
template <class T>
class Massless {
 public:
  Massless(std::vector<T>& all, double T::*mass) : all_(all), mass_(mass), copy_(all.size(), -1) {}

  int of(int index) {
    if (has_no_mass(all_[static_cast<std::size_t>(index)])) return index;
    int& copy = copy_[static_cast<std::size_t>(index)];
    if (copy < 0) {
      copy = static_cast<int>(all_.size());
      T light = all_[static_cast<std::size_t>(index)];
      light.name += ", mass lumped";
      light.*mass_ = 0.0;
      if constexpr (std::is_same_v<T, ShellSection>)
        for (Ply& ply : light.plies) ply.rho = 0.0;
      all_.push_back(std::move(light));
    }
    return copy;
  }

 private:
  bool has_no_mass(const T& value) const {
    if constexpr (std::is_same_v<T, ShellSection>)
      for (const Ply& ply : value.plies)
        if (ply.rho != 0.0) return false;
    return value.*mass_ == 0.0;
  }

  std::vector<T>& all_;
  double T::*mass_;
  std::vector<int> copy_;
};

/// ∫ N_i dA over a bilinear quadrilateral, 2×2 Gauss points.
std::array<double, 4> nodal_areas(const std::array<Vec3, 4>& x) {
  std::array<double, 4> areas{};
  const double g = 1.0 / std::sqrt(3.0);
  for (const double r : {-g, g})
    for (const double s : {-g, g}) {
      const std::array<double, 4> N{0.25 * (1 - r) * (1 - s), 0.25 * (1 + r) * (1 - s), 0.25 * (1 + r) * (1 + s),
                                    0.25 * (1 - r) * (1 + s)};
      const Vec3 x_r = 0.25 * ((1 - s) * (x[1] - x[0]) + (1 + s) * (x[2] - x[3]));
      const Vec3 x_s = 0.25 * ((1 - r) * (x[3] - x[0]) + (1 + r) * (x[2] - x[1]));
      const double dA = x_r.cross(x_s).norm();
      for (std::size_t i = 0; i < 4; ++i) areas[i] += N[i] * dA;
    }
  return areas;
}

std::array<double, 3> nodal_areas(const std::array<Vec3, 3>& x) {
  const double third = (x[1] - x[0]).cross(x[2] - x[0]).norm() / 6.0;
  return {third, third, third};
}

/// Points and weights on 0..1, exact to degree 5.
constexpr std::array<std::pair<double, double>, 3> gauss_3{
    {{0.1127016653792583, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.8872983346207417, 5.0 / 18.0}}};

struct Lumper {
  Model& model;
  Massless<Material> materials{model.materials, &Material::rho};
  Massless<BeamSection> beam_sections{model.beam_sections, &BeamSection::nsm};
  Massless<ShellSection> shell_sections{model.shell_sections, &ShellSection::nsm};
  std::vector<Element> masses;                                                  ///< off their nodes
  std::vector<double> at_nodes = std::vector<double>(model.nodes.size(), 0.0);  ///< of all elements together [kg]

  const Vec3& at(int node) const { return model.nodes[static_cast<std::size_t>(node)]; }
  void put(int node, double mass, const Vec3& offset, long id) {
    if (offset == Vec3::Zero())
      at_nodes[static_cast<std::size_t>(node)] += mass;
    else if (mass != 0.0)
      masses.emplace_back(PointMass{node, mass, Mat3::Zero(), offset, id});
  }

  void operator()(Beam& beam);
  template <class Shell>
  void lump_shell(Shell& shell) {
    const auto& section = model.shell_sections[static_cast<std::size_t>(shell.section)];
    const double rho = model.materials[static_cast<std::size_t>(shell.material)].rho;
    std::array<Vec3, std::tuple_size_v<decltype(shell.nodes)>> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = at(shell.nodes[i]);
    const auto areas = nodal_areas(corners);
    double per_area = section.plies.empty() ? rho * section.thickness : 0.0;
    for (const Ply& ply : section.plies) per_area += ply.rho * ply.thickness;
    const Vec3 to_middle = shell.offset * (corners[2] - corners[0]).cross(corners.back() - corners[1]).normalized();
    for (std::size_t i = 0; i < corners.size(); ++i)
      put(shell.nodes[i], (per_area + section.nsm) * areas[i], to_middle, shell.id);
    shell.section = shell_sections.of(shell.section);
    shell.material = materials.of(shell.material);
  }
  void operator()(Quad4& quad) { lump_shell(quad); }
  void operator()(Tria3& triangle) { lump_shell(triangle); }
  void operator()(PointMass&) {}
  void operator()(Spring&) {}
  void operator()(Bush&) {}
  void operator()(Rod& rod) {
    const auto& section = model.beam_sections[static_cast<std::size_t>(rod.section)];
    const double rho = model.materials[static_cast<std::size_t>(rod.material)].rho;
    const double half = 0.5 * (rho * section.A + section.nsm) * (at(rod.nodes[1]) - at(rod.nodes[0])).norm();
    for (const int node : rod.nodes) put(node, half, Vec3::Zero(), rod.id);
    rod.section = beam_sections.of(rod.section);
    rod.material = materials.of(rod.material);
  }
};

/// Half of the mass to each end, at the centroid and at the centre of the non-structural mass; of a section that
/// varies, what keeps mass and first moment.
void Lumper::operator()(Beam& beam) {
  const double rho = model.materials[static_cast<std::size_t>(beam.material)].rho;
  const SectionLine line(model, beam);
  if (line.plain()) {
    const BeamSection& s = line.section(0);
    const double length = (at(beam.nodes[1]) + beam.offsets[1] - at(beam.nodes[0]) - beam.offsets[0]).norm();
    for (std::size_t i = 0; i < 2; ++i)
      put(beam.nodes[i], 0.5 * (rho * s.A + s.nsm) * length, beam.offsets[i], beam.id);
  } else {
    const BeamFrame frame(beam, model.nodes);
    BeamSection s;
    std::array<double, 2> structural{};
    std::array<Vec3, 2> moment{Vec3::Zero(), Vec3::Zero()};
    std::array<double, 2> other{};
    for (std::size_t piece = 0; piece < line.pieces(); ++piece) {
      const double from = line.begin(piece), length = line.begin(piece + 1) - from;
      for (const auto& [x, w] : gauss_3) {  // exact for √A linear and centres linear with their mass
        const double t = from + length * x;
        line.at(piece, t, s);
        for (std::size_t i = 0; i < 2; ++i) {
          const double share = w * length * frame.h * (i == 0 ? 1.0 - t : t);
          structural[i] += share * rho * s.A;
          other[i] += share * s.nsm;
          moment[i] += share * s.nsm * Vec3(0.0, s.nsm_y, s.nsm_z);
        }
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      put(beam.nodes[i], structural[i], beam.offsets[i], beam.id);
      if (other[i] > 0.0) put(beam.nodes[i], other[i], beam.offsets[i] + frame.R * moment[i] / other[i], beam.id);
    }
  }
  beam.section = beam_sections.of(beam.section);
  beam.material = materials.of(beam.material);
}

}  // namespace

void lump_masses(Draft& draft) {
  if (draft.deck.coupled_mass) return;
  Lumper lumper{.model = draft.deck.model, .masses = {}};
  auto& elements = draft.deck.model.elements;
  for (Element& element : elements) std::visit(lumper, element);
  for (auto& stations : draft.deck.model.tapers)
    for (Station& station : stations) station.section = lumper.beam_sections.of(station.section);
  elements.reserve(elements.size() + lumper.masses.size() +
                   static_cast<std::size_t>(std::ranges::count_if(lumper.at_nodes, [](double m) { return m != 0.0; })));
  elements.insert(elements.end(), lumper.masses.begin(), lumper.masses.end());
  for (std::size_t n = 0; n < lumper.at_nodes.size(); ++n)
    if (lumper.at_nodes[n] != 0.0)
      elements.emplace_back(
          PointMass{static_cast<int>(n), lumper.at_nodes[n], Mat3::Zero(), Vec3::Zero(), draft.deck.model.node_ids[n]});
}

}  // namespace tenon::fem::nastran
