#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fem/formats/file_bytes.hpp"

/// Nastran OUTPUT4 files (.op4).
namespace tenon::fem {

/// One real matrix of an OP4 file as the file lists it: zeros left out, columns in rising order. The size is only what
/// the file declares, so nothing of that size is ever allocated here.
struct NamedMatrix {
  std::string name;
  std::int64_t rows = 0, columns = 0;
  int form = 0;  ///< 1 square, 2 rectangular, 6 symmetric
  std::vector<Eigen::Triplet<double>> entries;
};

/// All matrices of an OP4 file in its order: ascii or binary of either byte order (words of 4 or 8 bytes); dense,
/// sparse or sparse with big-matrix string headers; single or double precision. Throws InputError with file:line
/// (ascii) or the byte offset (binary) for a broken file and for complex matrices. Source: the OUTPUT4 module of the
/// MSC and NX Nastran DMAP guides; 8-byte words as pyYeti (nastran.op4) reads them.
std::vector<NamedMatrix> read_op4(const std::filesystem::path& file);

namespace matrices {

/// What to do about a file whose numbers do not add up.
inline constexpr auto damaged = "The file may be cut off or damaged; write it again";

/// Fills one column: strings of numbers at rows that rise, inside the declared size, finite.
class ColumnFiller {
 public:
  explicit ColumnFiller(NamedMatrix& matrix) : matrix_(matrix) {}
  /// "" or what is wrong with column `column` (1-based) here.
  std::string begin(std::int64_t column);
  /// "" or what is wrong with a string of `count` numbers from `row` on (1-based).
  std::string begin_string(std::int64_t row, std::int64_t count);
  /// "" or what is wrong with the next number of the string.
  std::string add(double value);

 private:
  NamedMatrix& matrix_;
  std::int64_t column_ = 0, row_ = 0, next_row_ = 1;
};

/// "" or what is wrong with a header: sizes, form and type (1, 2 real; 3, 4 complex).
std::string fault_of_header(const NamedMatrix& matrix, std::int64_t type);

/// Gives back the room that was reserved for all numbers left of the file, where little of it is used: memory that is
/// not written to costs nothing, but a file may hold many matrices.
void trim_entries(NamedMatrix& matrix);

std::vector<NamedMatrix> read_op4_ascii(const std::string& file, const MappedFile& pages);
std::vector<NamedMatrix> read_op4_binary(const std::string& file, const MappedFile& pages);

/// Pages of the file are handed back after so many bytes.
constexpr std::size_t op4_piece = 1 << 22;

/// From this many rows on, strings of sparse columns have a two-word header whatever the sign of NROW.
constexpr std::int64_t big_matrix_rows = 65536;

}  // namespace matrices
}  // namespace tenon::fem
