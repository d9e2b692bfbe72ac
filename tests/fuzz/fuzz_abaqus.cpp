#include "fem/formats/abaqus.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = tenon::fuzz::file_of(data, size, "inp");
  return tenon::fuzz::read_or_refuse([&] { tenon::fem::read_abaqus(file, {.allow_losses = true}); });
}
