#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace tenon::fem {

/// ".msh" of "Part.MSH".
inline std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

/// Nastran bulk data by its extension.
inline bool is_nastran(const std::string& lower_extension) {
  return lower_extension == ".bdf" || lower_extension == ".dat" || lower_extension == ".nas" ||
         lower_extension == ".blk";
}

}  // namespace tenon::fem
