#include "fem/formats/file_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <utility>
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

void require_regular(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail_missing(path);
  if (status.type() == fs::file_type::directory)
    throw InputError({path.string()}, "this is a folder", "Name a file in it");
  if (status.type() != fs::file_type::regular)
    throw InputError({path.string()}, "this is not a regular file that can be read", "Name a file on disk");
}

[[noreturn]] void fail_unreadable(const fs::path& path) {
  throw InputError({path.string()}, "cannot be read", "Check that you may read it and that its disk is in order");
}

}  // namespace

std::string read_bytes(const fs::path& path) {
  require_regular(path);
  std::ifstream stream(path, std::ios::binary);
  std::string bytes;
  if (stream) {
    bytes.resize(fs::file_size(path));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream) fail_unreadable(path);
  return bytes;
}

MappedFile::MappedFile(const fs::path& path) {
  require_regular(path);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail_unreadable(path);
  struct stat status {};
  const bool known = ::fstat(file, &status) == 0;
  void* pages = nullptr;
  if (known && status.st_size > 0)
    pages = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, file, 0);
  ::close(file);
  if (!known || pages == MAP_FAILED) fail_unreadable(path);
  if (!pages) return;
  begin_ = static_cast<const char*>(pages);
  size_ = static_cast<std::size_t>(status.st_size);
  ::madvise(pages, size_, MADV_SEQUENTIAL);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : begin_(std::exchange(other.begin_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile::~MappedFile() {
  if (begin_) ::munmap(const_cast<char*>(begin_), size_);
}

void MappedFile::release(std::size_t end) const {
  const std::size_t whole = end & ~(static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) - 1);
  if (whole > 0) ::madvise(const_cast<char*>(begin_), whole, MADV_DONTNEED);
}

}  // namespace tenon::fem
