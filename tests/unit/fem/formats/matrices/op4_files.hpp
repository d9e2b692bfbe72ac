#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

/// OP4 files of every kind, written as the OUTPUT4 manual describes them.
namespace tenon::fem::testing {

enum class Layout { dense, sparse, big };

struct Op4Kind {
  Layout layout = Layout::dense;
  int type = 2;          ///< 1 single, 2 double
  bool foreign = false;  ///< the other byte order
  int word = 4;          ///< bytes of an integer
};

/// Bytes in either order.
class Bytes {
 public:
  explicit Bytes(bool foreign) : foreign_(foreign) {}
  template <class T>
  Bytes& put(T value) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
    if (foreign_) std::ranges::reverse(raw);
    text += raw;
    return *this;
  }
  std::string text;

 private:
  bool foreign_;
};

inline std::string record(const std::string& data, bool foreign) {
  const auto length = static_cast<std::int32_t>(data.size());
  return Bytes(foreign).put(length).text + data + Bytes(foreign).put(length).text;
}

/// The first rows and the numbers of the strings of one column; a dense column is one string.
struct String {
  int row = 0;  ///< from 0
  std::vector<double> numbers;
};

inline std::vector<String> strings_of(const Eigen::VectorXd& column, Layout layout) {
  std::vector<String> all;
  for (int i = 0; i < column.size(); ++i) {
    if (column(i) == 0.0) continue;
    const int next = all.empty() ? -1 : all.back().row + static_cast<int>(all.back().numbers.size());
    if (all.empty() || (layout != Layout::dense && next != i)) all.push_back({i, {}});
    auto& [row, numbers] = all.back();
    numbers.resize(static_cast<std::size_t>(i - row), 0.0);
    numbers.push_back(column(i));
  }
  return all;
}

inline std::string op4_binary(const std::string& name, const Eigen::MatrixXd& A, const Op4Kind& kind = {}) {
  const auto words = [&](std::initializer_list<std::int64_t> values) {
    Bytes bytes(kind.foreign);
    for (const std::int64_t value : values) {
      if (kind.word == 4)
        bytes.put(static_cast<std::int32_t>(value));
      else
        bytes.put(value);
    }
    return bytes.text;
  };
  const int words_of_number = kind.type == 1 || kind.word == 8 ? 1 : 2;
  const auto numbers = [&](const std::vector<double>& values) {
    Bytes bytes(kind.foreign);
    for (const double value : values) {
      if (kind.type == 1 && kind.word == 4)
        bytes.put(static_cast<float>(value));
      else
        bytes.put(value);
    }
    return bytes.text;
  };
  const bool big = kind.layout == Layout::big;
  std::string padded = name;
  padded.resize(static_cast<std::size_t>(2 * kind.word), ' ');
  std::string file = record(words({A.cols(), big ? -A.rows() : A.rows(), 2, kind.type}) + padded, kind.foreign);
  for (int j = 0; j < A.cols(); ++j) {
    const std::vector<String> strings = strings_of(A.col(j), kind.layout);
    if (strings.empty()) continue;
    std::string data;
    for (const String& s : strings) {
      const int length = 1 + words_of_number * static_cast<int>(s.numbers.size());
      if (kind.layout == Layout::sparse) data += words({65536 * length + s.row + 1});
      if (big) data += words({length, s.row + 1});
      data += numbers(s.numbers);
    }
    const auto count = static_cast<std::int64_t>(data.size()) / kind.word;
    file += record(words({j + 1, kind.layout == Layout::dense ? strings[0].row + 1 : 0, count}) + data, kind.foreign);
  }
  return file + record(words({A.cols() + 1, 1, words_of_number}) + numbers({1.0}), kind.foreign);
}

/// @param letter  of the exponent, E or D
inline std::string op4_ascii(const std::string& name, const Eigen::MatrixXd& A, const Op4Kind& kind = {},
                             char letter = 'E') {
  const auto lines = [&](const std::vector<double>& values) {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
      text += fmt::format("{:23.15E}", values[i]);
      if (i % 3 == 2 || i + 1 == values.size()) text += '\n';
    }
    std::ranges::replace(text, 'E', letter);
    return text;
  };
  const bool big = kind.layout == Layout::big;
  const int words_of_number = kind.type;
  std::string file = fmt::format("{:8}{:8}{:8}{:8}{:<8}1P,3{}23.15\n", A.cols(), big ? -A.rows() : A.rows(), 2,
                                 kind.type, name, letter);
  for (int j = 0; j < A.cols(); ++j) {
    const std::vector<String> strings = strings_of(A.col(j), kind.layout);
    if (strings.empty()) continue;
    if (kind.layout == Layout::dense) {
      file += fmt::format("{:8}{:8}{:8}\n", j + 1, strings[0].row + 1, strings[0].numbers.size()) +
              lines(strings[0].numbers);
      continue;
    }
    std::string data;
    int count = 0;
    for (const String& s : strings) {
      const int length = 1 + words_of_number * static_cast<int>(s.numbers.size());
      data +=
          (big ? fmt::format("{:8}{:8}\n", length, s.row + 1) : fmt::format("{:12}\n", 65536 * length + s.row + 1)) +
          lines(s.numbers);
      count += length + (big ? 1 : 0);
    }
    file += fmt::format("{:8}{:8}{:8}\n", j + 1, 0, count) + data;
  }
  return file + fmt::format("{:8}{:8}{:8}\n", A.cols() + 1, 1, 1) + lines({1.0});
}

}  // namespace tenon::fem::testing
