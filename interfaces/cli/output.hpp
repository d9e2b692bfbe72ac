#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reduction/modes.hpp"

/// What people see: tables that fit 100 columns, one JSON object for machines, a progress bar when somebody looks.
namespace tenon::cli {

using Json = nlohmann::ordered_json;

/// Exit statuses.
inline constexpr int done = 0, check_failed = 1, bad_input = 2, internal_fault = 3;

/// A table with a line under its heads; columns are right-aligned unless their head begins with '<'.
class Table {
 public:
  explicit Table(std::vector<std::string> heads);
  void row(std::vector<std::string> cells);
  /// With two blanks between columns and before the first; the last left column is cut so that 100 columns suffice.
  std::string text() const;

 private:
  std::vector<std::string> heads_;
  std::vector<bool> left_;
  std::vector<std::vector<std::string>> rows_;
};

void print(const std::string& text);
void print(const char* text);
void print(const Table& table);
void print(const Json& object);

/// A sentence wrapped to 100 columns, each line after `indent` blanks.
std::string wrapped(const std::string& sentence, std::size_t indent = 2);

double hertz(double omega);

/// A frequency in Hz: six significant digits, "0 (rigid)" for rigid modes.
std::string frequency_text(double omega, bool rigid = false);

/// Draws a bar on standard error once a second has passed, and only for a terminal; clears it when destroyed.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  reduction::Progress callback();

 private:
  void show(double fraction, const char* step);
  std::chrono::steady_clock::time_point start_, shown_;
  bool terminal_, drawn_ = false;
};

}  // namespace tenon::cli
