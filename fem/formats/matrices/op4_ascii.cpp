#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>

#include "fem/error.hpp"
#include "fem/formats/matrices/op4.hpp"
#include "fem/formats/nastran/cards.hpp"

// Fixed columns: a header line (NCOL NROW FORM TYPE, 8 columns each; NAME; FORMAT, e.g. 1P,3E23.16), per column that is
// not null a line (ICOL IROW NW) and lines of numbers, then ICOL = NCOL + 1 with one number. Dense columns (IROW > 0)
// hold NW numbers from row IROW on. Sparse ones (IROW = 0) hold strings, each behind a line of its own: "L row" for big
// matrices (NROW < 0 or ≥ 65536), else IS = 65536 L + row, where L − 1 is the length in words, two a double.
namespace tenon::fem::matrices {
namespace {

using nastran::parse_integer;
using nastran::parse_real;
using nastran::trim;
using nastran::upper;

class AsciiReader {
 public:
  AsciiReader(const std::string& file, const MappedFile& pages) : file_(file), pages_(pages), rest_(pages.bytes()) {}

  std::vector<NamedMatrix> read() {
    std::vector<NamedMatrix> all;
    while (next_line()) {
      if (!trim(line_).empty()) all.push_back(matrix());
    }
    if (all.empty()) throw InputError({file_}, "the file holds no matrix", "Check that it is the right file");
    return all;
  }

 private:
  [[noreturn]] void fail(const std::string& what, long column = 0) const {
    throw InputError({file_, number_, column}, what, damaged);
  }
  void check(const std::string& fault) const {
    if (!fault.empty()) fail(fault);
  }

  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    ++number_;
    return true;
  }
  /// @param expected  says what, once it is missing
  template <class Expected>
  void require_line(Expected expected) {
    if (!next_line()) fail(fmt::format("the file ends where {} was expected", expected()));
  }

  void hand_back() {
    if (const std::size_t read = pages_.bytes().size() - rest_.size(); read > handed_back_ + op4_piece)
      pages_.release(handed_back_ = read);
  }

  std::string_view part(std::size_t from, std::size_t width) const {
    return from < line_.size() ? line_.substr(from, width) : std::string_view{};
  }

  /// The integer in field `i` of 8 columns.
  std::int64_t integer(std::size_t i, const char* label) const {
    const std::string_view text = trim(part(8 * i, 8));
    if (const auto value = parse_integer(text)) return *value;
    fail(fmt::format("found '{}' for {} of an OP4 file, expected an integer in 8 columns", text.substr(0, 40), label),
         static_cast<long>(8 * i) + 1);
  }

  NamedMatrix matrix() {
    NamedMatrix matrix;
    matrix.columns = integer(0, "the number of columns");
    const std::int64_t rows = integer(1, "the number of rows");
    matrix.rows = rows < 0 ? -rows : rows;
    matrix.form = static_cast<int>(integer(2, "the form"));
    const std::int64_t type = integer(3, "the type");
    matrix.name = std::string(trim(part(32, 8)));
    check(fault_of_header(matrix, type));
    number_format();

    const bool big = rows < 0 || matrix.rows >= big_matrix_rows;
    const std::int64_t words_of_number = type == 1 ? 1 : 2;
    ColumnFiller filler(matrix);
    matrix.entries.reserve(rest_.size() / width_);
    while (true) {
      hand_back();
      require_line([&] { return fmt::format("a column of {}", matrix.name); });
      const std::int64_t column = integer(0, "a column"), row = integer(1, "the first row");
      const std::int64_t count = integer(2, "the length of a column");
      if (column > matrix.columns) break;
      check(filler.begin(column));
      if (row != 0)
        numbers(filler, row, count);
      else
        strings(matrix, filler, big, words_of_number, count);
    }
    require_line([] { return "the number that ends the matrix"; });
    trim_entries(matrix);
    return matrix;
  }

  void strings(const NamedMatrix& matrix, ColumnFiller& filler, bool big, std::int64_t words_of_number,
               std::int64_t words) {
    const std::int64_t header = big ? 1 : 0;  // words that L does not count
    while (words > 0) {
      require_line([&] { return fmt::format("a string of {}", matrix.name); });
      std::int64_t length = 0, row = 0;
      if (big) {
        length = integer(0, "the length of a string");
        row = integer(1, "the row of a string");
      } else {
        const auto packed = parse_integer(trim(line_));
        if (!packed || *packed < 0)
          fail(fmt::format("found '{}', expected the header of a string", trim(line_).substr(0, 40)), 1);
        length = *packed / 65536;
        row = *packed % 65536;
      }
      if (length < 2 || length + header > words || (length - 1) % words_of_number != 0)
        fail(fmt::format("found a string of {} words where {} words are left in the column", length, words), 1);
      numbers(filler, row, (length - 1) / words_of_number);
      words -= length + header;
    }
  }

  void numbers(ColumnFiller& filler, std::int64_t row, std::int64_t count) {
    check(filler.begin_string(row, count));
    std::size_t column = 0;
    const auto end_line = [&] {
      if (!trim(part(column, line_.size())).empty())
        fail(fmt::format("found '{}' behind the last number expected here", trim(part(column, 40))),
             static_cast<long>(column) + 1);
    };
    for (std::int64_t i = 0; i < count; ++i) {
      if (i % per_line_ == 0) {
        if (i > 0) end_line();
        require_line([&] { return fmt::format("{} more numbers", count - i); });
        column = 0;
      }
      const std::string_view text = trim(part(column, width_));
      const auto value = parse_real(text);
      if (!value)
        fail(fmt::format("found '{}', expected a number {} columns wide ({} more to come)", text.substr(0, 40), width_,
                         count - i),
             static_cast<long>(column) + 1);
      check(filler.add(*value));
      column += width_;
    }
    end_line();
  }

  /// "1P,3E23.16" → 3 numbers of 23 columns a line; 5 of 16 when the header names none.
  void number_format() {
    per_line_ = 5;
    width_ = 16;
    std::string text = upper(trim(part(40, line_.size())));
    if (text.empty()) return;
    std::string_view format = text;
    if (format.starts_with("1P")) format = format.substr(format.starts_with("1P,") ? 3 : 2);
    int width = 0, per_line = 0;
    const auto [letter, bad_count] = std::from_chars(format.data(), format.data() + format.size(), per_line);
    const std::size_t from = static_cast<std::size_t>(letter - format.data());
    if (bad_count == std::errc{} && from < format.size() && (format[from] == 'E' || format[from] == 'D')) {
      const char* begin = letter + 1;
      const auto [end, bad_width] = std::from_chars(begin, format.data() + format.size(), width);
      if (bad_width != std::errc{} || end == begin) width = 0;
    }
    if (per_line < 1 || per_line > 1000 || width < 1 || width > 1000)
      fail(fmt::format("found '{}', expected a format such as 1P,3E23.16", text.substr(0, 40)), 41);
    per_line_ = per_line;
    width_ = static_cast<std::size_t>(width);
  }

  const std::string& file_;
  const MappedFile& pages_;
  std::string_view rest_, line_;
  long number_ = 0;
  std::size_t handed_back_ = 0;
  std::int64_t per_line_ = 5;
  std::size_t width_ = 16;
};

}  // namespace

std::vector<NamedMatrix> read_op4_ascii(const std::string& file, const MappedFile& pages) {
  return AsciiReader(file, pages).read();
}

}  // namespace tenon::fem::matrices
