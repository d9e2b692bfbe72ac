#include "assembly/matrix_body.hpp"

#include "fem/formats/matrices/matrix_market.hpp"

namespace tenon::assembly {

fem::MatrixModel read_matrix_body(const MatrixFiles& files, const Units& units) {
  fem::MatrixModel body = fem::make_model(fem::read_market_matrices(files.K, files.M, files.labels));
  body.model = to_si(std::move(body.model), units);
  return body;
}

}  // namespace tenon::assembly
