#include "fem/formats/file_bytes.hpp"

#include <fmt/format.h>

#include <fstream>
#include <vector>

#include "fem/error.hpp"
#include "fem/mesh.hpp"

namespace tenon::fem {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_missing(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  std::vector<std::string> names;
  fs::directory_iterator entries(folder, error);
  if (error)
    throw InputError({path.string()}, fmt::format("there is no such file, nor a readable folder '{}'", folder.string()),
                     "Check the path; it is relative to the folder the program runs in or the scene lies in");
  for (; entries != fs::directory_iterator(); entries.increment(error)) {
    if (error) break;
    names.push_back(entries->path().filename().string());
  }
  const std::string near = near_miss(path.filename().string(), names);
  throw InputError({path.string()}, "there is no such file",
                   near.empty() ? "Check the path"
                                : fmt::format("Did you mean '{}'?",
                                              (path.has_parent_path() ? folder / near : fs::path(near)).string()));
}

}  // namespace

std::string read_bytes(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail_missing(path);
  if (status.type() == fs::file_type::directory)
    throw InputError({path.string()}, "this is a folder", "Name a file in it");
  if (status.type() != fs::file_type::regular)
    throw InputError({path.string()}, "this is not a regular file that can be read", "Name a file on disk");

  std::ifstream stream(path, std::ios::binary);
  std::string bytes;
  if (stream) {
    bytes.resize(fs::file_size(path));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream)
    throw InputError({path.string()}, "cannot be read", "Check that you may read it and that its disk is in order");
  return bytes;
}

}  // namespace tenon::fem
