#include "fem/formats/gmsh.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tenon::fuzz::read_or_refuse(size,
                                     [&] { tenon::fem::parse_gmsh(tenon::fuzz::text_of(data, size), "case.msh"); });
}
