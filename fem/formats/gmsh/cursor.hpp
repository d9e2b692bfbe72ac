#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "fem/formats/file_bytes.hpp"

/// Reading positions and numbers of Gmsh's files.
namespace tenon::fem::gmsh {

/// A place in a file's bytes, and what is known of how numbers are written there.
class Cursor {
 public:
  /// @param pages  what `bytes` are mapped from, if they are: pages that were read are handed back on the way
  Cursor(std::string file, std::string_view bytes, const MappedFile* pages = nullptr);

  bool binary = false;       ///< numbers inside sections are raw bytes
  bool swapped = false;      ///< they have the other byte order
  int size_width = 8;        ///< bytes of a count or a node number in binary files
  std::string_view section;  ///< "Nodes" while inside $Nodes, for messages

  const std::string& file() const { return file_; }
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }

  /// Moves past white space, line ends included.
  void skip_white();
  /// Moves past white space of this line.
  void skip_blanks();
  /// The next word of this line, "" where the line ends; moves past it.
  std::string_view word();
  /// The rest of this line without its line end; moves to the next line.
  std::string_view line();
  /// Moves to the next line; throws when anything but white space stands before it.
  void end_line();
  /// Moves past the first line that holds `text` alone; false (and no move) when there is none.
  bool skip_past_line(std::string_view text);
  /// Copies `n` raw bytes and moves past them; throws when fewer are left.
  void raw(void* target, std::size_t n, const char* what);

  const char* at() const { return at_; }
  const char* end() const { return end_; }
  void move_to(const char* p) { at_ = p; }
  /// Hands back the pages before the reading position, every 4 MiB.
  void hand_back() {
    if (pages_ && at_ - handed_back_ > 1 << 22) {
      pages_->release(offset());
      handed_back_ = at_;
    }
  }

  /// Throws InputError for the fault at `offset`: file:line:column in text files, the byte offset in binary ones.
  [[noreturn]] void fail(std::size_t offset, const std::string& what, const std::string& cure = {}) const;
  /// The same for what was found at the reading position instead of `expected`.
  [[noreturn]] void fail_expected(const std::string& expected, const std::string& cure = {}) const;

 private:
  std::string file_;
  const char *begin_, *at_, *end_;
  const MappedFile* pages_;
  const char* handed_back_;
};

/// Bytes from a file in quotes, unprintable ones escaped, shortened.
std::string quoted(std::string_view text);

/// Numbers as text, one record a line.
class TextFields {
 public:
  explicit TextFields(Cursor& cursor) : cursor_(cursor) {}
  /// Goes to record i of n of the section's `things`; throws when the section ends before.
  void begin_record(std::int64_t i, std::int64_t n, const char* things);
  void end_record() { cursor_.end_line(); }
  int integer(const char* what);                ///< a signed 4-byte number
  std::int64_t count(const char* what);         ///< a number ≥ 0
  double real(const char* what);                ///< a finite number
  std::size_t start() const { return start_; }  ///< offset of the number read last

 private:
  std::int64_t whole(const char* what);
  Cursor& cursor_;
  std::size_t start_ = 0;
};

/// Numbers as raw bytes of either order, records without separators.
class BinaryFields {
 public:
  explicit BinaryFields(Cursor& cursor) : cursor_(cursor) {}
  void begin_record(std::int64_t i, std::int64_t n, const char* things);
  void end_record() {}
  int integer(const char* what);
  std::int64_t count(const char* what);
  double real(const char* what);
  std::size_t start() const { return start_; }

 private:
  template <class T>
  T load(const char* what);
  Cursor& cursor_;
  std::size_t start_ = 0;
};

}  // namespace tenon::fem::gmsh
