#include "fem/formats/f06.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = tenon::fuzz::write("case.f06", tenon::fuzz::text_of(data, size));
  return tenon::fuzz::read_or_refuse(size, [&] { tenon::fem::read_f06(file); });
}
