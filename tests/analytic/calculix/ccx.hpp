#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

/// Runs CalculiX where it is installed (Debian's calculix-ccx).
namespace tenon::calculix {

inline bool installed() { return std::system("command -v ccx > /dev/null") == 0; }

/// Runs `folder`/`job`.inp on one thread; false when it stops with an error.
inline bool run(const std::filesystem::path& folder, const std::string& job) {
  return std::system(
             fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx {} > {}.log 2>&1", folder.string(), job, job).c_str()) == 0;
}

/// The frequencies [1/time] of a job.dat: rows of mode, eigenvalue, rad/time, cycles/time, imaginary part.
inline std::vector<double> frequencies(const std::filesystem::path& dat) {
  std::ifstream file(dat);
  std::vector<double> frequencies;
  bool table = false;
  for (std::string line; std::getline(file, line);) {
    if (line.find("E I G E N V A L U E   O U T P U T") != std::string::npos) table = true;
    if (line.find("P A R T I C I P A T I O N") != std::string::npos) break;
    std::istringstream words(line);
    double mode = 0.0, lambda = 0.0, omega = 0.0, hertz = 0.0;
    if (table && words >> mode >> lambda >> omega >> hertz) frequencies.push_back(hertz);
  }
  return frequencies;
}

/// The ten eigenvalues of a job.eig (*FREQUENCY, STORAGE=YES) in all their digits: after four integers, the last of
/// them the count.
inline std::vector<double> stored_eigenvalues(const std::string& bytes) {
  std::int32_t count = 0;
  if (bytes.size() < 16 + 80) return {};
  std::memcpy(&count, bytes.data() + 12, sizeof count);
  if (count != 10) return {};
  std::vector<double> values(10);
  std::memcpy(values.data(), bytes.data() + 16, 80);
  return values;
}

}  // namespace tenon::calculix
