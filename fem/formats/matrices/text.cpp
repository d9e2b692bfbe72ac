#include "fem/formats/matrices/text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "fem/error.hpp"

namespace tenon::fem::market {

Text::Text(const std::filesystem::path& path, std::string cure)
    : pages_(path), cure_(std::move(cure)), cursor_(path.string(), pages_.bytes(), &pages_) {
  if (size() == 0) throw InputError({path.string()}, "the file is empty", cure_);
  if (pages_.bytes().back() != '\n') fail(size(), "the last line has no line end, so the file may be cut off");
}

bool Text::line_ends(char comment) {
  cursor_.skip_blanks();
  return cursor_.remaining() == 0 || *cursor_.at() == '\n' || *cursor_.at() == comment;
}

bool Text::next_line(char comment) {
  cursor_.hand_back();
  for (;;) {
    cursor_.skip_white();
    if (cursor_.remaining() == 0) return false;
    if (*cursor_.at() != comment) return true;
    cursor_.line();
  }
}

std::string_view Text::word(const char* what) {
  cursor_.skip_blanks();
  start_ = cursor_.offset();
  const std::string_view text = cursor_.word();
  if (text.empty()) fail(start_, fmt::format("found the end of the line, expected {}", what));
  return text;
}

long Text::whole(const char* what, long least, long most) {
  const std::string_view text = word(what);
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most)
    fail(start_,
         fmt::format("found {}, expected {} (a whole number, {} to {})", gmsh::quoted(text), what, least, most));
  return value;
}

double Text::real(const char* what) {
  std::string_view text = word(what);
  const std::string_view all = text;
  if (text.front() == '+' && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole_word = end == text.data() + text.size();
  if (error == std::errc::result_out_of_range && whole_word)
    value = std::strtod(std::string(text).c_str(), nullptr);  // underflow is zero, overflow is refused below
  else if (error != std::errc())
    value = NAN;
  if (!whole_word || !std::isfinite(value))
    fail(start_, fmt::format("found {}, expected {} (a finite number)", gmsh::quoted(all), what));
  return value;
}

void Text::end_line(char comment) {
  if (!line_ends(comment)) {
    start_ = cursor_.offset();
    fail(start_, fmt::format("found {}, expected the end of the line", gmsh::quoted(cursor_.word())));
  }
  cursor_.line();
}

void Text::fail(std::size_t at, const std::string& what, const std::string& cure) const {
  cursor_.fail(at, what, cure.empty() ? cure_ : cure);
}

}  // namespace tenon::fem::market
