#pragma once

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <filesystem>

#include "fem/formats/file_bytes.hpp"
#include "tests/benchmarks/peak_memory.hpp"

/// What benchmarks of readers share.
namespace tenon::benchmarks {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A file or folder of this run, removed with it.
class ScratchFile {
 public:
  explicit ScratchFile(const char* name)
      : path_(std::filesystem::temp_directory_path() / fmt::format("tenon-bench-{}-{}", ::getpid(), name)) {}
  ~ScratchFile() { std::filesystem::remove_all(path_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The least that a reader of text can do: every word looked at once as a number.
inline double scan_seconds(const std::filesystem::path& path) {
  const auto start = std::chrono::steady_clock::now();
  const fem::MappedFile file(path);
  const char *at = file.bytes().data(), *const end = at + file.bytes().size();
  double sum = 0.0;
  while (at != end) {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(at, end, value);
    sum += value;
    at = rest == at ? at + 1 : rest;
  }
  benchmark::DoNotOptimize(sum);
  return seconds_since(start);
}

}  // namespace tenon::benchmarks
