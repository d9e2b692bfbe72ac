#pragma once

#include <filesystem>
#include <string>

#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// Version of the *.body.json format. 3 added what large motion needs; files of version 2 are read as bodies without.
inline constexpr int body_file_version = 3, oldest_body_file_version = 2;

/// Writes a body as *.body.json: SI units (named in the file), provenance, certificate; doubles survive bit for bit.
/// Written to a temporary file and renamed, so a half-written file never replaces a good one.
void write_body(const std::filesystem::path& path, const ReducedBody& body);

/// Reads a body; throws InputError for a wrong version, inconsistent sizes or anything malformed.
ReducedBody read_body(const std::filesystem::path& path);

/// "fnv1a64:" and the 64-bit FNV-1a hash of the file's bytes in 16 hex digits: the provenance a certificate carries.
std::string file_hash(const std::filesystem::path& path);

}  // namespace tenon::reduction
