#include "assembly/scene/simulation.hpp"
#include "tests/fuzz/one_reader.hpp"

// The linear commands and `tenon simulate` read the same file; a scene opens no mesh, but looks into .inp files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = tenon::fuzz::write("case.yaml", tenon::fuzz::without_slashes(tenon::fuzz::text_of(data, size)));
  tenon::fuzz::read_or_refuse(size, [&] { tenon::assembly::read_scene(file); });
  return tenon::fuzz::read_or_refuse(
      size, [&] { tenon::assembly::read_simulation(tenon::assembly::read_moving_scene(file)); });
}
