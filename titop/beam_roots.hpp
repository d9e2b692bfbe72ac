#pragma once

#include <vector>

#include "titop/boundary.hpp"

namespace tenon::titop {

/// Roots βl of the characteristic equation of a uniform Euler-Bernoulli beam with the given ends, ascending, without
/// the zeros of rigid motions: ω = (βl)² √(EI / ρS l⁴). To round-off for any number of them.
std::vector<double> beam_roots(End left, End right, int count);

}  // namespace tenon::titop
