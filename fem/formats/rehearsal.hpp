#pragma once

#include <filesystem>
#include <functional>

namespace tenon::fem {

/// Does `reading` in a process of its own, for libraries that fail on damaged files themselves: HDF5 1.10 reads beyond
/// its buffers on some, on others it asks for memory without bound or does not come back. What goes well there may be
/// done here; what does not throws vtk::ArrayFault, the one that `reading` threw or one that says how the library
/// ended. It has a second and another for each 2 MiB of the file, and 64 MiB and a hundred times the file. Where the
/// system has no further process, nothing is rehearsed.
void rehearse(const std::filesystem::path& file, const std::function<void()>& reading);

}  // namespace tenon::fem
