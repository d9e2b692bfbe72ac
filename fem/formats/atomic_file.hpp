#pragma once

#include <filesystem>
#include <fstream>

namespace tenon::fem {

/// A file that appears whole or not at all: written beside its final place, renamed by commit(), removed if commit() is
/// never reached. Throws InputError when the folder cannot be written.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  std::ofstream stream_;
};

}  // namespace tenon::fem
