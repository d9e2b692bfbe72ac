#include "fem/formats/read_vtu.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tenon::fuzz::read_or_refuse(size,
                                     [&] { tenon::fem::parse_vtu(tenon::fuzz::text_of(data, size), "case.vtu"); });
}
