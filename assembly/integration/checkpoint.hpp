#pragma once

#include <filesystem>

#include "assembly/integration/integrate.hpp"

/// A file from which a run continues bit for bit: JSON, version 1, numbers as hexadecimal floats.
namespace tenon::assembly {

/// What the file says of the run it was taken from.
struct Checkpoint {
  Method method = Method::generalized_alpha;
  Tolerance tolerance{};  ///< of adaptive methods
  IntegrationState state;
};

/// Writes it whole or not at all. Throws InputError when the file cannot be written.
void write_checkpoint(const std::filesystem::path& path, const Multibody& system, const Checkpoint& checkpoint);

/// Throws InputError when the file is no checkpoint, of another version, of a system whose bodies, joints or gravity
/// are others (the message names what differs), or when its state cannot be one of this system (check_state()).
Checkpoint read_checkpoint(const std::filesystem::path& path, const Multibody& system);

}  // namespace tenon::assembly
