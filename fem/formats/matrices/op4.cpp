#include "fem/formats/matrices/op4.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "fem/error.hpp"

namespace tenon::fem {
namespace matrices {

std::string ColumnFiller::begin(std::int64_t column) {
  if (column <= column_) return fmt::format("found column {} of {} behind column {}", column, matrix_.name, column_);
  column_ = column;
  next_row_ = 1;
  return {};
}

std::string ColumnFiller::begin_string(std::int64_t row, std::int64_t count) {
  if (row < next_row_)
    return fmt::format("found numbers from row {} on in column {} of {}, where row {} or later was expected", row,
                       column_, matrix_.name, next_row_);
  if (count < 1 || row > matrix_.rows || count > matrix_.rows - row + 1)
    return fmt::format("found {} numbers from row {} on in column {} of {}, which has {} rows", count, row, column_,
                       matrix_.name, matrix_.rows);
  row_ = row;
  next_row_ = row + count;
  return {};
}

std::string ColumnFiller::add(double value) {
  if (!std::isfinite(value))
    return fmt::format("row {} of column {} of {} is no finite number", row_, column_, matrix_.name);
  if (value != 0.0) matrix_.entries.emplace_back(static_cast<int>(row_ - 1), static_cast<int>(column_ - 1), value);
  ++row_;
  return {};
}

std::string fault_of_header(const NamedMatrix& matrix, std::int64_t type) {
  constexpr std::int64_t most = std::numeric_limits<int>::max() - 1;
  if (matrix.rows < 1 || matrix.columns < 1 || matrix.rows > most || matrix.columns > most)
    return fmt::format("found the size {}×{} for matrix '{}', expected 1 to {} rows and columns", matrix.rows,
                       matrix.columns, matrix.name, most);
  if (type == 3 || type == 4) return fmt::format("matrix '{}' is complex, and only real ones are read", matrix.name);
  if (type != 1 && type != 2)
    return fmt::format("found the type {} for matrix '{}', expected 1 (single) or 2 (double)", type, matrix.name);
  return {};
}

void trim_entries(NamedMatrix& matrix) {
  if (matrix.entries.capacity() > 4 * matrix.entries.size()) matrix.entries.shrink_to_fit();
}

}  // namespace matrices

std::vector<NamedMatrix> read_op4(const std::filesystem::path& path) {
  const std::string file = path.string();
  const MappedFile pages(path);
  const std::string_view bytes = pages.bytes();
  if (bytes.empty()) throw InputError({file}, "the file is empty", "Write it again");
  // a binary file begins with the length of its first record, 24 or 48 bytes
  const auto length_at = [&](std::size_t i) { return bytes[i] == 24 || bytes[i] == 48; };
  const bool binary = bytes.size() >= 4 && bytes[1] == 0 && bytes[2] == 0 &&
                      ((length_at(0) && bytes[3] == 0) || (length_at(3) && bytes[0] == 0));
  return binary ? matrices::read_op4_binary(file, pages) : matrices::read_op4_ascii(file, pages);
}

}  // namespace tenon::fem
