#include "titop/state_space.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::titop {

void check(const StateSpace& ss) {
  const auto n = ss.A.rows(), m = ss.D.cols(), p = ss.D.rows();
  const bool fits = ss.A.cols() == n && ss.B.rows() == n && ss.B.cols() == m && ss.C.rows() == p && ss.C.cols() == n &&
                    static_cast<Eigen::Index>(ss.inputs.size()) == m &&
                    static_cast<Eigen::Index>(ss.outputs.size()) == p;
  if (!fits)
    throw ModelError(
        fmt::format("state space of order {} with {} inputs and {} outputs has matrices of other sizes", n, m, p),
        "Give A n×n, B n×m, C p×n, D p×m and a name for every channel");
}

}  // namespace tenon::titop
