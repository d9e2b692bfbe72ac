#include "interfaces/cli/output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

namespace tenon::cli {
namespace {

constexpr std::size_t page_width = 100;

/// Characters of UTF-8 text as a terminal shows them (all of ours are one column wide).
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t columns, bool left) {
  const std::string blanks(columns > width(text) ? columns - width(text) : 0, ' ');
  return left ? text + blanks : blanks + text;
}

std::string shortened(std::string text, std::size_t columns) {
  if (width(text) <= columns) return text;
  while (!text.empty() && (width(text) > columns - 1 || (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80))
    text.pop_back();
  return text + "…";
}

}  // namespace

Table::Table(std::vector<std::string> heads) : heads_(std::move(heads)) {
  for (std::string& head : heads_) {
    left_.push_back(head.starts_with('<'));
    if (left_.back()) head.erase(0, 1);
  }
}

void Table::row(std::vector<std::string> cells) {
  cells.resize(heads_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::size_t> columns;
  std::size_t total = 0;
  for (std::size_t k = 0; k < heads_.size(); ++k) {
    std::size_t widest = width(heads_[k]);
    for (const auto& row : rows_) widest = std::max(widest, width(row[k]));
    columns.push_back(widest);
    total += widest + 2;
  }
  if (total > page_width) {  // the widest left column gives way
    std::size_t widest = 0;
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (left_[k] && (!left_[widest] || columns[k] > columns[widest])) widest = k;
    columns[widest] -= std::min(columns[widest] - std::min<std::size_t>(columns[widest], 8), total - page_width);
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t k = 0; k < cells.size(); ++k)
      text += "  " + padded(shortened(cells[k], columns[k]), columns[k], left_[k]);
    text.erase(text.find_last_not_of(' ') + 1);
    return text + '\n';
  };
  std::string text = line(heads_);
  for (const std::size_t column : columns) {
    text += "  ";
    for (std::size_t k = 0; k < column; ++k) text += "─";
  }
  text += '\n';
  for (const auto& row : rows_) text += line(row);
  return text;
}

void print(const std::string& text) { fmt::print("{}\n", text); }
void print(const char* text) { fmt::print("{}\n", text); }
void print(const Table& table) { fmt::print("{}", table.text()); }
void print(const Json& object) { fmt::print("{}\n", object.dump(2)); }

std::string wrapped(const std::string& sentence, std::size_t indent) {
  std::string text, line(indent, ' ');
  std::size_t begin = 0;
  while (begin < sentence.size()) {
    const std::size_t end = std::min(sentence.find(' ', begin), sentence.size());
    const std::string word = sentence.substr(begin, end - begin);
    if (width(line) > indent && width(line) + 1 + width(word) > page_width) {
      text += line + '\n';
      line.assign(indent + 2, ' ');
    }
    line += (width(line) > indent && line.back() != ' ' ? " " : "") + word;
    begin = end + 1;
  }
  return text + line;
}

double hertz(double omega) { return omega / (2.0 * std::numbers::pi); }

std::string frequency_text(double omega, bool rigid) {
  return rigid ? std::string("0 (rigid)") : fmt::format("{:.6g}", hertz(omega));
}

ProgressBar::ProgressBar()
    : start_(std::chrono::steady_clock::now()), shown_(start_), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

reduction::Progress ProgressBar::callback() {
  if (!terminal_) return {};
  return [this](double fraction, const char* step) { show(fraction, step); };
}

void ProgressBar::show(double fraction, const char* step) {
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  if (now - start_ < 1s || (drawn_ && now - shown_ < 100ms)) return;
  shown_ = now;
  drawn_ = true;
  const auto filled = static_cast<std::size_t>(30.0 * std::clamp(fraction, 0.0, 1.0));
  fmt::print(stderr, "\r\033[K[{}{}] {:3.0f} %  {}", std::string(filled, '#'), std::string(30 - filled, '.'),
             100.0 * std::clamp(fraction, 0.0, 1.0), step ? step : "");
  std::fflush(stderr);
}

}  // namespace tenon::cli
