#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fem/mesh.hpp"

namespace tenon::fem {

/// Reads an XDMF file (.xdmf, .xmf), version 2 or 3: uniform grids, their cells of one kind or mixed, numbers in the
/// file itself, in HDF5 or in raw binary files beside it. One block of cells a type, points and cells numbered from 0;
/// attributes become point and cell data, whole numbers of cells sets too, up to 256 values each; Set becomes a set. Of
/// a temporal collection the first grid is read, several grids stand side by side; both are in Mesh::losses.
/// Names of other files are relative to this one and stay within its folder, and so does what HDF5 files link to. A
/// DataItem may refer to another by its path.
/// Throws InputError with file:line:column, for what would be read past too (a second Topology, an Order of nodes). The
/// numbers take at most a hundred times the size of the files, however often those name the same ones.
/// Source: XDMF model and format (xdmf.org), XdmfTopologyType.
Mesh read_xdmf(const std::filesystem::path& path);

/// The same from the bytes of a file. @param folder  of the files beside it
Mesh parse_xdmf(std::string_view bytes, const std::string& source, const std::filesystem::path& folder);

}  // namespace tenon::fem
