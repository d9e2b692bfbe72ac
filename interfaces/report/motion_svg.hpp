#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assembly/mode_shapes.hpp"

namespace tenon::report {

/// Modes of a planar mechanism as one picture, a panel a mode: the rest position in grey, the mode shape on both sides
/// of it in colour, one colour a body.
struct MotionPicture {
  std::string title;
  std::vector<assembly::BodyShapes> bodies;  ///< nodes of each in the order of a line
  std::vector<std::string> captions;         ///< one for each column of the shapes
};

/// Seen along −z, x to the right, y up; the largest displacement is drawn as a tenth of the mechanism's size.
void write_motion_svg(const std::filesystem::path& path, const MotionPicture& picture);

}  // namespace tenon::report
