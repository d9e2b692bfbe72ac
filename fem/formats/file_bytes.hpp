#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tenon::fem {

/// The contents of a regular file. Throws InputError when it does not exist (naming near misses in its folder), is a
/// folder or a device, or cannot be read.
std::string read_bytes(const std::filesystem::path& path);

/// A regular file seen in place, for texts that are larger than what is kept of them: its pages are the system's own
/// and count as memory of this process only while they are being read. The file must not shrink meanwhile.
class MappedFile {
 public:
  /// Throws as read_bytes does.
  explicit MappedFile(const std::filesystem::path& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  std::string_view bytes() const { return {begin_, size_}; }
  /// Hands the pages that lie wholly before `end` back; reading them again brings them back.
  void release(std::size_t end) const;

 private:
  const char* begin_ = nullptr;
  std::size_t size_ = 0;
};

/// Without the mark that some editors put before UTF-8 text.
inline std::string_view without_byte_order_mark(std::string_view text) {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

}  // namespace tenon::fem
