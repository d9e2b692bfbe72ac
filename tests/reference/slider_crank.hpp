#pragma once

namespace tenon::reference {

/// The slider-crank of the IVP test set (problem "crank"; B. Simeon, Arch. Mech. Eng. 43 (1996)): lengths [m], masses
/// [kg], moments of inertia about the crank's axle and about the pin that the rod hangs by [kg m²].
struct SliderCrank {
  double L1 = 0.15, L2 = 0.30;
  double M1 = 0.36, M2 = 0.151104, M3 = 0.075552;
  double J1 = 0.002727, J2 = 0.0045339259;
};

}  // namespace tenon::reference
