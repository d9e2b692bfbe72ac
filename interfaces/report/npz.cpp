#include "interfaces/report/npz.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <bit>
#include <cstring>
#include <memory>

#include "fem/error.hpp"

namespace tenon::report {
namespace {

static_assert(std::endian::native == std::endian::little, "'<f8' below says little-endian");

// NPY format 1.0: magic, version, length of the header, a Python dict padded to 64 bytes, the numbers.
std::vector<char> npy(const std::vector<double>& values) {
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", values.size());
  constexpr std::size_t prefix = 10;
  header.append(63 - (prefix + header.size()) % 64, ' ');
  header.push_back('\n');
  std::vector<char> bytes(prefix + header.size() + values.size() * sizeof(double));
  std::memcpy(bytes.data(), "\x93NUMPY\x01\x00", 8);
  bytes[8] = static_cast<char>(header.size() & 0xFF);
  bytes[9] = static_cast<char>(header.size() >> 8);
  std::memcpy(bytes.data() + prefix, header.data(), header.size());
  if (!values.empty())
    std::memcpy(bytes.data() + prefix + header.size(), values.data(), values.size() * sizeof(double));
  return bytes;
}

}  // namespace

void write_npz(const std::filesystem::path& path, const std::vector<NamedArray>& arrays) {
  const auto refuse = [&](const char* why) {
    throw InputError({path.string()}, fmt::format("cannot be written: {}", why), "Check the folder and its rights");
  };
  int fault = 0;
  std::unique_ptr<zip_t, decltype(&zip_discard)> opened(zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &fault),
                                                        &zip_discard);
  if (!opened) refuse("no zip archive can be made there");
  zip_t* archive = opened.get();
  std::vector<std::vector<char>> kept;  // libzip reads them when it closes
  kept.reserve(arrays.size());
  for (const NamedArray& array : arrays) {
    kept.push_back(npy(array.values));
    zip_source_t* source = zip_source_buffer(archive, kept.back().data(), kept.back().size(), 0);
    if (!source || zip_file_add(archive, (array.name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8) < 0) {
      zip_source_free(source);
      refuse(zip_strerror(archive));
    }
  }
  if (zip_close(archive) != 0) refuse(zip_strerror(archive));
  opened.release();  // closing has freed it
}

}  // namespace tenon::report
