#include "fem/elements/section_line.hpp"

#include <cmath>

namespace tenon::fem {
namespace {

double linear(double a, double b, double t) { return (1.0 - t) * a + t * b; }

/// Such that the n-th root is linear.
double of_root(int n, double a, double b, double t) {
  return a == b ? a : std::pow(linear(std::pow(a, 1.0 / n), std::pow(b, 1.0 / n), t), n);
}

/// Iyz / √(Iy Iz), in −1..1.
double coupling(const BeamSection& s) { return s.Iyz == 0.0 ? 0.0 : s.Iyz / std::sqrt(s.Iy * s.Iz); }

}  // namespace

void between(const BeamSection& a, const BeamSection& b, double t, BeamSection& out) {
  out.A = of_root(2, a.A, b.A, t);
  out.Iy = of_root(4, a.Iy, b.Iy, t);
  out.Iz = of_root(4, a.Iz, b.Iz, t);
  out.J = of_root(4, a.J, b.J, t);
  out.Iyz = linear(coupling(a), coupling(b), t) * std::sqrt(out.Iy * out.Iz);
  out.kappa_y = linear(a.kappa_y, b.kappa_y, t);
  out.kappa_z = linear(a.kappa_z, b.kappa_z, t);
  out.shear_y = linear(a.shear_y, b.shear_y, t);
  out.shear_z = linear(a.shear_z, b.shear_z, t);
  out.nsm = linear(a.nsm, b.nsm, t);
  out.nsm_y = linear(a.nsm_y, b.nsm_y, t);
  out.nsm_z = linear(a.nsm_z, b.nsm_z, t);
}

SectionLine::SectionLine(const Model& model, const Beam& beam) : model_(&model), section_(beam.section) {
  if (beam.taper >= 0) stations_ = model.tapers[static_cast<std::size_t>(beam.taper)];
}

double SectionLine::begin(std::size_t piece) const {
  if (uniform()) return piece == 0 ? 0.0 : 1.0;
  return stations_[piece].at;
}

const BeamSection& SectionLine::section(std::size_t station) const {
  return model_->beam_sections[static_cast<std::size_t>(uniform() ? section_ : stations_[station].section)];
}

void SectionLine::at(std::size_t piece, double fraction, BeamSection& out) const {
  const BeamSection &a = section(piece), &b = section(uniform() ? 0 : piece + 1);
  const double from = begin(piece), t = (fraction - from) / (begin(piece + 1) - from);
  between(a, b, t, out);
}

}  // namespace tenon::fem
