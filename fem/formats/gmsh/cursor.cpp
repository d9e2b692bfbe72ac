#include "fem/formats/gmsh/cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "fem/error.hpp"

namespace tenon::fem::gmsh {
namespace {

constexpr bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
constexpr bool white(char c) { return blank(c) || c == '\n'; }

/// A number is over where white space or the file's end follows.
bool ends_number(const char* p, const char* end) { return p == end || white(*p); }

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 24;
  std::string out = "'";
  for (const char c : text.substr(0, longest))
    out += c >= ' ' && c <= '~' ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return out + (text.size() > longest ? "...'" : "'");
}

Cursor::Cursor(std::string file, std::string_view bytes, const MappedFile* pages)
    : file_(std::move(file)),
      begin_(bytes.data()),
      at_(bytes.data()),
      end_(bytes.data() + bytes.size()),
      pages_(pages),
      handed_back_(bytes.data()) {}

void Cursor::skip_white() {
  while (at_ != end_ && white(*at_)) ++at_;
}

void Cursor::skip_blanks() {
  while (at_ != end_ && blank(*at_)) ++at_;
}

std::string_view Cursor::word() {
  skip_blanks();
  const char* const first = at_;
  while (at_ != end_ && !white(*at_)) ++at_;
  return {first, static_cast<std::size_t>(at_ - first)};
}

std::string_view Cursor::line() {
  const char* const first = at_;
  const void* const newline = std::memchr(at_, '\n', remaining());
  const char* last = newline ? static_cast<const char*>(newline) : end_;
  at_ = newline ? last + 1 : end_;
  while (last != first && blank(last[-1])) --last;
  return {first, static_cast<std::size_t>(last - first)};
}

void Cursor::end_line() {
  skip_blanks();
  if (at_ == end_) return;
  if (*at_ != '\n') fail_expected("the end of the line");
  ++at_;
}

bool Cursor::skip_past_line(std::string_view text) {
  const std::string_view all(begin_, size());
  for (std::size_t found = all.find(text, offset()); found != std::string_view::npos;
       found = all.find(text, found + 1)) {
    const char* after = begin_ + found + text.size();
    while (after != end_ && blank(*after)) ++after;
    if ((found == 0 || all[found - 1] == '\n' || binary) && (after == end_ || *after == '\n')) {
      at_ = after == end_ ? end_ : after + 1;
      return true;
    }
  }
  return false;
}

void Cursor::raw(void* target, std::size_t n, const char* what) {
  if (remaining() < n)
    fail(size(), fmt::format("the file ends, expected {} ({} bytes, {} left)", what, n, remaining()));
  std::memcpy(target, at_, n);
  at_ += n;
}

void Cursor::fail(std::size_t offset, const std::string& what, const std::string& cure) const {
  const std::string where = section.empty() ? std::string() : fmt::format("in ${}: ", section);
  const std::string& advice =
      cure.empty() ? "The file is damaged or was cut short: write it again (in Gmsh: File > Export, or gmsh -save)"
                   : cure;
  if (binary) throw InputError({file_}, fmt::format("byte offset {}: {}{}", offset, where, what), advice);
  const char* const fault = begin_ + std::min(offset, size());
  const auto line = 1 + std::count(begin_, fault, '\n');
  const char* start = fault;
  while (start != begin_ && start[-1] != '\n') --start;
  throw InputError({file_, static_cast<long>(line), static_cast<long>(fault - start) + 1}, where + what, advice);
}

void Cursor::fail_expected(const std::string& expected, const std::string& cure) const {
  Cursor here = *this;
  here.skip_blanks();
  const std::size_t offset = here.offset();
  std::string found = "the end of the file";
  if (here.remaining() > 0) {
    const std::string_view next = here.word();
    found = next.empty() ? "the end of the line" : quoted(next);
  }
  fail(offset, fmt::format("found {}, expected {}", found, expected), cure);
}

void TextFields::begin_record(std::int64_t i, std::int64_t n, const char* things) {
  cursor_.hand_back();
  cursor_.skip_white();
  if (cursor_.remaining() == 0 || *cursor_.at() == '$')
    cursor_.fail_expected(fmt::format("{} {} of {}", things, i + 1, n));
}

std::int64_t TextFields::whole(const char* what) {
  cursor_.skip_blanks();
  start_ = cursor_.offset();
  const char* const first = cursor_.at();
  std::int64_t value = 0;
  const auto [last, error] = std::from_chars(first, cursor_.end(), value);
  if (error != std::errc() || !ends_number(last, cursor_.end()))
    cursor_.fail_expected(fmt::format("{} (a whole number)", what));
  cursor_.move_to(last);
  return value;
}

int TextFields::integer(const char* what) {
  const std::int64_t value = whole(what);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    cursor_.fail(start_, fmt::format("found {}, expected {} (a 4-byte whole number)", value, what));
  return static_cast<int>(value);
}

std::int64_t TextFields::count(const char* what) {
  const std::int64_t value = whole(what);
  if (value < 0) cursor_.fail(start_, fmt::format("found {}, expected {} (not negative)", value, what));
  return value;
}

double TextFields::real(const char* what) {
  cursor_.skip_blanks();
  start_ = cursor_.offset();
  const char* const first = cursor_.at();
  double value = 0.0;
  auto [last, error] = std::from_chars(first, cursor_.end(), value);
  if (error == std::errc::result_out_of_range)  // underflow is zero, overflow is refused below
    value = std::strtod(std::string(first, last).c_str(), nullptr);
  else if (error != std::errc())
    cursor_.fail_expected(fmt::format("{} (a number)", what));
  if (!ends_number(last, cursor_.end()) || !std::isfinite(value))
    cursor_.fail_expected(fmt::format("{} (a finite number)", what));
  cursor_.move_to(last);
  return value;
}

void BinaryFields::begin_record(std::int64_t i, std::int64_t n, const char* things) {
  cursor_.hand_back();
  if (cursor_.remaining() == 0) cursor_.fail_expected(fmt::format("{} {} of {}", things, i + 1, n));
}

template <class T>
T BinaryFields::load(const char* what) {
  start_ = cursor_.offset();
  char bytes[sizeof(T)];
  cursor_.raw(bytes, sizeof(T), what);
  if (cursor_.swapped) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

int BinaryFields::integer(const char* what) { return load<std::int32_t>(what); }

std::int64_t BinaryFields::count(const char* what) {
  const std::int64_t value = cursor_.size_width == 4 ? load<std::int32_t>(what) : load<std::int64_t>(what);
  if (value < 0) cursor_.fail(start_, fmt::format("found {}, expected {} (not negative)", value, what));
  return value;
}

double BinaryFields::real(const char* what) {
  const double value = load<double>(what);
  if (!std::isfinite(value)) cursor_.fail(start_, fmt::format("found {}, expected {} (a finite number)", value, what));
  return value;
}

}  // namespace tenon::fem::gmsh
