#pragma once

#include <span>

#include "fem/model.hpp"

namespace tenon::fem {

/// Constants at a fraction t of the way between two sections; the name stays as it is. √A, ⁴√I, ⁴√J vary linearly, as
/// in a bar whose sizes all grow in proportion (Iyz as √(Iy Iz), κ, nsm and centres linearly); other tapers are met by
/// more stations or elements, with an error O(h²) of the change in one.
void between(const BeamSection& a, const BeamSection& b, double t, BeamSection& out);

/// The sections along a beam.
class SectionLine {
 public:
  SectionLine(const Model& model, const Beam& beam);

  /// One section, with the shear centre and all mass at its centroid.
  bool plain() const { return stations_.empty() && centred(section(0)); }
  /// One section throughout.
  bool uniform() const { return stations_.empty(); }
  /// Of pieces between neighbouring stations.
  std::size_t pieces() const { return uniform() ? 1 : stations_.size() - 1; }
  /// Where a piece begins; that of index pieces() is the beam's end: fractions of its length.
  double begin(std::size_t piece) const;
  /// The station's section; station 0 of a uniform beam is its only one.
  const BeamSection& section(std::size_t station) const;
  /// Constants at a fraction of the length within a piece; the name stays as it is.
  void at(std::size_t piece, double fraction, BeamSection& out) const;

 private:
  static bool centred(const BeamSection& s) {
    return s.shear_y == 0.0 && s.shear_z == 0.0 && s.nsm_y == 0.0 && s.nsm_z == 0.0;
  }

  const Model* model_;
  int section_;
  std::span<const Station> stations_;
};

}  // namespace tenon::fem
