#include "fem/formats/nastran.hpp"
#include "tests/fuzz/one_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto included = tenon::fuzz::write("part.bdf", "GRID,90,,9.,0.,0.\n");
  const auto file = tenon::fuzz::write("case.bdf", tenon::fuzz::without_slashes(tenon::fuzz::text_of(data, size)));
  return tenon::fuzz::read_or_refuse(size, [&] {
    if (tenon::fem::nastran_gives_sections(file))
      tenon::fem::read_nastran(file, {.allow_losses = true, .spc_set = {}, .mpc_set = {}});
    else
      tenon::fem::read_nastran_mesh(file);
  });
}
