#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>

#include "fem/error.hpp"
#include "fem/formats/matrices/op4.hpp"

// Fortran records: [length] data [length]. A matrix is a header record (NCOL NROW FORM TYPE NAME), one record a column
// that is not null (ICOL IROW NW data), and a last column record with ICOL = NCOL + 1. NW counts words of data:
//   dense (IROW > 0)                 numbers from row IROW on
//   sparse (IROW = 0)                strings, each [IS] numbers, IS = 65536 L + row
//   sparse, NROW < 0 or ≥ 65536      strings, each [L, row] numbers; L is one more than their words
namespace tenon::fem::matrices {
namespace {

class BinaryReader {
 public:
  BinaryReader(const std::string& file, const MappedFile& pages) : file_(file), pages_(pages), bytes_(pages.bytes()) {
    swapped_ = bytes_[0] == 0;  // the length of the first record is 24 or 48
    word_ = bytes_[swapped_ ? 3 : 0] == 48 ? 8 : 4;
  }

  std::vector<NamedMatrix> read() {
    std::vector<NamedMatrix> all;
    while (at_ < bytes_.size()) all.push_back(matrix());
    return all;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError({file_}, fmt::format("{} (byte {})", what, at_), damaged);
  }
  void check(const std::string& fault) const {
    if (!fault.empty()) fail(fault);
  }

  template <class T>
  T load(const char* from) const {
    char raw[sizeof(T)];
    std::memcpy(raw, from, sizeof(T));
    if (swapped_) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  /// Moves past one record and returns its data.
  std::string_view record(const char* what) {
    if (bytes_.size() - at_ < 8) fail(fmt::format("the file ends where {} was expected", what));
    const std::int64_t length = load<std::int32_t>(bytes_.data() + at_);
    if (length < 0 || static_cast<std::size_t>(length) > bytes_.size() - at_ - 8)
      fail(fmt::format("found a record of {} bytes where {} was expected, {} bytes before the end", length, what,
                       bytes_.size() - at_));
    const std::string_view data = bytes_.substr(at_ + 4, static_cast<std::size_t>(length));
    const std::int64_t after = load<std::int32_t>(data.data() + length);
    if (after != length) fail(fmt::format("found a record that begins with length {} and ends with {}", length, after));
    at_ += static_cast<std::size_t>(length) + 8;
    data_ = data;
    return data;
  }

  /// The next word of the record as an integer.
  std::int64_t integer() {
    if (data_.size() < word_) fail("found a record that ends inside a column");
    const std::int64_t value = word_ == 4 ? load<std::int32_t>(data_.data()) : load<std::int64_t>(data_.data());
    data_.remove_prefix(word_);
    return value;
  }

  NamedMatrix matrix() {
    const std::size_t start = at_;
    const std::string_view header = record("the header of a matrix");
    if (header.size() != 6 * word_) {
      at_ = start;
      fail(fmt::format("found a record of {} bytes, expected the header of a matrix, {} bytes", header.size(),
                       6 * word_));
    }
    NamedMatrix matrix;
    matrix.columns = integer();
    const std::int64_t rows = integer();
    matrix.rows = rows < 0 && rows != std::numeric_limits<std::int64_t>::min() ? -rows : rows;
    matrix.form = static_cast<int>(integer());
    const std::int64_t type = integer();
    for (const char c : data_)
      if (c > ' ' && c < 127) matrix.name += c;
    check(fault_of_header(matrix, type));

    ColumnFiller filler(matrix);
    const bool big = rows < 0 || matrix.rows >= big_matrix_rows;
    const bool single = type == 1 && word_ == 4;
    matrix.entries.reserve((bytes_.size() - at_) / (single ? 4 : 8));
    while (column(matrix, filler, big, single))
      if (at_ > handed_back_ + op4_piece) pages_.release(handed_back_ = at_);
    trim_entries(matrix);
    return matrix;
  }

  /// False at the record that ends the matrix.
  bool column(const NamedMatrix& matrix, ColumnFiller& filler, bool big, bool single) {
    record("a column");
    const std::int64_t column = integer(), row = integer(), words = integer();
    if (column > matrix.columns) return false;
    if (words < 0 || static_cast<std::uint64_t>(words) != data_.size() / word_ || data_.size() % word_ != 0)
      fail(fmt::format("found {} words announced and {} bytes present in column {} of {}", words, data_.size(), column,
                       matrix.name));
    check(filler.begin(column));
    const std::size_t width = single ? 4 : 8;
    if (row != 0) {
      numbers(filler, row, data_.size(), width);
    } else {
      while (!data_.empty()) {
        std::int64_t length = integer(), first = 0;  // words of the string, its header counted with L but not with row
        if (big) {
          first = integer();
        } else {
          first = length % 65536;
          length /= 65536;
        }
        if (length < 2 || static_cast<std::uint64_t>(length - 1) > data_.size() / word_)
          fail(fmt::format("found a string of {} words in column {} of {}, {} words before its end", length - 1, column,
                           matrix.name, data_.size() / word_));
        numbers(filler, first, static_cast<std::size_t>(length - 1) * word_, width);
      }
    }
    return true;
  }

  void numbers(ColumnFiller& filler, std::int64_t row, std::size_t size, std::size_t width) {
    if (size % width != 0) fail(fmt::format("found {} bytes of numbers of {} bytes each", size, width));
    const std::size_t count = size / width;
    check(filler.begin_string(row, static_cast<std::int64_t>(count)));
    for (std::size_t i = 0; i < count; ++i) {
      const char* from = data_.data() + i * width;
      check(filler.add(width == 4 ? static_cast<double>(load<float>(from)) : load<double>(from)));
    }
    data_.remove_prefix(size);
  }

  const std::string& file_;
  const MappedFile& pages_;
  std::string_view bytes_, data_;  ///< the file, and what is left of the record
  std::size_t at_ = 0;             ///< offset of the next record
  std::size_t handed_back_ = 0;
  std::size_t word_ = 4;
  bool swapped_ = false;  ///< the file's byte order is not this machine's
};

}  // namespace

std::vector<NamedMatrix> read_op4_binary(const std::string& file, const MappedFile& pages) {
  return BinaryReader(file, pages).read();
}

}  // namespace tenon::fem::matrices
