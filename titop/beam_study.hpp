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

/// The eleven cases of the paper: table 1 (clamped-free, free-clamped) and tables 3 to 11.
std::vector<Ends> paper_cases();

}  // namespace tenon::titop
