#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fem/formats/file_bytes.hpp"

namespace tenon::fem::matrices {

/// The words of a text file line by line, parted by blanks or commas.
class NumberLines {
 public:
  /// Opens the file. Throws InputError when its last line has no line end: a number there may be cut short.
  explicit NumberLines(const std::filesystem::path& path);
  NumberLines(const NumberLines&) = delete;
  NumberLines& operator=(const NumberLines&) = delete;

  /// Goes to the next line that is not blank; false at the end of the file.
  bool next();
  /// The line without the blanks before it.
  std::string_view line() const { return line_; }
  /// The next word of the line; throws when there is none.
  std::string_view word(const char* what);
  long integer(const char* what);
  double real(const char* what);  ///< finite
  /// Throws when another word stands on the line.
  void end_line();

  const std::string& file() const { return file_; }
  /// How many lines the file has: no more entries than that, one a line.
  std::size_t count() const;
  /// Throws InputError at the word read last.
  [[noreturn]] void fail(const std::string& what, const std::string& cure) const;

 private:
  [[noreturn]] void fail_expected(std::string_view found, const char* what) const;

  std::string file_;
  MappedFile pages_;
  std::size_t handed_back_ = 0;
  std::string_view rest_, line_, left_;  ///< of the file, of the line, what is left of it
  long number_ = 0, column_ = 0;
  const char* start_ = nullptr;  ///< of the line
};

}  // namespace tenon::fem::matrices
