#include "fem/formats/read_vtk.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = tenon::fuzz::write("case.vtk", tenon::fuzz::text_of(data, size));
  return tenon::fuzz::read_or_refuse(size, [&] { tenon::fem::read_vtk(file); });
}
