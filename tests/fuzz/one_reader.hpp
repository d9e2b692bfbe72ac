#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "fem/error.hpp"

/// What the libFuzzer targets of the readers share.
namespace tenon::fuzz {

/// Calls a reader: it may read or refuse (an Error of the project); whatever else escapes ends the run as a fault.
template <class Reader>
int read_or_refuse(Reader&& reader) {
  try {
    reader();
  } catch (const Error&) {
  }
  return 0;
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The bytes as a file in memory (/dev/shm), for readers that take a path; each process has its own.
inline std::filesystem::path file_of(const std::uint8_t* data, std::size_t size, std::string_view ending) {
  const std::filesystem::path path = fmt::format("/dev/shm/tenon-fuzz-{}.{}", getpid(), ending);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text_of(data, size);
  return path;
}

}  // namespace tenon::fuzz
