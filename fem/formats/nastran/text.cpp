#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "fem/formats/nastran/cards.hpp"

namespace tenon::fem::nastran {
namespace {

namespace fs = std::filesystem;

constexpr int columns_of_name = 8, columns_of_line = 80;

/// `word` is upper case.
bool starts_with_word(std::string_view line, std::string_view word) {
  const auto same = [](char a, char b) { return (a >= 'a' && a <= 'z' ? a - 'a' + 'A' : a) == b; };
  if (line.size() < word.size() ||
      !std::equal(word.begin(), word.end(), line.begin(), [&](char b, char a) { return same(a, b); }))
    return false;
  return line.size() == word.size() || !std::isalnum(static_cast<unsigned char>(line[word.size()]));
}

/// "BEGIN BULK" in any spacing; what follows BULK is `rest`.
bool is_begin(std::string_view line, std::string* rest = nullptr) {
  if (!starts_with_word(line, "BEGIN")) return false;
  std::string_view tail = trim(line.substr(5));
  if (!tail.empty() && tail.front() == ',') tail = trim(tail.substr(1));
  if (starts_with_word(tail, "BULK")) tail = trim(tail.substr(4));
  if (rest) *rest = upper(tail);
  return true;
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('$')); }

std::string with_tabs_expanded(std::string_view text) {
  std::string wide;
  wide.reserve(text.size());
  std::size_t line_start = 0;
  for (const char c : text) {
    if (c == '\t')
      wide.append(columns_of_name - (wide.size() - line_start) % columns_of_name, ' ');
    else
      wide += c;
    if (c == '\n') line_start = wide.size();
  }
  return wide;
}

/// The name of a continuation mark: "+A1", "*A1" → "A1".
std::string_view mark_name(std::string_view mark) {
  if (!mark.empty() && (mark.front() == '+' || mark.front() == '*')) mark.remove_prefix(1);
  return trim(mark);
}

/// Refuses what is no text: control characters other than white space.
void require_text(std::string_view content, const std::string& file) {
  const auto odd = [](char c) { return c >= 0 && c < 32 && !(c >= '\t' && c <= '\r') && c != 26; };
  unsigned any = 0;
#pragma omp simd reduction(| : any)
  for (std::size_t i = 0; i < content.size(); ++i) any |= odd(content[i]) ? 1U : 0U;
  if (any == 0) return;
  const auto bad = std::ranges::find_if(content, odd);
  const long line = 1 + std::count(content.begin(), bad, '\n');
  throw InputError({file, line, 0},
                   fmt::format("found the byte {:#04x}, expected text: this is not a Nastran bulk data file",
                               static_cast<unsigned char>(*bad)),
                   "Give the deck as text (.bdf, .dat, .nas), not a result or database file");
}

/// Lines of one file by number.
struct Lines {
  std::string_view rest;
  int number = 0;

  bool next(std::string_view& line) {
    if (rest.empty()) return false;
    const std::size_t end = rest.find('\n');
    line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++number;
    return true;
  }
};

enum class Section { executive, case_control, bulk, done };

class Reader {
 public:
  explicit Reader(bool superelement) : superelement_(superelement) {}
  Text read(const fs::path& path) {
    deck_folder_ = path.parent_path();
    file(path, {path.string(), 0, 0});
    close_card();
    if (section_ == Section::executive || section_ == Section::case_control)
      throw InputError(text_.end, "the file ends before BEGIN BULK: no bulk data was found",
                       "The file may be cut off; give the whole deck, or bulk data alone without CEND");
    if (text_.cards.empty())
      throw InputError({path.string(), 0, 0}, "the file holds no bulk data card", "Check that it is the right file");
    return std::move(text_);
  }

 private:
  void file(const fs::path& path, const Place& asked_at);
  void include(std::string_view statement, Lines& lines);
  void case_line(std::string_view line, Lines& lines);
  void bulk_line(std::string_view line, Lines& lines);
  void free_fields(std::string_view line);
  void fixed_fields(std::string_view line);
  void add_columns(std::string_view line, int width);
  void begin_line(std::string_view name, std::string_view mark, int column);
  void add(std::string_view text, std::size_t column);
  void close_card();
  std::uint32_t name_index(std::string_view name);
  const SourceFile& source() const { return text_.files[file_]; }
  Place here(int column = 0) const { return {source().name, line_, column}; }
  /// BEGIN SUPER = n ahead of all cards, where one superelement is asked for.
  bool opens_superelement(std::string_view tail) const {
    return superelement_ && text_.cards.empty() && starts_with_word(tail, "SUPER");
  }

  Text text_;
  std::map<std::string, std::uint32_t> name_index_;
  Section section_ = Section::bulk;
  fs::path deck_folder_;
  std::vector<fs::path> open_files_;
  std::set<fs::path> seen_files_;
  std::size_t file_ = 0;
  int line_ = 0;
  const char* line_begin_ = nullptr;
  std::vector<std::string_view> parts_;  ///< of a line in free fields
  bool superelement_ = false;
  bool card_open_ = false;
  std::string_view columns_;  ///< the open card's line while that is all of it and its fields need no list
  std::string mark_;          ///< continuation mark that the open card's last line ended with
  bool large_ = false;
};

void Reader::file(const fs::path& path, const Place& asked_at) {
  std::error_code ignored;
  const fs::path canonical = fs::weakly_canonical(path, ignored);
  if (std::ranges::find(open_files_, canonical) != open_files_.end())
    throw InputError(asked_at, "'" + path.string() + "' includes itself", "Remove the INCLUDE that closes the circle");
  if (!seen_files_.insert(canonical).second)
    throw InputError(asked_at, "'" + path.string() + "' is included a second time, all its cards would be doubled",
                     "Remove one of the INCLUDE statements");
  if (std::error_code error; !open_files_.empty() && !fs::is_regular_file(path, error))
    throw InputError(asked_at, "the included file '" + path.string() + "' does not exist or is no file",
                     "Check the name; it is relative to the including file, else to the deck");
  const SourceFile& source = text_.files.emplace_back(path.string(), path);
  const std::string_view content = source.text();
  const std::size_t outer_file = file_;
  const int outer_line = line_;
  file_ = text_.files.size() - 1;
  const bool top = open_files_.empty();
  if (top) text_.cards.reserve(content.size() / 50);  // what is not used costs nothing
  open_files_.push_back(canonical);

  if (top) {  // which sections does the deck have?
    std::string_view line;
    for (Lines lines{content}; lines.next(line);) {
      const std::string_view statement = trim(without_comment(line));
      const bool cend = starts_with_word(statement, "CEND");
      if (!cend && !is_begin(statement)) continue;
      section_ = cend ? Section::executive : Section::case_control;
      text_.has_case_control = true;
      break;
    }
  }

  std::string_view line;
  std::size_t handed_back = 0;
  for (Lines lines{content}; section_ != Section::done && lines.next(line);) {
    line_ = lines.number;
    line_begin_ = line.data();
    const auto read = static_cast<std::size_t>(line.data() - content.data());
    if (read > handed_back + (1 << 22) && source.expanded.empty()) source.pages.release(handed_back = read);
    const std::string_view statement = trim(line);
    if (statement.empty() || statement.front() == '$') continue;
    if (section_ == Section::executive) {
      if (starts_with_word(statement, "CEND")) section_ = Section::case_control;
    } else if (section_ == Section::case_control) {
      case_line(statement, lines);
    } else {
      bulk_line(line, lines);
    }
  }
  text_.end = here();
  open_files_.pop_back();
  file_ = outer_file;
  line_ = outer_line;
}

// INCLUDE 'path', "path" or path; a quoted path may run over several lines
void Reader::include(std::string_view statement, Lines& lines) {
  const Place place = here();
  std::string_view tail = trim(statement.substr(7));
  if (!tail.empty() && tail.front() == '=') tail = trim(tail.substr(1));
  std::string name;
  if (!tail.empty() && (tail.front() == '\'' || tail.front() == '"')) {
    const char quote = tail.front();
    std::string_view piece = tail.substr(1);
    while (piece.find(quote) == std::string_view::npos) {
      name += trim(piece);
      if (!lines.next(piece))
        throw InputError(place, "INCLUDE opens a quote that is never closed", "Close the quote after the file name");
    }
    name += trim(piece.substr(0, piece.find(quote)));
  } else {
    name = std::string(trim(without_comment(tail)));
  }
  if (name.empty()) throw InputError(place, "INCLUDE names no file", "Write INCLUDE 'file name'");

  fs::path path(name);
  if (path.is_relative()) {
    std::error_code ignored;
    const fs::path beside = fs::path(here().file).parent_path() / name;
    path = fs::exists(beside, ignored) || !fs::exists(deck_folder_ / name, ignored) ? beside : deck_folder_ / name;
  }
  file(path, place);
}

void Reader::case_line(std::string_view line, Lines& lines) {
  if (starts_with_word(line, "INCLUDE")) return include(line, lines);
  std::string rest;
  if (is_begin(line, &rest)) {
    const std::string_view tail = trim(without_comment(rest));
    if (!tail.empty() && !opens_superelement(tail))
      throw InputError(here(),
                       fmt::format("found BEGIN BULK {}: parts and superelements in one file are not read", tail),
                       "Give each part as a deck of its own");
    section_ = Section::bulk;
    return;
  }
  const std::string_view statement = trim(without_comment(line));
  const bool title = starts_with_word(statement, "TITLE") || starts_with_word(statement, "LABEL") ||
                     starts_with_word(statement, "SUBTITLE");
  if (!statement.empty()) text_.case_control.push_back({title ? std::string(statement) : upper(statement), here()});
}

void Reader::bulk_line(std::string_view line, Lines& lines) {
  const std::string_view statement = trim(line);
  if (starts_with_word(statement, "INCLUDE")) {
    close_card();
    return include(statement, lines);
  }
  if (starts_with_word(statement, "ENDDATA")) {
    close_card();
    text_.ended = true;
    section_ = Section::done;
    return;
  }
  std::string rest;
  if (is_begin(statement, &rest)) {
    if (const std::string_view tail = trim(without_comment(rest)); !tail.empty() && !opens_superelement(tail))
      throw InputError(
          here(),
          "found " + upper(trim(without_comment(statement))) + ": parts and superelements in one file are not read",
          "Give each part as a deck of its own");
    return;
  }
  line = without_comment(line);
  while (!line.empty() && white(line.back())) line.remove_suffix(1);
  if (line.empty()) return;
  line.find(',') != std::string_view::npos ? free_fields(line) : fixed_fields(line);
}

void Reader::free_fields(std::string_view line) {
  const auto column = [&, start = line.data()](std::string_view part) {
    return static_cast<int>(part.data() - start) + 1;
  };
  std::vector<std::string_view>& parts = parts_;
  parts.clear();
  for (std::string_view rest = line;;) {
    const std::size_t comma = rest.find(',');
    parts.push_back(trim(rest.substr(0, comma)));
    if (parts.back().empty()) parts.back() = rest.substr(0, 0);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  const std::string_view name = parts[0];
  const std::size_t data = !name.empty() && (name.back() == '*' || name.front() == '*') ? 4 : 8;
  for (std::size_t i = data + 1; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    const bool mark = i == data + 1 && (parts[i].front() == '+' || parts[i].front() == '*') && !parse_real(parts[i]);
    if (!mark)
      throw InputError(here(column(parts[i])),
                       fmt::format("found '{}' after the {} data fields of a free-field line", parts[i], data),
                       "Go on in a continuation line that begins with a comma or a plus sign");
  }
  begin_line(name, parts.size() > data + 1 ? parts[data + 1] : std::string_view{}, column(name));
  for (std::size_t i = 1; i <= data; ++i) {
    if (i < parts.size())
      add(parts[i], static_cast<std::size_t>(column(parts[i])));
    else
      add({}, line.size());
  }
}

void Reader::fixed_fields(std::string_view line) {
  const auto part = [&](int from, int width) {
    return static_cast<std::size_t>(from) < line.size()
               ? line.substr(static_cast<std::size_t>(from), static_cast<std::size_t>(width))
               : std::string_view{};
  };
  const std::string_view name = trim(part(0, columns_of_name));
  const bool large = !name.empty() && (name.back() == '*' || name.front() == '*');
  begin_line(name, trim(part(columns_of_line - 8, 8)), 1);
  if (!large && line_begin_ == text_.cards.back().begin)
    columns_ = line;
  else
    add_columns(line, large ? 16 : 8);
}

void Reader::add_columns(std::string_view line, int width) {
  for (int from = columns_of_name; from < columns_of_line - 8; from += width) {
    const auto at = static_cast<std::size_t>(from);
    add(at < line.size() ? line.substr(at, static_cast<std::size_t>(width)) : std::string_view{}, at + 1);
  }
}

// Opens a card, or goes on with the open one when the name is blank or a continuation mark.
void Reader::begin_line(std::string_view name, std::string_view mark, int column) {
  const bool large = !name.empty() && (name.back() == '*' || name.front() == '*');
  const bool continues = name.empty() || name.front() == '+' || name.front() == '*';
  if (continues) {
    if (!card_open_)
      throw InputError(here(column), "found a continuation line without a card before it",
                       "Put the continuation right behind the card it continues; a card's name begins in column 1");
    if (!mark_name(name).empty() && mark_name(name) != mark_name(mark_))
      throw InputError(
          here(column),
          fmt::format("found the continuation '{}', but the card before it ends with the mark '{}'", name, mark_),
          "Put each continuation right behind its card (sorted continuations are not read)");
    if (!columns_.empty()) {  // the list is made after all, from the card's first line
      const char* const line = std::exchange(line_begin_, columns_.data());
      add_columns(std::exchange(columns_, {}), 8);
      line_begin_ = line;
    }
    CardSpan& card = text_.cards.back();
    // a line of four large fields is half a line of eight: its other half comes only as another large line
    const std::size_t filled = text_.fields.size() - card.first_field;
    if (filled % 8 != 0 && !(large && large_))
      for (int i = 0; i < 4; ++i) add({}, static_cast<std::size_t>(column));
  } else {
    close_card();
    if (name.front() == '=' || std::isdigit(static_cast<unsigned char>(name.front())))
      throw InputError(here(column), fmt::format("found '{}' where a card's name was expected", name),
                       "Replication ('=') is not read; write every card out, its name in column 1");
    const std::uint32_t named = name_index(large ? trim(name.substr(0, name.size() - 1)) : name);
    text_.cards.push_back({.begin = line_begin_,
                           .first_field = text_.fields.size(),
                           .line = static_cast<std::uint32_t>(line_),
                           .file = static_cast<std::uint32_t>(file_) & 0x7fffffffU,
                           .name = named});
    card_open_ = true;
  }
  columns_ = {};
  large_ = large;
  mark_ = std::string(mark);
}

// `column` counts from 1 in this line; blanks behind the text are left away
void Reader::add(std::string_view text, std::size_t column) {
  while (!text.empty() && white(text.back())) text.remove_suffix(1);
  const std::size_t offset = static_cast<std::size_t>(line_begin_ - text_.cards.back().begin) + column - 1;
  if (offset + text.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(here(static_cast<int>(column)), "the card is longer than 4 GiB", "Split it");
  text_.fields.push_back({static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(text.size())});
}

std::uint32_t Reader::name_index(std::string_view name) {
  if (!text_.cards.empty() && text_.names[text_.cards.back().name] == name) return text_.cards.back().name;
  const auto [entry, added] = name_index_.try_emplace(upper(name), static_cast<std::uint32_t>(text_.names.size()));
  if (added) text_.names.push_back(entry->first);
  return entry->second;
}

void Reader::close_card() {
  if (!card_open_) return;
  CardSpan& card = text_.cards.back();
  card_open_ = false;
  if (!columns_.empty()) {  // blank fields at the end are none
    std::string_view filled = columns_.substr(0, columns_of_line - 8);
    while (white(filled.back())) filled.remove_suffix(1);
    card.field_count = static_cast<std::uint32_t>((filled.size() - 1) / columns_of_name);
    card.first_field = columns_.size();
    card.in_columns = 1;
    return;
  }
  while (text_.fields.size() > card.first_field && text_.fields.back().size == 0) text_.fields.pop_back();
  card.field_count = static_cast<std::uint32_t>(text_.fields.size() - card.first_field);
}

}  // namespace

SourceFile::SourceFile(std::string as_named, const fs::path& path) : name(std::move(as_named)), pages(path) {
  require_text(pages.bytes(), name);
  if (pages.bytes().find('\t') != std::string_view::npos)
    expanded = with_tabs_expanded(without_byte_order_mark(pages.bytes()));
  pages.release(pages.bytes().size());
}

Text read_text(const fs::path& path, bool superelement) { return Reader(superelement).read(path); }

}  // namespace tenon::fem::nastran
