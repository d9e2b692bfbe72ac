#include "tests/unit/broken_files/broken.hpp"

#include <cstdlib>
#include <stdexcept>

namespace tenon::broken {

std::vector<Word> numbers_of(const std::string& text, const std::string& separators) {
  std::vector<Word> words;
  Word word;
  long line = 1, column = 0;
  bool quoted = false;
  const auto end_word = [&] {
    char* rest = nullptr;
    if (!word.text.empty() && (std::strtod(word.text.c_str(), &rest), *rest == '\0')) words.push_back(word);
    word.text.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    ++column;
    if (c == '"') quoted = !quoted;
    if (quoted || c == '"' || c == ' ' || c == '\t' || c == '\n' || separators.find(c) != std::string::npos) {
      end_word();
    } else {
      if (word.text.empty()) word = {"", line, column, i};
      word.text += c;
    }
    if (c == '\n') {
      ++line;
      column = 0;
    }
  }
  end_word();
  return words;
}

void add_words_for_numbers(std::vector<Case>& cases, const std::string& format, const std::string& text,
                           const std::vector<Word>& numbers) {
  for (const Word& number : numbers) {
    std::string bytes = text;
    bytes.replace(number.offset, number.text.size(), "oops");
    cases.push_back({.name = format + ": a word for the number at " + std::to_string(number.line) + ":" +
                             std::to_string(number.column),
                     .bytes = bytes,
                     .says = {"oops"},
                     .place = std::pair{number.line, number.column}});
  }
}

void add_cuts(std::vector<Case>& cases, const std::string& format, const std::string& text, int complete) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') ends.push_back(i + 1);
  for (std::size_t k = 0; k + static_cast<std::size_t>(complete) < ends.size(); ++k)
    cases.push_back({.name = format + ": cut after line " + std::to_string(k + 1),
                     .bytes = text.substr(0, ends[k]),
                     .says = {"bad."}});
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "' to replace");
  return text.replace(at, from.size(), to);
}

std::string with_windows_ends(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

}  // namespace tenon::broken
