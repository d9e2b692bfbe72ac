#include "fem/elements/spring.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {

void spring_matrices(const Spring& spring, ElementMatrices& out) {
  if (!(spring.k >= 0.0))
    throw ModelError(fmt::format("spring {} has the stiffness {:g}", spring.id, spring.k),
                     "Give a stiffness of at least zero");
  const int n = spring.node_b < 0 ? 1 : 2;
  out.K.setConstant(n, n, -spring.k);
  out.K.diagonal().setConstant(spring.k);
  out.M.setZero(n, n);
}

}  // namespace tenon::fem
