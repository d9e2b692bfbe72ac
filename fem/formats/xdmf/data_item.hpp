#pragma once

#include <filesystem>
#include <pugixml.hpp>

#include "fem/formats/vtk/values.hpp"

namespace tenon::fem::xdmf {

/// The numbers of a DataItem, as many as its Dimensions say. @param folder  where files that it names must lie
/// Throws vtk::ArrayFault.
vtk::Values values_of(pugi::xml_node item, const std::filesystem::path& folder);

}  // namespace tenon::fem::xdmf
