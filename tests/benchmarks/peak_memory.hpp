#pragma once

#include <fstream>
#include <string>

namespace tenon::benchmarks {

/// Resident memory of this process in bytes: `field` is VmRSS (now) or VmHWM (peak since the last reset).
inline double resident(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field + ":", 0) == 0) return 1024.0 * std::stod(line.substr(field.size() + 1));
  return 0.0;
}

/// Measures by how much the peak of resident memory rises above its value at construction.
class PeakMemory {
 public:
  PeakMemory() {
    std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak
    before_ = resident("VmRSS");
  }
  double rise() const { return resident("VmHWM") - before_; }

 private:
  double before_ = 0.0;
};

}  // namespace tenon::benchmarks
