#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Arrays for NumPy: numpy.load("file.npz")["name"].
namespace tenon::report {

struct NamedArray {
  std::string name;
  std::vector<double> values;
};

/// Writes one-dimensional arrays of doubles as .npz, whole or not at all. Throws InputError when it cannot.
void write_npz(const std::filesystem::path& path, const std::vector<NamedArray>& arrays);

}  // namespace tenon::report
