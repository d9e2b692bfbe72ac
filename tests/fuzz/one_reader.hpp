#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "fem/error.hpp"
#include "tests/fuzz/allocation_bound.hpp"

/// What the libFuzzer targets of the readers share.
namespace tenon::fuzz {

/// Calls a reader of a case of so many bytes: it may read or refuse (an Error of the project); whatever else escapes,
/// and memory beyond AllocationBound, ends the run as a fault.
template <class Reader>
int read_or_refuse(std::size_t size, Reader&& reader, int times = 100) {
  const AllocationBound bound(size, times);
  try {
    reader();
  } catch (const Error&) {
  }
  return 0;
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process, removed when it ends; under TMPDIR, which ./dev fuzz puts into memory and clears.
inline const std::filesystem::path& folder() {
  static const struct Own {
    std::filesystem::path path = std::filesystem::temp_directory_path() / fmt::format("tenon-fuzz-{}", ::getpid());
    Own() { std::filesystem::create_directories(path); }
    ~Own() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  } own;
  return own.path;
}

/// The text as a file of the folder, for readers that take a path.
inline std::filesystem::path write(std::string_view name, std::string_view text) {
  std::filesystem::path path = folder() / name;
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  return path;
}

/// The text with strokes in place of slashes: no name in it leads out of the folder.
inline std::string without_slashes(std::string_view text) {
  std::string inside(text);
  std::ranges::replace(inside, '/', '|');
  return inside;
}

/// The files of a case that holds several, parted by lines "@@@@".
inline std::vector<std::string_view> files_of(std::string_view text) {
  constexpr std::string_view mark = "@@@@\n";
  std::vector<std::string_view> files;
  for (;;) {
    const std::size_t end = text.find(mark);
    files.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return files;
    text.remove_prefix(end + mark.size());
  }
}

}  // namespace tenon::fuzz
