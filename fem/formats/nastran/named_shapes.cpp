#include "fem/formats/nastran/named_shapes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "fem/section_shapes.hpp"

namespace tenon::fem::nastran {
namespace {

struct NamedShape {
  const char* type;
  int dimensions;
  BeamSection (*make)(const double* d, double nu);
};

// webs stand along y: our open shapes and boxes, which have them along z, with swapped axes
constexpr std::array<NamedShape, 10> shapes{{
    {"ROD", 1, [](const double* d, double nu) { return circle(d[0], nu); }},
    {"TUBE", 2, [](const double* d, double nu) { return tube(d[0], d[1], nu); }},
    {"TUBE2", 2, [](const double* d, double nu) { return tube(d[0], d[0] - d[1], nu); }},
    {"BAR", 2, [](const double* d, double nu) { return rectangle(d[1], d[0], nu); }},
    {"BOX", 4, [](const double* d, double nu) { return swapped_axes(box(d[0], d[1], d[2], d[3], nu)); }},
    {"I", 6, [](const double* d, double) { return swapped_axes(i_section(d[0], d[1], d[4], d[2], d[5], d[3])); }},
    {"I1", 4,
     [](const double* d, double) {
       const double flange = 0.5 * (d[3] - d[2]);
       return swapped_axes(i_section(d[3], d[0] + d[1], flange, d[0] + d[1], flange, d[1]));
     }},
    {"T", 4, [](const double* d, double) { return swapped_axes(tee(d[0], d[1], d[2], d[3])); }},
    {"CHAN", 4, [](const double* d, double) { return swapped_axes(channel(d[0], d[1], d[3], d[2])); }},
    {"L", 4, [](const double* d, double) { return swapped_axes(angle_section(d[0], d[1], d[2], d[3])); }},
}};

const NamedShape& shape_named(const Card& card) {
  const std::string type = upper(card.at(4));
  const auto* const found = std::ranges::find_if(shapes, [&](const NamedShape& s) { return s.type == type; });
  if (found == shapes.end())
    card.refuse(4, fmt::format("has the TYPE '{}', which is not read", card.at(4)),
                fmt::format("Give its constants by a {}; read are ROD, TUBE, TUBE2, BAR, BOX, I, I1, T, CHAN, L",
                            card.name() == "PBARL" ? "PBAR" : "PBEAM"));
  return *found;
}

}  // namespace

int dimensions_of(const Card& card) { return shape_named(card).dimensions; }

BeamSection named_shape(const Card& card, const std::vector<double>& dim, int at, double nu) {
  try {
    return shape_named(card).make(dim.data(), nu);
  } catch (const ModelError& fault) {
    card.refuse(at, fmt::format("{} has DIM {:g}: {}", card.id(1, "PID"), fmt::join(dim, ", "), fault.what()),
                "Compare the order of the sizes with the manual's figure");
  }
}

}  // namespace tenon::fem::nastran
