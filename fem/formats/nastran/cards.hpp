#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"

/// The text level of Nastran bulk data: files, includes, lines, fields, numbers. Nothing here knows what a card means.
namespace tenon::fem::nastran {

/// One field of a card without the blanks around it: bytes from the card's beginning.
struct Field {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
};

/// One card with all its continuations. Most cards are one line of eight-column fields: those need no list of fields.
struct CardSpan {
  const char* begin = nullptr;  ///< its first line
  std::size_t first_field = 0;  ///< of Text::fields; in columns: the length of the line
  std::uint32_t field_count = 0;
  std::uint32_t line = 0;
  std::uint32_t file : 31 = 0;
  std::uint32_t in_columns : 1 = 0;
  std::uint32_t name = 0;  ///< of Text::names
};

/// A file of the deck, tabs expanded to the columns they stand for.
struct SourceFile {
  SourceFile(std::string as_named, const std::filesystem::path& path);
  std::string_view text() const {
    return expanded.empty() ? without_byte_order_mark(pages.bytes()) : std::string_view(expanded);
  }

  std::string name;  ///< as in messages
  MappedFile pages;
  std::string expanded;  ///< the text when it has tabs
};

/// A line of case control, without comment, upper case but for titles.
struct CaseStatement {
  std::string text;
  Place place;
};

/// All cards of a deck and of the files it includes.
struct Text {
  std::deque<SourceFile> files;
  std::vector<std::string> names;  ///< of cards, upper case, without the large-field star
  std::vector<Field> fields;
  std::vector<CardSpan> cards;
  std::vector<CaseStatement> case_control;
  bool has_case_control = false;
  bool ended = false;  ///< ENDDATA was seen
  Place end;           ///< the last line read
};

/// Splits a deck into cards. Everything before CEND is read past; a file without BEGIN BULK is bulk data throughout.
/// Paths of INCLUDE are relative to the including file, else to the deck. Throws InputError for files that are missing,
/// empty, not text or included twice, and for lines that cannot be split.
/// @param superelement  the file may be the bulk data of one superelement, opened by BEGIN SUPER = n
Text read_text(const std::filesystem::path& path, bool superelement = false);

/// 1.5, 1.5E+3, 1.5D3, 1.5+3, 15: what Nastran takes for a number; nothing for anything else or out of range.
std::optional<double> parse_real(std::string_view text);
std::optional<long> parse_integer(std::string_view text);

constexpr bool white(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
std::string upper(std::string_view text);
std::string_view trim(std::string_view text);

/// A card seen through its fields; they count from 1, the first datum after the name, and run on over continuations.
/// Every access that fails throws InputError at the field, naming it as the manuals do.
class Card {
 public:
  Card(const Text& text, const CardSpan& span) : text_(&text), span_(&span) {}

  const std::string& name() const { return text_->names[span_->name]; }
  int size() const { return static_cast<int>(span_->field_count); }
  bool blank(int field) const { return at(field).empty(); }
  /// The field's text, "" beyond the card's end.
  std::string_view at(int field) const;

  double real(int field, const char* label) const;
  double real(int field, const char* label, double otherwise) const;
  /// A real that must be > 0, or ≥ 0.
  double positive(int field, const char* label) const;
  double non_negative(int field, const char* label, double otherwise) const;
  long integer(int field, const char* label) const;
  long integer(int field, const char* label, long otherwise) const;
  /// An integer > 0.
  long id(int field, const char* label) const;
  long id(int field, const char* label, long otherwise) const;
  /// Digits 1..6 as bits 0..5; a blank or 0 gives no bit.
  unsigned components(int field, const char* label) const;

  Place place() const { return {text_->files[span_->file].name, static_cast<long>(span_->line), 0}; }
  Place place(int field) const;
  /// InputError at a field: "GRID field X1 is '1..0'" and what was expected.
  [[noreturn]] void fail(int field, const char* label, const std::string& expected) const;
  /// InputError at a field (0: at the card) in free words, opened by the card's name.
  [[noreturn]] void refuse(int field, const std::string& what, const std::string& cure) const;

  /// The same card text, number by number.
  bool same_as(const Card& other) const;

 private:
  Field where(int field) const;

  const Text* text_;
  const CardSpan* span_;
};

}  // namespace tenon::fem::nastran
