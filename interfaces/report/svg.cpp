#include "interfaces/report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/formats/atomic_file.hpp"

namespace tenon::report {
namespace {

constexpr double width = 860, height = 520, left = 88, right = 28, top = 52, bottom = 64;
// Okabe & Ito's colours, told apart by people of every colour vision.
constexpr std::array<const char*, 7> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#444444"};

/// An axis: its range (in decades if logarithmic) and place on the page.
struct Axis {
  double low, high;
  double from, to;  // page
  bool log;

  double at(double value) const {
    return from + ((log ? std::log10(value) : value) - low) / (high - low) * (to - from);
  }
  bool shows(double value) const { return std::isfinite(value) && (!log || value > 0.0); }
};

/// A round step, 1, 2 or 5 times a power of ten, that cuts a range into at most about eight.
double round_step(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 8.0)));
  for (const double m : {1.0, 2.0, 5.0})
    if (range / (m * power) <= 8.0) return m * power;
  return 10.0 * power;
}

/// The range of the values; widened to whole decades or steps (`whole`), or taken as it is.
Axis axis_of(const std::vector<Curve>& curves, std::vector<double> Curve::*values, bool log, bool whole, double from,
             double to) {
  double low = INFINITY, high = -INFINITY;
  for (const Curve& curve : curves)
    for (const double value : curve.*values)
      if (std::isfinite(value) && (!log || value > 0.0)) {
        low = std::min(low, log ? std::log10(value) : value);
        high = std::max(high, log ? std::log10(value) : value);
      }
  if (low > high) low = 0.0, high = 1.0;
  if (high - low < 1e-9 * std::max(1.0, std::abs(low))) low -= 0.5, high += 0.5;
  const double step = log ? 1.0 : round_step(high - low);
  if (whole) low = step * std::floor(low / step), high = step * std::ceil(high / step);
  return {low, high, from, to, log};
}

/// 0.001, 1, 100, or 10 with an exponent where that is shorter.
std::string decade(int exponent) {
  if (exponent >= -2 && exponent <= 3) return fmt::format("{:g}", std::pow(10.0, exponent));
  return fmt::format("10<tspan dy=\"-6\" font-size=\"10\">{}</tspan>", exponent);
}

constexpr const char* vertical = "<line x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\" class=\"{3}\"/>\n";
constexpr const char* horizontal = "<line x1=\"{0}\" y1=\"{1:.1f}\" x2=\"{2}\" y2=\"{1:.1f}\" class=\"{3}\"/>\n";

std::string round_number(double value, double step) {
  return fmt::format("{:g}", std::abs(value) < 1e-9 * step ? 0.0 : value);
}

void draw_linear(const Axis& axis, bool across, std::string& svg) {
  const double step = round_step(axis.high - axis.low);
  for (double value = step * std::ceil(axis.low / step - 1e-9); value <= axis.high + 1e-9 * step; value += step) {
    const double at = axis.at(value);
    if (across) {
      svg += fmt::format(fmt::runtime(vertical), at, top, height - bottom, "major");
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", at, height - bottom + 18,
                         round_number(value, step));
    } else {
      svg += fmt::format(fmt::runtime(horizontal), left, at, width - right, "major");
      svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 8, at + 4,
                         round_number(value, step));
    }
  }
}

/// Grid lines and labels of one axis: `page` places a value, `line` draws one grid line there.
void draw_x(const Axis& axis, std::string& svg) {
  if (!axis.log) return draw_linear(axis, true, svg);
  const bool few = axis.high - axis.low < 2.0;
  for (int e = static_cast<int>(std::floor(axis.low)); e <= static_cast<int>(std::ceil(axis.high)); ++e)
    for (int m = 1; m <= 9; ++m) {
      const double value = m * std::pow(10.0, e), log = std::log10(value);
      if (log < axis.low - 1e-9 || log > axis.high + 1e-9) continue;
      const double x = axis.at(value);
      svg += fmt::format(fmt::runtime(vertical), x, top, height - bottom, m == 1 ? "major" : "minor");
      if (m == 1 || (few && (m == 2 || m == 5)))
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", x, height - bottom + 18,
                           m == 1 ? decade(e) : fmt::format("{:g}", value));
    }
}

void draw_y(const Axis& axis, std::string& svg) {
  if (!axis.log) return draw_linear(axis, false, svg);
  const int decades = static_cast<int>(axis.high - axis.low);
  const int step = std::max(1, decades / 10);  // at most about ten labels
  for (int e = static_cast<int>(axis.low); e <= static_cast<int>(axis.high); ++e) {
    const double y = axis.at(std::pow(10.0, e));
    const bool labelled = (e - static_cast<int>(axis.low)) % step == 0;
    svg += fmt::format(fmt::runtime(horizontal), left, y, width - right, labelled ? "major" : "minor");
    if (labelled)
      svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 8, y + 4, decade(e));
    if (decades <= 6 && e < static_cast<int>(axis.high))
      for (int m = 2; m <= 9; ++m)
        svg += fmt::format(fmt::runtime(horizontal), left, axis.at(m * std::pow(10.0, e)), width - right, "minor");
  }
}

std::string polyline(const Curve& curve, const Axis& x, const Axis& y, const char* colour) {
  std::string points;
  for (std::size_t k = 0; k < std::min(curve.x.size(), curve.y.size()); ++k)
    if (x.shows(curve.x[k]) && y.shows(curve.y[k]))
      points += fmt::format("{:.2f},{:.2f} ", x.at(curve.x[k]), y.at(curve.y[k]));
  return fmt::format(
      "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.7\" stroke-linejoin=\"round\"/>\n", points,
      colour);
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string to_svg(const Plot& plot) {
  const Axis x = axis_of(plot.curves, &Curve::x, plot.log_x, false, left, width - right);
  const Axis y = axis_of(plot.curves, &Curve::y, plot.log_y, true, height - bottom, top);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#222\">\n"
      "<style>.major{{stroke:#c4c4c4;stroke-width:.8}}.minor{{stroke:#ebebeb;stroke-width:.6}}</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      width, height);
  svg += fmt::format("<text x=\"{}\" y=\"30\" font-size=\"17\" font-weight=\"bold\">{}</text>\n", left,
                     escaped(plot.title));
  draw_x(x, svg);
  draw_y(y, svg);
  svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n", left, top,
                     width - left - right, height - top - bottom);
  for (std::size_t k = 0; k < plot.curves.size(); ++k)
    svg += polyline(plot.curves[k], x, y, colours[k % colours.size()]);
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2,
                     height - 18, escaped(plot.x_label));
  svg += fmt::format("<text transform=\"translate(24 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                     (top + height - bottom) / 2, escaped(plot.y_label));
  std::size_t longest = 0;
  for (const Curve& curve : plot.curves) longest = std::max(longest, curve.name.size());
  const double legend = width - right - std::max(170.0, 46.0 + 7.5 * static_cast<double>(longest));
  if (plot.curves.size() > 1)
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
      const double row = top + 20 + 18 * static_cast<double>(k);
      svg += fmt::format(
          "<line x1=\"{0}\" y1=\"{1}\" x2=\"{2}\" y2=\"{1}\" stroke=\"{3}\" stroke-width=\"2.4\"/>"
          "<text x=\"{4}\" y=\"{5}\">{6}</text>\n",
          legend, row, legend + 26, colours[k % colours.size()], legend + 34, row + 4, escaped(plot.curves[k].name));
    }
  return svg + "</svg>\n";
}

void write_svg(const std::filesystem::path& path, const Plot& plot) {
  fem::AtomicFile file(path);
  file.stream() << to_svg(plot);
  file.commit();
}

}  // namespace tenon::report
