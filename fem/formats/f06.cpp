#include "fem/formats/f06.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"

namespace tenon::fem {
namespace {

enum class Table { none, eigenvalues, shape, mass };

/// Whole number of a word, if it is one.
std::optional<long> whole(std::string_view word) {
  long value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// Number of a word, "1.5E-03", "1.5D-3" and "1.5-103" alike; must hold a point, as all that Nastran prints.
std::optional<double> real(std::string_view word) {
  if (word.find('.') == std::string_view::npos) return {};
  std::string text;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    const bool sign = c == '-' || c == '+';
    if (sign && i > 0 && !text.ends_with('e')) text += 'e';
    if (!(c == '+' && i == 0)) text += c == 'E' || c == 'D' ? 'e' : c;
  }
  if (const auto plus = text.find("e+"); plus != std::string::npos) text.erase(plus + 1, 1);
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

int significant(std::string_view word) {
  int digits = 0;
  for (const char c : word.substr(0, word.find_first_of("ED")))
    if (c >= '0' && c <= '9' && (digits > 0 || c != '0')) ++digits;
  return digits;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path.string()), mapped_(path) {}

  ModalRun read() {
    std::string_view rest = mapped_.bytes();
    while (!rest.empty()) {
      const std::size_t end = rest.find('\n');
      ++line_;
      split(rest.substr(0, end));
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
      if (!words_.empty() && !heading()) row();
    }
    leave();
    finish();
    return std::move(run_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& cure) const {
    throw InputError({file_, line_, 0}, what, cure);
  }

  void split(std::string_view line) {
    words_.clear();
    closed_.clear();
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
      words_.push_back(line.substr(at, end - at));
      at = end;
    }
    int letters = 0;
    for (const std::string_view word : words_)
      if (letters += word.size() == 1 && word[0] >= 'A' && word[0] <= 'Z'; true) closed_ += word;
    spaced_ = letters >= 5;
  }
  bool says(std::string_view text) const { return closed_.find(text) != std::string::npos; }

  /// Headings are written in spaced letters; whatever heading comes ends the table before it.
  bool heading() {
    if (says("FATALMESSAGE") || says("FATALERROR"))
      fail("the run ended with a fatal message", "Mend the deck and run it again");
    if (!spaced_) return false;
    leave();
    table_ = Table::none;
    if (says("COMPLEXEIGEN")) fail("these are complex modes", "Run SOL 103, real normal modes of the clamped part");
    if (says("REALEIGENVALUES")) table_ = Table::eigenvalues;
    if (says("WEIGHTGENERATOR")) {
      table_ = Table::mass;
      mass_rows_ = 0;
    }
    if (says("REALEIGENVECTORNO")) {
      const auto number = whole(words_.back());
      if (!number) fail("an eigenvector without its number", "Write the file again: it is cut off");
      mode_ = *number;
      table_ = Table::shape;
    }
    return true;
  }

  /// The six rows of MO must be there when the table ends.
  void leave() const {
    if (table_ == Table::mass && mass_rows_ > 0 && mass_rows_ < 6)
      fail(fmt::format("{} of 6 rows of the weight generator's mass", mass_rows_),
           "Write the file again: it is cut off");
  }

  void row() {
    if (says("PAGE")) return;
    if (table_ == Table::eigenvalues) eigenvalue();
    if (table_ == Table::shape) shape();
    if (table_ == Table::mass) mass();
  }

  // MODE, ORDER, EIGENVALUE, RADIANS, CYCLES, GENERALIZED MASS, GENERALIZED STIFFNESS
  void eigenvalue() {
    const auto number = whole(words_[0]);
    if (!number || words_.size() < 2 || !whole(words_[1])) return;
    std::vector<double> v;
    for (std::size_t i = 2; i < words_.size(); ++i)
      if (const auto x = real(words_[i])) v.push_back(*x);
    if (v.size() != 5 || words_.size() != 7)
      fail(fmt::format("mode {} has {} of 5 numbers", *number, v.size()), "Write the file again: the line is cut off");
    if (!(v[0] > 0.0))
      fail(fmt::format("mode {} has the eigenvalue {:g}", *number, v[0]),
           "A clamped part has no modes without stiffness: hold the parent port in all six directions");
    if (!(v[3] > 0.0)) fail(fmt::format("mode {} has the generalized mass {:g}", *number, v[3]), "It must be positive");
    const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-4 * std::abs(b); };
    if (differ(v[1] * v[1], v[0]) || differ(v[2] * 6.283185307179586, v[1]) || differ(v[3] * v[0], v[4]))
      fail(fmt::format("eigenvalue, radians, cycles, mass and stiffness of mode {} contradict each other", *number),
           "Write the file again");
    const auto [old, fresh] = run_.modes.emplace(*number, ModalRow{v[0], v[3]});
    if (!fresh && (old->second.lambda != v[0] || old->second.generalized_mass != v[3]))
      fail(fmt::format("mode {} is given twice", *number), "Leave one subcase in the file");
  }

  void shape() {
    const auto grid = whole(words_[0]);
    if (!grid || words_.size() < 3 || words_[1].size() != 1) return;
    if (words_[1] == "S") return;
    if (words_[1] != "G")
      fail(fmt::format("point {} is of type {}, not a grid", *grid, words_[1]), "Print grids only (G)");
    if (words_.size() != 8)
      fail(fmt::format("grid {} has {} of 6 numbers", *grid, words_.size() - 2),
           "Write the file again: the line is cut off");
    Eigen::Matrix<double, 6, 1> u;
    for (int k = 0; k < 6; ++k) {
      const std::string_view word = words_[static_cast<std::size_t>(k) + 2];
      const auto x = real(word);
      if (!x) fail(fmt::format("'{}' of grid {} is not a number", word, *grid), "Write the file again");
      u[k] = *x;
      run_.digits = std::max(run_.digits, significant(word));
    }
    if (!run_.shapes[mode_].emplace(*grid, u).second)
      fail(fmt::format("grid {} of mode {} is given twice", *grid, mode_), "Leave one subcase in the file");
  }

  void mass() {
    if (says("REFERENCEPOINT="))
      if (const auto point = whole(words_.back())) run_.mass_point = *point;
    if (mass_rows_ == 6 || words_.front() != "*" || words_.size() != 8) return;
    if (!run_.mass) run_.mass = Mat6::Zero();
    for (int k = 0; k < 6; ++k) {
      const auto x = real(words_[static_cast<std::size_t>(k) + 1]);
      if (!x) fail("the weight generator's mass holds what is not a number", "Write the file again");
      (*run_.mass)(mass_rows_, k) = *x;
    }
    ++mass_rows_;
  }

  void finish() const {
    const auto whole_file = [&](const std::string& what, const std::string& cure) {
      throw InputError({file_}, what, cure);
    };
    if (run_.modes.empty()) whole_file("there is no table of real eigenvalues", "Run SOL 103");
    if (run_.shapes.empty()) whole_file("there are no eigenvectors", "Ask for them: VECTOR = ALL in the case control");
    long expected = 1;
    for (const auto& [number, row] : run_.modes)
      if (number != expected++) whole_file(fmt::format("mode {} is missing", expected - 1), "Print all modes");
    expected = 1;
    for (const auto& [number, shape] : run_.shapes) {
      if (number != expected++)
        whole_file(fmt::format("eigenvector {} is missing", expected - 1), "Print all from 1 on");
      if (!run_.modes.contains(number))
        whole_file(fmt::format("eigenvector {} has no eigenvalue", number), "Print both tables");
      if (shape.size() != run_.shapes.begin()->second.size())
        whole_file(fmt::format("eigenvector {} has {} grids, the first one {}", number, shape.size(),
                               run_.shapes.begin()->second.size()),
                   "Write the file again: it is cut off");
    }
  }

  std::string file_;
  MappedFile mapped_;
  long line_ = 0, mode_ = 0;
  int mass_rows_ = 0;
  std::vector<std::string_view> words_;
  std::string closed_;  ///< the line without blanks
  bool spaced_ = false;
  Table table_ = Table::none;
  ModalRun run_;
};

}  // namespace

ModalRun read_f06(const std::filesystem::path& path) { return Reader(path).read(); }

}  // namespace tenon::fem
