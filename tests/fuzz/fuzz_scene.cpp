#include "assembly/scene/simulation.hpp"
#include "tests/fuzz/one_reader.hpp"

// yaml-cpp's scanner holds some 200 bytes for a bracket of one line, and a value of one letter its place.
constexpr int times_the_case = 400;

// The linear commands and `tenon simulate` read the same file; a scene opens no mesh, but looks into .inp files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = tenon::fuzz::write("case.yaml", tenon::fuzz::without_slashes(tenon::fuzz::text_of(data, size)));
  tenon::fuzz::read_or_refuse(
      size, [&] { tenon::assembly::read_scene(file); }, times_the_case);
  return tenon::fuzz::read_or_refuse(
      size, [&] { tenon::assembly::read_simulation(tenon::assembly::read_moving_scene(file)); }, times_the_case);
}
