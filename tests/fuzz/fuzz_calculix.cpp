#include "fem/formats/matrices/calculix.hpp"
#include "fem/formats/matrices/make_model.hpp"
#include "tests/fuzz/one_reader.hpp"

// The .dof, the .sti and the .mas; the last one stands for those that are missing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = tenon::fuzz::files_of(tenon::fuzz::text_of(data, size));
  const char* const names[] = {"job.dof", "job.sti", "job.mas"};
  for (std::size_t i = 0; i < 3; ++i) tenon::fuzz::write(names[i], files[std::min(i, files.size() - 1)]);
  return tenon::fuzz::read_or_refuse(size, [] {
    tenon::fem::make_model(tenon::fem::read_calculix_matrices((tenon::fuzz::folder() / "job").string()));
  });
}
