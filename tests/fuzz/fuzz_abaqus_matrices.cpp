#include "fem/formats/matrices/abaqus.hpp"
#include "fem/formats/matrices/make_model.hpp"
#include "tests/fuzz/one_reader.hpp"

// K and M; one file alone is both.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = tenon::fuzz::files_of(tenon::fuzz::text_of(data, size));
  const auto K = tenon::fuzz::write("k.mtx", files.front());
  const auto M = tenon::fuzz::write("m.mtx", files[std::min<std::size_t>(1, files.size() - 1)]);
  return tenon::fuzz::read_or_refuse(size, [&] { tenon::fem::make_model(tenon::fem::read_abaqus_matrices(K, M)); });
}
