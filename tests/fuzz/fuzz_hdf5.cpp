#include <pthread.h>
#include <sanitizer/common_interface_defs.h>

#include "fem/formats/read_med.hpp"
#include "fem/formats/read_xdmf.hpp"
#include "tests/fuzz/one_reader.hpp"

// HDF5 loses some of its own memory in damaged files.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

// A case is the bytes of an HDF5 file: of a MED file, and of one whose datasets an XDMF file names. HDF5 itself comes
// down on some, in the process of the rehearsal; that process is none of libFuzzer's.
namespace {

constexpr const char* xdmf = R"(<Xdmf Version="3.0"><Domain><Grid Name="m">
<Topology TopologyType="Quadrilateral" NumberOfElements="2"><DataItem Dimensions="2 4" NumberType="Int" Format="HDF">
case.med:/quads</DataItem></Topology><Geometry GeometryType="XYZ"><DataItem Dimensions="6 3" Format="HDF">
case.med:/points</DataItem></Geometry></Grid></Domain></Xdmf>)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  [[maybe_unused]] static const int alone =
      pthread_atfork(nullptr, nullptr, [] { __sanitizer_set_death_callback(nullptr); });
  const auto file = tenon::fuzz::write("case.med", tenon::fuzz::text_of(data, size));
  tenon::fuzz::read_or_refuse(size, [&] { tenon::fem::read_med(file); });
  return tenon::fuzz::read_or_refuse(size, [&] { tenon::fem::parse_xdmf(xdmf, "case.xdmf", tenon::fuzz::folder()); });
}
