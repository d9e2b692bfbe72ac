#include "fem/formats/matrices/number_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/error.hpp"
#include "fem/formats/nastran/cards.hpp"

namespace tenon::fem::matrices {
namespace {

bool separates(char c) { return c == ' ' || c == ',' || c == '\t'; }

constexpr std::size_t piece = 1 << 22;  // bytes after which pages are handed back

}  // namespace

NumberLines::NumberLines(const std::filesystem::path& path) : file_(path.string()), pages_(path) {
  rest_ = pages_.bytes();
  if (rest_.empty()) throw InputError({file_}, "the file is empty", "Let the program that writes it run to its end");
  if (rest_.back() != '\n')
    throw InputError({file_}, "the last line has no line end, so the file is cut off",
                     "Let the program that writes it run to its end");
}

std::size_t NumberLines::count() const {
  std::size_t lines = 0;
  for (std::size_t at = 0; at < pages_.bytes().size(); at += piece) {
    const std::string_view part = pages_.bytes().substr(at, piece);
    lines += static_cast<std::size_t>(std::ranges::count(part, '\n'));
    pages_.release(at + part.size());
  }
  return lines;
}

bool NumberLines::next() {
  if (const std::size_t read = pages_.bytes().size() - rest_.size(); read > handed_back_ + piece)
    pages_.release(handed_back_ = read);
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    start_ = rest_.data();
    line_ = nastran::trim(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    column_ = 0;
    left_ = line_;
    if (!line_.empty()) return true;
  }
  return false;
}

std::string_view NumberLines::word(const char* what) {
  const auto first = static_cast<std::size_t>(std::ranges::find_if_not(left_, separates) - left_.begin());
  if (first == left_.size()) {
    column_ = line_.empty() ? 0 : static_cast<long>(line_.data() + line_.size() - start_) + 1;
    fail_expected("the end of the line", what);
  }
  left_.remove_prefix(first);
  const auto length = static_cast<std::size_t>(std::ranges::find_if(left_, separates) - left_.begin());
  const std::string_view result = left_.substr(0, length);
  left_.remove_prefix(result.size());
  column_ = static_cast<long>(result.data() - start_) + 1;
  return result;
}

long NumberLines::integer(const char* what) {
  const std::string_view text = word(what);
  if (const auto value = nastran::parse_integer(text)) return *value;
  fail_expected(fmt::format("'{}'", text.substr(0, 40)), what);
}

double NumberLines::real(const char* what) {
  const std::string_view text = word(what);
  if (const auto value = nastran::parse_real(text)) return *value;
  fail_expected(fmt::format("'{}'", text.substr(0, 40)), what);
}

void NumberLines::end_line() {
  if (std::ranges::all_of(left_, separates)) return;
  fail_expected(fmt::format("'{}'", word("").substr(0, 40)), "the end of the line");
}

void NumberLines::fail(const std::string& what, const std::string& cure) const {
  throw InputError({file_, number_, column_}, what, cure);
}

void NumberLines::fail_expected(std::string_view found, const char* what) const {
  fail(fmt::format("found {}, expected {}", found, what),
       "The file may be damaged or of another format; write it again");
}

}  // namespace tenon::fem::matrices
