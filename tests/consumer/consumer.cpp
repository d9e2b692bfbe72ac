// What a downstream program does first: a body, its mass properties seen from another port, and an error it can catch.
#include <cmath>
#include <cstdio>

#include "fem/error.hpp"
#include "reduction/reduced_body.hpp"

int main() {
  using namespace tenon;
  const fem::Vec3 centre(0.5, 0.0, 0.0), end(1.0, 0.0, 0.0);
  const auto body =
      reduction::rigid_body("bar", 2.0, centre, fem::Mat3::Identity(), {{.name = "root"}, {.name = "tip", .position = end}});
  // Steiner: 1 + 2 · 0.5² about the root, across the bar.
  const bool steiner = std::abs(body.D(4, 4) - 1.5) < 1e-15 && std::abs(body.D(5, 5) - 1.5) < 1e-15;
  bool caught = false;
  try {
    reduction::port_index(body, "tipp");
  } catch (const ModelError& error) {
    std::puts(error.what());
    caught = true;
  }
  return steiner && caught ? 0 : 1;
}
