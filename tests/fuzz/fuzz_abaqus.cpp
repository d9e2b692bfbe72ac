#include "fem/formats/abaqus.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto included = tenon::fuzz::write("part.inp", "*NODE\n90, 9., 0., 0.\n");
  const auto file = tenon::fuzz::write("case.inp", tenon::fuzz::without_slashes(tenon::fuzz::text_of(data, size)));
  return tenon::fuzz::read_or_refuse(size, [&] { tenon::fem::read_abaqus(file, {.allow_losses = true}); });
}
