#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "fem/formats/matrices/op4.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/fem/formats/matrices/op4_files.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

std::string refused(const std::string& bytes) {
  const Scratch folder;
  const auto file = folder.write("a.op4", bytes);
  return tenon::tests::refusal([&] { read_op4(file); });
}

Eigen::MatrixXd small() { return (Eigen::MatrixXd(3, 2) << 1.0, 0.0, 0.0, 2.0, 3.0, 4.0).finished(); }

std::string words(std::initializer_list<std::int32_t> values) {
  Bytes bytes(false);
  for (const std::int32_t value : values) bytes.put(value);
  return bytes.text;
}

/// A 3×2 file whose column records are given.
std::string with_columns(const std::string& columns, int rows = 3, int type = 2) {
  return record(words({2, rows, 2, type}) + "A       ", false) + columns;
}

}  // namespace

TEST(Op4Faults, EveryCutIsRefused) {
  for (const Layout layout : {Layout::dense, Layout::sparse, Layout::big}) {
    const std::string binary = op4_binary("A", small(), {.layout = layout});
    for (std::size_t n = 0; n < binary.size(); ++n) EXPECT_NE(refused(binary.substr(0, n)), "") << n << " bytes";
    const std::string ascii = op4_ascii("A", small(), {.layout = layout});
    const std::size_t last = ascii.rfind("1.0000");  // the number that ends the matrix is never used
    for (std::size_t n = 0; n + 3 < last; ++n) EXPECT_NE(refused(ascii.substr(0, n)), "") << n << " characters";
  }
}

TEST(Op4Faults, BinaryRecordsAreHeldToTheirLengths) {
  EXPECT_THAT(refused(""), HasSubstr("the file is empty"));
  std::string bytes = op4_binary("A", small());
  bytes[28] = 25;  // behind the header
  EXPECT_THAT(refused(bytes), HasSubstr("begins with length 24 and ends with 25"));
  EXPECT_THAT(refused(with_columns(Bytes(false).put(std::int32_t{1 << 30}).text + "12345678")),
              AllOf(HasSubstr("a record of 1073741824 bytes"), HasSubstr("byte 32")));
  EXPECT_THAT(refused(with_columns(record(words({1, 1, 4}) + Bytes(false).put(1.0).text, false))),
              HasSubstr("4 words announced and 8 bytes present in column 1 of A"));
  EXPECT_THAT(refused(with_columns(record(words({1, 0, 4, 1, 1, 1, 1}), false), -3)),
              HasSubstr("a string of 0 words in column 1"));
  EXPECT_THAT(refused(with_columns(record(words({1, 0, 4, 99, 1, 1, 1}), false), -3)),
              HasSubstr("a string of 98 words in column 1"));
  EXPECT_THAT(refused(with_columns(record(words({1, 1, 1, 7}), false))),
              HasSubstr("4 bytes of numbers of 8 bytes each"));
}

// found by libFuzzer: the one number of rows whose negative is no number
TEST(Op4Faults, RowsWithoutANegative) {
  std::string bytes = std::string(56, '\0');
  bytes[3] = bytes[55] = 48;  // a header of six words of 8 bytes, the larger end first
  bytes[11] = 7;
  bytes[12] = '\x80';
  EXPECT_THAT(refused(bytes), HasSubstr("expected 1 to"));
}

TEST(Op4Faults, ColumnsStayInsideTheMatrix) {
  const auto column = [](int j, int row, std::vector<double> numbers) {
    Bytes bytes(false);
    for (const double value : numbers) bytes.put(value);
    return record(words({j, row, 2 * static_cast<int>(numbers.size())}) + bytes.text, false);
  };
  EXPECT_THAT(refused(with_columns(column(1, 3, {1.0, 2.0}))),
              HasSubstr("2 numbers from row 3 on in column 1 of A, which"));
  EXPECT_THAT(refused(with_columns(column(1, 4, {1.0}))), HasSubstr("which has 3 rows"));
  EXPECT_THAT(refused(with_columns(column(2, 1, {1.0}) + column(1, 1, {1.0}))),
              HasSubstr("found column 1 of A behind column 2"));
  EXPECT_THAT(refused(with_columns(column(0, 1, {1.0}))), HasSubstr("found column 0"));
  EXPECT_THAT(refused(with_columns(column(1, 1, {std::numeric_limits<double>::quiet_NaN()}))),
              HasSubstr("row 1 of column 1 of A is no finite number"));
  const std::string string = words({3, 2}) + Bytes(false).put(1.0).text;
  EXPECT_THAT(refused(with_columns(record(words({1, 0, 8}) + string + string, false), -3)),
              HasSubstr("from row 2 on in column 1 of A, where row 3 or later"));
}

TEST(Op4Faults, HeadersAreUnderstoodOrRefused) {
  EXPECT_THAT(refused(with_columns("", 3, 4)), HasSubstr("matrix 'A' is complex"));
  EXPECT_THAT(refused(with_columns("", 3, 7)), HasSubstr("the type 7"));
  EXPECT_THAT(refused(with_columns("", 0)), HasSubstr("the size 0×2"));
  EXPECT_THAT(refused("hello\n"), AllOf(HasSubstr("a.op4:1:1"), HasSubstr("found 'hello'")));
  EXPECT_THAT(refused("\n\n"), HasSubstr("holds no matrix"));
  EXPECT_THAT(refused("       2       3       2       3A       1P,3E23.16\n"), HasSubstr("complex"));
  EXPECT_THAT(refused("       2       3       2       2A       1P,E23.16\n"),
              HasSubstr("a.op4:1:41: found '1P,E23.16'"));
}

TEST(Op4Faults, AsciiNumbersAreNamedByLineAndColumn) {
  const std::string good = op4_ascii("A", (Eigen::MatrixXd(2, 1) << 1.0, 2.0).finished());
  std::string bad = good;
  bad.replace(bad.find("2.0000"), 3, "2x0");
  EXPECT_THAT(refused(bad), AllOf(HasSubstr("a.op4:3:24: found '2x0"), HasSubstr("a number 23 columns wide")));
  bad = good;
  bad.insert(bad.find('\n', bad.find("2.0000")), "  3.0");
  EXPECT_THAT(refused(bad), HasSubstr("a.op4:3:47: found '3.0' behind the last number"));
  const std::string head = "       1       3       2       2A       1P,3E23.16\n";
  EXPECT_THAT(refused(head + "       1       0       3\n      x1\n"), HasSubstr("expected the header of a string"));
  EXPECT_THAT(refused(head + "       1       0       3\n      262145\n"),
              HasSubstr("a string of 4 words where 3 words"));
  EXPECT_THAT(refused(head + "       1       1 9000000\n"), HasSubstr("9000000 numbers from row 1"));
}
