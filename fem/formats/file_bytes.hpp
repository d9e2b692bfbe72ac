#pragma once

#include <filesystem>
#include <string>

namespace tenon::fem {

/// The contents of a regular file. Throws InputError when it does not exist (naming near misses in its folder), is a
/// folder or a device, or cannot be read.
std::string read_bytes(const std::filesystem::path& path);

}  // namespace tenon::fem
