#pragma once

#include <optional>
#include <string>
#include <vector>

#include "titop/boundary.hpp"

/// Bases for a bending beam against each other and against the exact frequencies: the tables of the TITOP paper, and
/// the same for other numbers of modes and elements. Uniform Euler-Bernoulli beam in one plane, ω in units of
/// √(EI/ρSl⁴).
namespace tenon::titop {

/// The ends of a beam, parent port first.
struct Ends {
  End P, C;
};
std::string name(End end);       ///< "clamped" ...
std::string short_name(Ends e);  ///< "CF" ...

/// What shapes the beam has.
struct BeamBasis {
  enum class Kind { polynomial, clamped_free, craig_bampton, craig_bampton_inertia_relief } kind;
  int modes = 2;      ///< fixed-interface modes, or clamped-free modes
  int elements = 64;  ///< of the finite-element beam
};

/// The first `count` flexible frequencies under each pair of ends; fewer where the basis has no more. Nothing where
/// the ends ask the basis for an inertia that it does not have.
std::vector<std::optional<Eigen::VectorXd>> beam_frequencies(const BeamBasis& basis, const std::vector<Ends>& ends,
                                                             int count);

/// √(EI/ρSl⁴) [rad/s].
double bending_unit(double E, double I, double rho, double S, double length);

/// Exact frequency of a mode, 1 the lowest flexible one.
double exact_frequency(const Ends& ends, int mode);

/// ω/ω_exact − 1.
double frequency_error(double omega, const Ends& ends, int mode);

/// One frequency of one case by each basis; nothing where a basis has none.
struct BeamStudyEntry {
  Ends ends;
  int mode;
  double exact;
  std::vector<std::optional<double>> omega;
};

struct BeamStudy {
  std::vector<std::string> bases;  ///< "G_pol", "CB 2+2", "CB+IR 4+2"
  std::vector<BeamStudyEntry> entries;
};

/// The two lowest modes of each case by the quintic, by Craig-Bampton and by Craig-Bampton with inertia relief, the
/// last two with `modes` fixed-interface modes of `elements` finite elements.
BeamStudy beam_study(const std::vector<Ends>& cases, int modes, int elements);

/// The two lowest frequencies of free-clamped beams of 4, 8, 16 and 64 clamped-free modes: the inverse of G_f,n in
/// table 1, where the paper's figures are misprints.
struct InverseOfClampedFree {
  int modes;
  Eigen::Vector2d omega;
};
std::vector<InverseOfClampedFree> inverse_of_clamped_free();

/// Error |ω/ω_exact − 1| of the lowest three modes as something grows; NaN where the basis has no such mode.
struct BeamConvergence {
  std::string against;                     ///< "elements" or "kept modes"
  std::vector<double> number;              ///< of them
  std::vector<std::vector<double>> error;  ///< per mode
};

/// Craig-Bampton with inertia relief: 2, 4, 8 .. elements up to 2 max(`most`, 4), 512 at most, with 2n − 2 modes of n
/// elements, 16 at most.
BeamConvergence convergence_with_elements(const Ends& ends, int most);

/// The same with 1, 2, 3 .. max(`most`, 2) + 6 modes of 128 elements.
BeamConvergence convergence_with_modes(const Ends& ends, int most);

/// The eleven cases of the paper: table 1 (clamped-free, free-clamped) and tables 3 to 11.
std::vector<Ends> paper_cases();

}  // namespace tenon::titop
