#include "fem/formats/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "fem/error.hpp"

namespace tenon::fem {

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(path_.string() + fmt::format(".{}.part", ::getpid())) {
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_)
    throw InputError({path_.string()}, "cannot be written", "Check that the folder exists and may be written");
}

AtomicFile::~AtomicFile() {
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) throw InputError({path_.string()}, "was not written whole", "Check the free space on its disk");
  std::filesystem::rename(temporary_, path_);
  temporary_.clear();
}

}  // namespace tenon::fem
