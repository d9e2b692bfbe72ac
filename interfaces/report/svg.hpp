#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Pictures of responses as stand-alone SVG files.
namespace tenon::report {

struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< values that are not positive are left out along a logarithmic axis
};

struct Plot {
  std::string title;
  std::string x_label, y_label;
  std::vector<Curve> curves;
  bool log_x = true, log_y = true;
};

/// The picture as SVG text: decades or round steps as grid lines, a legend when there are several curves.
std::string to_svg(const Plot& plot);

/// Text as it may stand in SVG: <, > and & as entities.
std::string escaped(const std::string& text);

/// Writes it whole or not at all. Throws InputError when the file cannot be written.
void write_svg(const std::filesystem::path& path, const Plot& plot);

}  // namespace tenon::report
