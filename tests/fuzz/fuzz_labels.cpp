#include "fem/formats/matrices/make_model.hpp"
#include "fem/formats/matrices/matrix_market.hpp"
#include "tests/fuzz/one_reader.hpp"

// The labels, K and M; the last one stands for those that are missing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = tenon::fuzz::files_of(tenon::fuzz::text_of(data, size));
  const auto file = [&](const char* name, std::size_t i) {
    return tenon::fuzz::write(name, files[std::min(i, files.size() - 1)]);
  };
  const auto labels = file("rows.txt", 0), K = file("k.mtx", 1), M = file("m.mtx", 2);
  return tenon::fuzz::read_or_refuse(size,
                                     [&] { tenon::fem::make_model(tenon::fem::read_market_matrices(K, M, labels)); });
}
