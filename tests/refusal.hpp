#pragma once

#include <string>

#include "fem/error.hpp"

namespace tenon::tests {

/// What a piece of work says when it refuses; empty when it does not.
template <class Work>
std::string refusal(Work work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace tenon::tests
