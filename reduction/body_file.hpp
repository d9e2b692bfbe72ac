#pragma once

#include <filesystem>

#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// Version of the *.body.json format.
inline constexpr int body_file_version = 1;

/// Writes a body as *.body.json: SI units (named in the file), provenance, certificate; doubles survive bit for bit.
/// Written to a temporary file and renamed, so a half-written file never replaces a good one.
void write_body(const std::filesystem::path& path, const ReducedBody& body);

/// Reads a body; throws InputError for a wrong version, inconsistent sizes or anything malformed.
ReducedBody read_body(const std::filesystem::path& path);

}  // namespace tenon::reduction
