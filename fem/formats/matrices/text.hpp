#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fem/formats/gmsh/cursor.hpp"

namespace tenon::fem::market {

/// The words and numbers of a text file line by line; faults name file, line and column.
class Text {
 public:
  /// Throws InputError when the file cannot be read or does not end with a line end: a last number may be cut short.
  Text(const std::filesystem::path& path, std::string cure);
  Text(const Text&) = delete;
  Text& operator=(const Text&) = delete;

  const std::string& file() const { return cursor_.file(); }
  std::size_t size() const { return cursor_.size(); }
  std::size_t offset() const { return start_; }  ///< of the word read last

  /// Goes to the next line with words before `comment`; false at the end of the file.
  bool next_line(char comment);
  bool line_ends(char comment);
  std::string_view word(const char* what);
  long whole(const char* what, long least, long most);
  double real(const char* what);
  void end_line(char comment);

  /// Throws InputError at a byte of the file.
  [[noreturn]] void fail(std::size_t at, const std::string& what, const std::string& cure = {}) const;

 private:
  MappedFile pages_;
  std::string cure_;
  gmsh::Cursor cursor_;
  std::size_t start_ = 0;
};

}  // namespace tenon::fem::market
