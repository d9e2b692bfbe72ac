#pragma once

#include "tests/reference/values.hpp"
#include "titop/beam.hpp"
#include "titop/boundary.hpp"

/// Beams with ρA = EI = l = 1, bending in the plane x-y only.
namespace tenon::reference {

inline reduction::ReducedBody unit_beam(titop::BeamModel model, int modes = 2) {
  const titop::BeamProperties unit{.length = 1.0, .E = 1.0, .rho = 1.0, .A = 1.0, .Iz = 1.0};
  return titop::beam_body("beam", unit,
                          {.model = model, .modes = modes, .bend_xz = false, .traction = false, .torsion = false});
}

/// Ends from the letters c, f, p, s of the tables.
inline titop::End end(char letter) {
  switch (letter) {
    case 'c':
      return titop::End::clamped;
    case 'f':
      return titop::End::free;
    case 'p':
      return titop::End::pinned;
    default:
      return titop::End::sliding;
  }
}

inline titop::Boundary in_bending(const reduction::ReducedBody& body, char P, char C) {
  return titop::boundary(body, {end(P), end(C)}, titop::Scope::bending);
}

/// Roots, rigid modes of a pair of ends in either order.
inline const EndConditions& ends(char P, char C) {
  for (const EndConditions& e : euler_bernoulli_roots)
    if ((e.left == P && e.right == C) || (e.left == C && e.right == P)) return e;
  throw std::logic_error("no such pair");
}

}  // namespace tenon::reference
