#include "interfaces/report/motion_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/formats/atomic_file.hpp"
#include "interfaces/report/svg.hpp"

namespace tenon::report {
namespace {

constexpr double panel = 320.0, margin = 26.0, head = 48.0, foot = 30.0;
constexpr int across = 3;
constexpr std::array<const char*, 5> body_colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"};

struct View {
  double x0, y0, scale;  // world point that lies in the middle of a panel; pixels a metre
  double left = 0, top = 0;
  double px(double x) const { return left + panel / 2 + scale * (x - x0); }
  double py(double y) const { return top + panel / 2 - scale * (y - y0); }
};

View view_of(const std::vector<assembly::BodyShapes>& bodies) {
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (const assembly::BodyShapes& body : bodies)
    for (const fem::Vec3& node : body.nodes)
      for (int d = 0; d < 2; ++d) low[d] = std::min(low[d], node[d]), high[d] = std::max(high[d], node[d]);
  const double size = std::max({high[0] - low[0], high[1] - low[1], 1e-12});
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (panel - 2 * margin) / (1.2 * size)};
}

// A body's line: `sign` times its motion in `column`, in pixels `amplitude` a unit of motion.
std::string line(const assembly::BodyShapes& body, const View& view, Eigen::Index column, double amplitude,
                 const char* style) {
  std::string points;
  for (std::size_t k = 0; k < body.nodes.size(); ++k) {
    const auto row = 3 * static_cast<Eigen::Index>(k);
    points += fmt::format("{:.2f},{:.2f} ", view.px(body.nodes[k].x()) + amplitude * body.translations(row, column),
                          view.py(body.nodes[k].y()) - amplitude * body.translations(row + 1, column));
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke-linejoin=\"round\" {}/>\n", points, style);
}

}  // namespace

void write_motion_svg(const std::filesystem::path& path, const MotionPicture& picture) {
  const auto modes = static_cast<int>(picture.captions.size());
  const int rows = (modes + across - 1) / across, columns = std::min(modes, across);
  const double width = columns * panel, height = head + rows * (panel + foot);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#222\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"30\" font-size=\"17\" font-weight=\"bold\">{3}</text>\n",
      width, height, margin, escaped(picture.title));
  View view = view_of(picture.bodies);
  for (int mode = 0; mode < modes; ++mode) {
    view.left = (mode % across) * panel;
    view.top = head + (mode / across) * (panel + foot);
    double largest = 0.0;
    for (const assembly::BodyShapes& body : picture.bodies)
      largest = std::max(largest, body.translations.col(mode).cwiseAbs().maxCoeff());
    const double amplitude = largest > 0.0 ? 0.1 * (panel - 2 * margin) / largest : 0.0;
    for (const assembly::BodyShapes& body : picture.bodies)
      svg += line(body, view, mode, 0.0, "stroke=\"#b0b0b0\" stroke-width=\"3\"");
    for (std::size_t b = 0; b < picture.bodies.size(); ++b)
      for (const double sign : {1.0, -1.0})
        svg += line(picture.bodies[b], view, mode, sign * amplitude,
                    fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}", body_colours[b % body_colours.size()],
                                sign > 0.0 ? 2.2 : 1.2, sign > 0.0 ? "" : " stroke-dasharray=\"5 4\"")
                        .c_str());
    for (const assembly::BodyShapes& body : picture.bodies)
      for (const fem::Vec3& end : {body.nodes.front(), body.nodes.back()})
        svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3.4\" fill=\"white\" stroke=\"#666\"/>\n",
                           view.px(end.x()), view.py(end.y()));
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", view.left + panel / 2,
                       view.top + panel + 12, escaped(picture.captions[static_cast<std::size_t>(mode)]));
  }
  fem::AtomicFile file(path);
  file.stream() << svg << "</svg>\n";
  file.commit();
}

}  // namespace tenon::report
