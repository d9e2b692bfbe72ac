#pragma once

#include <array>
#include <string>

/// How far the first modes of a beam in one plane are off when it is reduced to a few shapes, in percent of the
/// frequency of the closed form, printed with the digits known. Independent Rayleigh-Ritz computations with polynomials
/// and with the closed-form modes of the uniform beam; the column P5 is Table 1 of the TITOP paper.
namespace tenon::reference {

/// "mode 1/mode 2": a printed figure and half a unit of its last digit.
struct Printed {
  double value = 0.0, half_unit = 0.0;
};
inline Printed printed(const std::string& text) {
  const auto point = text.find('.');
  double half = 0.5;
  for (std::size_t k = point; point != std::string::npos && k + 1 < text.size(); ++k) half /= 10.0;
  return {std::stod(text), half};
}

/// End conditions, first letter at P: C clamped, F free, P pinned, S sliding. Four shapes beside the rigid motions: the
/// paper's polynomials; two static shapes and two clamped-clamped modes; four clamped-free modes; two clamped-free
/// modes and two static responses of the tip; two free-free modes and two static responses of the free beam.
struct UniformBeamErrors {
  const char* ends;
  std::array<const char*, 2> P5, craig_bampton, clamped_free, clamped_free_static, free_free_static;
};
inline constexpr std::array<UniformBeamErrors, 11> uniform_beam_errors{{
    {"CF", {".00015", ".560"}, {".0058", ".109"}, {"0.0", "0.0"}, {"0.0", "0.0"}, {".032", ".363"}},
    {"FC", {".00015", ".560"}, {".0058", ".109"}, {"24.8", "27.2"}, {".018", ".216"}, {".032", ".363"}},
    {"FF", {".853", "3.02"}, {".360", ".439"}, {".038", ".157"}, {".277", "6.86"}, {"0.0", "0.0"}},
    {"CC", {".343", "2.04"}, {"0.0", "0.0"}, {"27.8", "32.7"}, {".004", "8.57"}, {"1.16", ".756"}},
    {"PF", {".174", "2.48"}, {".044", "1.04"}, {".001", ".043"}, {".045", "8.77"}, {".194", ".771"}},
    {"PC", {".097", "1.52"}, {".0086", ".324"}, {"27.2", "29.6"}, {".064", "7.58"}, {".665", ".751"}},
    {"PP", {".030", ".423"}, {".0075", ".068"}, {".198", ".980"}, {".010", "3.21"}, {".310", ".662"}},
    {"SF", {".0014", "1.68"}, {".0081", ".741"}, {".0018", ".071"}, {".023", "1.28"}, {".020", ".029"}},
    {"SC", {".0001", "1.11"}, {".012", ".292"}, {"25.7", "27.6"}, {".041", "1.09"}, {".090", ".476"}},
    {"SP", {".0001", ".296"}, {".0022", ".093"}, {".048", ".615"}, {".0059", ".689"}, {".020", ".339"}},
    {"SS", {".0008", "3.82"}, {".022", "1.84"}, {"13.4", "15.2"}, {".110", "1.43"}, {".065", ".092"}},
}};

/// Worst of the 16 pairs of end conditions with n shapes beside the rigid motions, modes 1 and 2.
struct WorstErrors {
  int n;
  std::array<const char*, 2> craig_bampton, clamped_free_static;
  std::array<const char*, 2> inertia_relief;  ///< P5 and n − 4 clamped-clamped modes
  std::array<const char*, 2> rubin;           ///< P5 and n − 4 free-free modes
};
inline constexpr std::array<WorstErrors, 3> uniform_beam_worst{{
    {4, {".36", "1.8"}, {".28", "8.8"}, {".85", "3.8"}, {".85", "3.8"}},
    {6, {".041", ".116"}, {".030", ".13"}, {".0016", ".0069"}, {".0007", ".014"}},
    {8, {".009", ".027"}, {".006", ".03"}, {".00008", ".0003"}, {".00002", ".0002"}},
}};

/// A tapered beam: EI ~ f³, ρA ~ f, f falls linearly from 1 at P to 0.2, a mass of 0.3 ρA(0) l at 0.7 l from P. (The
/// table names an off-centre mass only; of 90 pairs of position and mass tried in a separate Rayleigh-Ritz this one
/// alone gives all its rows.) Worst of the 16 pairs, modes 1 to 4, in percent of the unreduced frequency.
struct TaperedBeamErrors {
  int n;
  std::array<const char*, 4> craig_bampton, inertia_relief, free_free_static;
};
inline constexpr std::array<TaperedBeamErrors, 3> tapered_beam_worst{{
    {4, {".66", "2.3", "67", "120"}, {"1.2", "3.5", "93", "155"}, {"3.2", "2.6", "43", "87"}},
    {6, {".047", ".11", ".57", "3.2"}, {".0032", ".0071", "4.9", "12.7"}, {".60", ".49", "1.9", "1.6"}},
    {8, {".0095", ".020", ".15", ".39"}, {".0002", ".0005", ".012", ".021"}, {".21", ".16", ".76", ".61"}},
}};

}  // namespace tenon::reference
