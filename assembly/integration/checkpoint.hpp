#pragma once

#include <filesystem>

#include "assembly/integration/integrate.hpp"

/// A file from which a run continues bit for bit: JSON, version 1, numbers as hexadecimal floats.
namespace tenon::assembly {

/// What the file says of the run it was taken from.
struct Checkpoint {
  Method method = Method::generalized_alpha;
  IntegrationState state;
};

/// Writes it whole or not at all. Throws InputError when the file cannot be written.
void write_checkpoint(const std::filesystem::path& path, const Multibody& system, const Checkpoint& checkpoint);

/// Throws InputError when the file is no checkpoint, of another version, or of a system with other bodies, hinges or
/// modes.
Checkpoint read_checkpoint(const std::filesystem::path& path, const Multibody& system);

}  // namespace tenon::assembly
