#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Pictures of responses as stand-alone SVG files.
namespace tenon::report {

struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< positive; others are left out of a logarithmic picture
};

struct LogLogPlot {
  std::string title;
  std::string x_label, y_label;
  std::vector<Curve> curves;
};

/// The picture as SVG text: decades as grid lines, minor ticks, a legend when there are several curves.
std::string to_svg(const LogLogPlot& plot);

/// Writes it whole or not at all. Throws InputError when the file cannot be written.
void write_svg(const std::filesystem::path& path, const LogLogPlot& plot);

}  // namespace tenon::report
