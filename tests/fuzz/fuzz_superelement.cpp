#include "fem/formats/matrices/make_model.hpp"
#include "fem/formats/matrices/superelement.hpp"
#include "tests/fuzz/one_reader.hpp"

// The .asm, the .op4 and the .pch; a case of one file holds DMIG.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = tenon::fuzz::files_of(tenon::fuzz::text_of(data, size));
  const auto description = tenon::fuzz::write("part.asm", tenon::fuzz::without_slashes(files[0]));
  const char* const beside[] = {"part.op4", "part.pch"};
  for (std::size_t i = 0; i < 2; ++i)
    if (i + 1 < files.size())
      tenon::fuzz::write(beside[i], i == 0 ? std::string(files[1]) : tenon::fuzz::without_slashes(files[2]));
    else
      std::filesystem::remove(tenon::fuzz::folder() / beside[i]);
  return tenon::fuzz::read_or_refuse(
      size, [&] { tenon::fem::make_model(tenon::fem::read_nastran_superelement(description.string())); });
}
