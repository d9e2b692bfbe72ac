#include "fem/formats/read_xdmf.hpp"
#include "tests/fuzz/one_reader.hpp"

// Two files: the mesh, and numbers that it may name as case.bin. fuzz_hdf5 has those of HDF5.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = tenon::fuzz::files_of(tenon::fuzz::text_of(data, size));
  if (files.size() > 1) tenon::fuzz::write("case.bin", files[1]);
  return tenon::fuzz::read_or_refuse(size,
                                     [&] { tenon::fem::parse_xdmf(files[0], "case.xdmf", tenon::fuzz::folder()); });
}
