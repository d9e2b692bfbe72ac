#include "fem/formats/matrices/matrix_market.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = tenon::fuzz::write("case.mtx", tenon::fuzz::text_of(data, size));
  return tenon::fuzz::read_or_refuse(size, [&] {
    tenon::fem::read_matrix_market(file, {{1, 0}, {1, 1}, {2, 5}});
  });  // labels of a matrix of size 3
}
