#include "assembly/integration/method.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/error.hpp"

namespace tenon::assembly {

std::string name(Method method) { return std::string(method_names[static_cast<std::size_t>(method)]); }

Method method_named(const std::string& word) {
  const auto found = std::find(method_names.begin(), method_names.end(), word);
  if (found == method_names.end())
    throw InputError({"method"}, fmt::format("there is no method '{}'", word), fmt::format("Choose {}", method_choice));
  return static_cast<Method>(found - method_names.begin());
}

bool fixed_steps(Method method) { return method == Method::generalized_alpha || method == Method::midpoint; }

}  // namespace tenon::assembly
