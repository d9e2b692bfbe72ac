#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"

/// The text level of .inp files: files, includes, keywords, data lines, fields. Nothing here knows what a keyword
/// means.
namespace tenon::fem::abaqus {

/// A file of the deck.
struct Source {
  std::string name;  ///< as in messages
  MappedFile pages;
};

/// Data lines that stand together in one file.
struct Piece {
  const Source* source = nullptr;
  std::string_view text;
  long first_line = 1;
};

/// A keyword line with its parameters, and the data lines up to the next keyword (those of an included file too).
struct Block {
  std::string keyword;                            ///< upper case, single blanks: "SHELL SECTION"
  std::map<std::string, std::string> parameters;  ///< upper-case name → value as written, "" where it has none
  Place place;
  std::vector<Piece> data;
  int scope = -1;  ///< of Draft::instances, whose part it belongs to; −1: of the model

  bool has(const std::string& name) const { return parameters.contains(name); }
  /// The value, "" where the keyword has no such parameter.
  std::string value(const std::string& name) const;
  /// The same in upper case.
  std::string upper_value(const std::string& name) const;
  /// InputError at the keyword line.
  [[noreturn]] void refuse(const std::string& what, const std::string& cure) const;
};

/// Reads the fields of a block's data lines one line after the other; comments and empty lines are passed over.
class DataLines {
 public:
  explicit DataLines(const Block& block) : block_(&block) {}

  /// The next line's fields, blanks around them taken off; false at the end. An empty field behind the last comma does
  /// not count, but tells that the record goes on (`open()`).
  bool next();
  const std::vector<std::string_view>& fields() const { return fields_; }
  std::size_t size() const { return fields_.size(); }
  bool open() const { return open_; }

  /// Whether the next line of the block is empty: `next` passes it over.
  bool blank_follows() const;

  /// Field i, "" beyond the line's end.
  std::string_view at(std::size_t i) const { return i < fields_.size() ? fields_[i] : std::string_view{}; }
  long integer(std::size_t i, const char* what) const;
  double real(std::size_t i, const char* what) const;
  double real(std::size_t i, const char* what, double otherwise) const;
  double positive(std::size_t i, const char* what) const;

  const Block& block() const { return *block_; }
  Place place(std::size_t i = 0) const;
  [[noreturn]] void fail(std::size_t i, const std::string& expected) const;
  [[noreturn]] void refuse(std::size_t i, const std::string& what, const std::string& cure) const;

 private:
  const Block* block_;
  std::size_t piece_ = 0, at_ = 0;
  long line_ = 0;
  std::string_view text_;
  std::vector<std::string_view> fields_;
  bool open_ = false;
};

struct Text {
  std::deque<Source> files;
  std::vector<Block> blocks;
};

/// Splits a deck with all that it includes into keyword blocks. Paths of *INCLUDE are relative to the deck's folder,
/// else to the including file's. Throws InputError for files that are missing, empty, no text or include themselves,
/// and for data before the first keyword.
Text read_text(const std::filesystem::path& path);

std::string upper(std::string_view text);
std::optional<long> parse_integer(std::string_view text);
/// 1.5, 1.5E3, 1.5D3, 15.
std::optional<double> parse_real(std::string_view text);

}  // namespace tenon::fem::abaqus
