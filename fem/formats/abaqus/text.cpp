#include "fem/formats/abaqus/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tenon::fem::abaqus {
namespace {

namespace fs = std::filesystem;

constexpr bool white(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view trim(std::string_view text) {
  while (!text.empty() && white(text.front())) text.remove_prefix(1);
  while (!text.empty() && white(text.back())) text.remove_suffix(1);
  return text;
}

/// Names of two words and more, which CalculiX reads without their blanks as well.
constexpr std::array words_of_names{"ANALYTICAL SURFACE",
                                    "BASE MOTION",
                                    "BEAM GENERAL SECTION",
                                    "BEAM SECTION",
                                    "COMPLEX FREQUENCY",
                                    "COMPLEX STIFFNESS",
                                    "CONTACT FILE",
                                    "CONTACT OUTPUT",
                                    "CONTACT PRINT",
                                    "COUPLED TEMPERATURE-DISPLACEMENT",
                                    "CYCLIC HARDENING",
                                    "DEFORMATION PLASTICITY",
                                    "EL FILE",
                                    "EL PRINT",
                                    "ELEMENT OUTPUT",
                                    "END ASSEMBLY",
                                    "END INSTANCE",
                                    "END PART",
                                    "END STEP",
                                    "FIELD OUTPUT",
                                    "FILE FORMAT",
                                    "FLUID CONSTANTS",
                                    "FLUID SECTION",
                                    "GASKET SECTION",
                                    "HEAT TRANSFER",
                                    "HISTORY OUTPUT",
                                    "INFLUENCE RADIUS",
                                    "INITIAL CONDITIONS",
                                    "MATRIX GENERATE",
                                    "MATRIX OUTPUT",
                                    "MEMBRANE SECTION",
                                    "MODAL DAMPING",
                                    "MODAL DYNAMIC",
                                    "NODAL THICKNESS",
                                    "NODE FILE",
                                    "NODE OUTPUT",
                                    "NODE PRINT",
                                    "PHYSICAL CONSTANTS",
                                    "PIN NSET",
                                    "RANDOM RESPONSE",
                                    "REF NODE",
                                    "RIGID BODY",
                                    "ROT NODE",
                                    "ROTARY INERTIA",
                                    "SECTION CONTROLS",
                                    "SECTION INTEGRATION",
                                    "SECTION PRINT",
                                    "SHELL SECTION",
                                    "SOLID SECTION",
                                    "SPECIFIC GAS",
                                    "SPECIFIC HEAT",
                                    "STEADY STATE DYNAMICS",
                                    "SURFACE SECTION",
                                    "SYSTEM OF UNITS",
                                    "THICKNESS MODULUS",
                                    "TIE NSET",
                                    "TIME POINTS",
                                    "UNCOUPLED TEMPERATURE-DISPLACEMENT",
                                    "VALUES AT INFINITY",
                                    "WEIGHTING METHOD"};

/// Upper case, runs of blanks as one: "shell   section" and "SHELLSECTION" → "SHELL SECTION".
std::string keyword_name(std::string_view text) {
  std::string name;
  for (const char c : trim(text)) {
    if (white(c) && !name.empty() && name.back() == ' ') continue;
    name += white(c) ? ' ' : c;
  }
  name = upper(name);
  if (name.find(' ') != std::string::npos) return name;
  const auto without_blanks = [](std::string words) {
    std::erase(words, ' ');
    return words;
  };
  const auto found = std::ranges::find(words_of_names, name, without_blanks);
  return found == words_of_names.end() ? name : *found;
}

/// Parts between commas that stand outside quotes.
std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] == '"') quoted = !quoted;
    if (i < text.size() && (text[i] != ',' || quoted)) continue;
    parts.push_back(trim(text.substr(start, i - start)));
    start = i + 1;
  }
  return parts;
}

std::string unquoted(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// The next line of `rest`, without its end.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

bool is_comment(std::string_view statement) { return statement.starts_with("**"); }

void require_text(std::string_view content, const std::string& file) {
  const auto odd = [](char c) { return c >= 0 && c < 32 && !white(c) && c != 26; };
  bool any = false;
  for (const char c : content) any |= odd(c);
  if (!any) return;
  const auto bad = std::ranges::find_if(content, odd);
  throw InputError(
      {file, 1 + std::count(content.begin(), bad, '\n'), 0},
      fmt::format("found the byte {:#04x}, expected text: this is not an .inp file", static_cast<unsigned char>(*bad)),
      "Give the input deck as text, not a result file");
}

class Reader {
 public:
  explicit Reader(const fs::path& path) : folder_(path.parent_path()) { file(path, {path.string(), 0, 0}); }

  Text text() {
    if (text_.blocks.empty())
      throw InputError({text_.files.front().name, 0, 0}, "the file holds no keyword (a line that begins with *)",
                       "Check that it is the right file");
    return std::move(text_);
  }

 private:
  void file(const fs::path& path, const Place& asked_at);
  void include(const Block& block, const fs::path& from);

  Text text_;
  fs::path folder_;
  std::vector<fs::path> open_;
};

void Reader::file(const fs::path& path, const Place& asked_at) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  if (std::ranges::find(open_, canonical) != open_.end())
    throw InputError(asked_at, fmt::format("'{}' includes itself", path.string()),
                     "Remove the *INCLUDE that closes the circle");
  if (!open_.empty() && !fs::is_regular_file(path, error))
    throw InputError(asked_at, fmt::format("the included file '{}' does not exist or is no file", path.string()),
                     "Check the name; it is relative to the deck's folder");
  text_.files.push_back({path.string(), MappedFile(path)});
  const Source& source = text_.files.back();
  std::string_view rest = without_byte_order_mark(source.pages.bytes());
  if (rest.empty()) throw InputError({source.name}, "the file is empty", "Write it again");
  require_text(rest, source.name);
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  open_.push_back(canonical);

  long line = 0;
  Piece data{&source, {}, 0};
  const auto close = [&] {  // the data lines read since the last keyword go to it
    if (!data.text.empty()) text_.blocks.back().data.push_back(data);
    data.text = {};
  };
  while (!rest.empty()) {
    const std::string_view raw = take_line(rest);
    ++line;
    const std::string_view statement = trim(raw);
    if (statement.empty() || is_comment(statement)) continue;
    if (statement.front() != '*') {
      if (text_.blocks.empty())
        throw InputError({source.name, line, 1}, fmt::format("found '{}' before any keyword", statement.substr(0, 24)),
                         "An .inp file begins with a keyword such as *HEADING or *NODE");
      if (data.text.empty()) {
        data.text = raw;
        data.first_line = line;
      }
      data.text = {data.text.data(), static_cast<std::size_t>(raw.data() + raw.size() - data.text.data())};
      continue;
    }
    close();
    Block block;
    block.place = {source.name, line, 0};
    std::string whole(statement.substr(1));
    while (!whole.empty() && whole.back() == ',' && !rest.empty()) {  // goes on in the next line
      whole += trim(take_line(rest));
      ++line;
    }
    const std::vector<std::string_view> parts = split(whole);
    block.keyword = keyword_name(parts.front());
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const std::size_t equals = parts[i].find('=');
      if (parts[i].empty()) continue;
      const std::string name = keyword_name(parts[i].substr(0, equals));
      const std::string value =
          equals == std::string_view::npos ? std::string() : unquoted(trim(parts[i].substr(equals + 1)));
      if (!block.parameters.emplace(name, value).second)
        block.refuse(fmt::format("*{} gives {} twice", block.keyword, name), "Keep one of the two");
    }
    if (block.keyword.empty())
      block.refuse("found a * without a keyword", "Write the keyword behind it, or ** for a comment");
    if (block.keyword == "INCLUDE")
      include(block, path);
    else
      text_.blocks.push_back(std::move(block));
  }
  close();
  open_.pop_back();
}

void Reader::include(const Block& block, const fs::path& from) {
  const fs::path name = block.value("INPUT");
  if (name.empty()) block.refuse("*INCLUDE names no file", "Write *INCLUDE, INPUT=file");
  std::error_code ignored;
  const fs::path beside_deck = folder_ / name, beside = from.parent_path() / name;
  file(fs::exists(beside_deck, ignored) || !fs::exists(beside, ignored) ? beside_deck : beside, block.place);
}

}  // namespace

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

std::optional<long> parse_integer(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  long value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> parse_real(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && rest == text.data() + text.size() && std::isfinite(value)) return value;
  if (const std::size_t d = text.find_first_of("dD"); d != std::string_view::npos && d > 0) {  // 1.5D3
    std::string with_e(text);
    with_e[d] = 'e';
    return with_e.find_first_of("dD") == std::string::npos ? parse_real(with_e) : std::nullopt;
  }
  return std::nullopt;
}

std::string Block::value(const std::string& name) const {
  const auto found = parameters.find(name);
  return found == parameters.end() ? std::string() : found->second;
}

std::string Block::upper_value(const std::string& name) const { return upper(value(name)); }

void Block::refuse(const std::string& what, const std::string& cure) const { throw InputError(place, what, cure); }

bool DataLines::next() {
  for (; piece_ < block_->data.size(); ++piece_, at_ = 0) {
    const Piece& piece = block_->data[piece_];
    if (at_ == 0) line_ = piece.first_line - 1;
    while (at_ < piece.text.size()) {
      std::string_view rest = piece.text.substr(at_);
      text_ = take_line(rest);
      at_ = piece.text.size() - rest.size();
      ++line_;
      const std::string_view statement = trim(text_);
      if (statement.empty() || is_comment(statement)) continue;
      fields_.clear();
      for (std::string_view line = statement;;) {
        const std::size_t comma = line.find(',');
        fields_.push_back(trim(line.substr(0, comma)));
        if (comma == std::string_view::npos) break;
        line.remove_prefix(comma + 1);
      }
      open_ = fields_.size() > 1 && fields_.back().empty();
      if (open_) fields_.pop_back();
      return true;
    }
  }
  return false;
}

bool DataLines::blank_follows() const {
  if (piece_ >= block_->data.size() || at_ >= block_->data[piece_].text.size()) return false;
  std::string_view rest = block_->data[piece_].text.substr(at_);
  return trim(take_line(rest)).empty();
}

Place DataLines::place(std::size_t i) const {
  const std::string& file = block_->data[std::min(piece_, block_->data.size() - 1)].source->name;
  const std::string_view field = at(i);
  return {file, line_, field.empty() ? 0 : static_cast<long>(field.data() - text_.data()) + 1};
}

void DataLines::fail(std::size_t i, const std::string& expected) const {
  refuse(i,
         fmt::format("*{}: found {}, expected {}", block_->keyword,
                     at(i).empty() ? "nothing" : fmt::format("'{}'", at(i).substr(0, 24)), expected),
         "Correct the data line");
}

void DataLines::refuse(std::size_t i, const std::string& what, const std::string& cure) const {
  throw InputError(place(i), what, cure);
}

long DataLines::integer(std::size_t i, const char* what) const {
  if (const auto value = parse_integer(at(i))) return *value;
  fail(i, fmt::format("{} (a whole number)", what));
}

double DataLines::real(std::size_t i, const char* what) const {
  if (const auto value = parse_real(at(i))) return *value;
  fail(i, fmt::format("{} (a number)", what));
}

double DataLines::real(std::size_t i, const char* what, double otherwise) const {
  return at(i).empty() ? otherwise : real(i, what);
}

double DataLines::positive(std::size_t i, const char* what) const {
  const double value = real(i, what);
  if (!(value > 0.0)) fail(i, fmt::format("{} (a number above zero)", what));
  return value;
}

Text read_text(const fs::path& path) { return Reader(path).text(); }

}  // namespace tenon::fem::abaqus
