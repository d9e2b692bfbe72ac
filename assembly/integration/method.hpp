#pragma once

#include <array>
#include <string>
#include <string_view>

/// The integrators and their names, as scenes, the command line and results write them.
namespace tenon::assembly {

enum class Method {
  generalized_alpha,  ///< fixed steps; stiff modes that a step does not resolve are damped
  midpoint,           ///< fixed steps; undamped: long runs of what conserves
  dormand_prince,     ///< adaptive, explicit, order 5: rigid or soft systems to any tolerance
  bdf,                ///< SUNDIALS CVODE, orders 1 to 5, stiff: the reference
  adams,              ///< SUNDIALS CVODE, orders 1 to 12, not stiff: the reference
};

/// In the order of the enumeration.
inline constexpr std::array<std::string_view, 5> method_names{"generalized-alpha", "midpoint", "dormand-prince", "bdf",
                                                              "adams"};
/// The same in a sentence.
inline constexpr std::string_view method_choice = "generalized-alpha, midpoint, dormand-prince, bdf or adams";

std::string name(Method method);
/// Throws InputError with the choice.
Method method_named(const std::string& word);
/// Takes steps of one size.
bool fixed_steps(Method method);

}  // namespace tenon::assembly
