#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "fem/formats/nastran/cards.hpp"

namespace tenon::fem::nastran {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

std::size_t skip_digits(std::string_view text, std::size_t from) {
  while (from < text.size() && digit(text[from])) ++from;
  return from;
}

bool sign(char c) { return c == '+' || c == '-'; }

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && white(text.front())) text.remove_prefix(1);
  while (!text.empty() && white(text.back())) text.remove_suffix(1);
  return text;
}

std::string upper(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

// [sign] digits [. digits] [ (E|D) [sign] digits | sign digits ], with at least one digit in the mantissa
std::optional<double> parse_real(std::string_view text) {
  double plain = 0.0;  // the usual notation needs no copy; "nan" and "inf" are no numbers
  if (const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), plain);
      error == std::errc{} && end == text.data() + text.size() && std::isfinite(plain))
    return plain;

  std::size_t i = !text.empty() && sign(text[0]) ? 1 : 0;
  const std::size_t start = i;
  i = skip_digits(text, i);
  std::size_t mantissa_digits = i - start;
  if (i < text.size() && text[i] == '.') {
    const std::size_t fraction = i + 1;
    i = skip_digits(text, fraction);
    mantissa_digits += i - fraction;
  }
  if (mantissa_digits == 0) return std::nullopt;

  const std::size_t first = text[0] == '+' ? 1 : 0;
  double value = 0.0;
  if (i == text.size()) {  // the common form is read in place
    const auto [rest, error] = std::from_chars(text.data() + first, text.data() + i, value);
    if (error != std::errc{} || rest != text.data() + i) return std::nullopt;
    return value;
  }
  std::string normal(text.substr(first, i - first));
  {
    const bool letter = text[i] == 'E' || text[i] == 'e' || text[i] == 'D' || text[i] == 'd';
    if (!letter && !sign(text[i])) return std::nullopt;
    if (letter) ++i;
    normal += 'e';
    if (i < text.size() && sign(text[i])) {
      if (text[i] == '-') normal += '-';
      ++i;
    }
    const std::size_t end = skip_digits(text, i);
    if (end == i || end != text.size()) return std::nullopt;
    normal.append(text.substr(i));
  }
  const auto [rest, error] = std::from_chars(normal.data(), normal.data() + normal.size(), value);
  if (error != std::errc{} || rest != normal.data() + normal.size()) return std::nullopt;
  return value;
}

std::optional<long> parse_integer(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && digit(text[1])) text.remove_prefix(1);
  long value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Of a field that the card has.
Field Card::where(int field) const {
  const auto f = static_cast<std::size_t>(field);
  if (span_->in_columns == 0) return text_->fields[span_->first_field + f - 1];
  return {static_cast<std::uint32_t>(8 * f),
          static_cast<std::uint32_t>(std::min<std::size_t>(8, span_->first_field - 8 * f))};
}

std::string_view Card::at(int field) const {
  if (field < 1 || field > size()) return {};
  const Field f = where(field);
  return trim({span_->begin + f.offset, f.size});
}

Place Card::place(int field) const {
  if (field < 1 || field > size()) return place();
  const SourceFile& file = text_->files[span_->file];
  const Field f = where(field);
  const std::string_view before(span_->begin, f.offset);
  const std::size_t line_start = before.rfind('\n');  // a card begins with its line
  const std::size_t column = line_start == std::string_view::npos ? f.offset : f.offset - line_start - 1;
  return {file.name, static_cast<long>(span_->line + std::count(before.begin(), before.end(), '\n')),
          static_cast<long>(column) + 1};
}

void Card::fail(int field, const char* label, const std::string& expected) const {
  const std::string found = blank(field) ? "is blank" : "is '" + std::string(at(field)) + "'";
  throw InputError(
      place(field), name() + " field " + label + " " + found + ", expected " + expected,
      "Correct the field; a fixed field is 8 columns wide (16 on cards with a star), and a shifted entry reads "
      "as its neighbour's");
}

void Card::refuse(int field, const std::string& what, const std::string& cure) const {
  throw InputError(place(field), name() + " " + what, cure);
}

double Card::real(int field, const char* label) const {
  if (const auto value = parse_real(at(field))) return *value;
  fail(field, label, "a real number");
}

double Card::real(int field, const char* label, double otherwise) const {
  return blank(field) ? otherwise : real(field, label);
}

double Card::positive(int field, const char* label) const {
  const double value = real(field, label);
  if (!(value > 0.0)) fail(field, label, "a number above zero");
  return value;
}

double Card::non_negative(int field, const char* label, double otherwise) const {
  const double value = real(field, label, otherwise);
  if (!(value >= 0.0)) fail(field, label, "a number that is not negative");
  return value;
}

long Card::integer(int field, const char* label) const {
  if (const auto value = parse_integer(at(field))) return *value;
  fail(field, label, "an integer");
}

long Card::integer(int field, const char* label, long otherwise) const {
  return blank(field) ? otherwise : integer(field, label);
}

long Card::id(int field, const char* label) const {
  const auto value = parse_integer(at(field));
  if (!value || *value <= 0) fail(field, label, "an integer above zero");
  return *value;
}

long Card::id(int field, const char* label, long otherwise) const {
  return blank(field) ? otherwise : id(field, label);
}

unsigned Card::components(int field, const char* label) const {
  unsigned bits = 0;
  if (at(field) == "0") return bits;
  for (const char c : at(field)) {
    if (c < '1' || c > '6') fail(field, label, "directions as digits 1 to 6");
    bits |= 1U << (c - '1');
  }
  return bits;
}

bool Card::same_as(const Card& other) const {
  if (name() != other.name()) return false;
  for (int i = 1; i <= std::max(size(), other.size()); ++i) {
    if (at(i) == other.at(i)) continue;
    const auto a = parse_real(at(i)), b = parse_real(other.at(i));
    if (!(a && b && *a == *b) && upper(at(i)) != upper(other.at(i))) return false;
  }
  return true;
}

}  // namespace tenon::fem::nastran
