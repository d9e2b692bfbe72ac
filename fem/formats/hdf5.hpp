#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fem/formats/vtk/values.hpp"

namespace tenon::fem::hdf5 {

/// An HDF5 file, open to be read. Objects are named by their paths ("/mesh/points"). Functions throw vtk::ArrayFault
/// for what cannot be read and for whatever lies in another file: behind links, in external storage or in virtual
/// datasets.
class File {
 public:
  explicit File(const std::filesystem::path& path);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// Whether each step of the path is there, the last one too.
  bool has(const std::string& object) const;

  /// Names in a group, in the alphabet's order; none where there is no such group.
  std::vector<std::string> members(const std::string& group) const;

  /// All numbers of a dataset, row by row: whole or real as it stores them. Throws too where they would take more than
  /// 1100 times what is stored of them (no compression gains more) or more than `most` bytes.
  vtk::Values values(const std::string& dataset, std::uint64_t most) const;

  /// A dataset of texts of one length each, strings or arrays of characters, without the blanks and zeros at their
  /// ends. Throws too where they would take more than 1100 times what is stored of them, or more than `most` bytes.
  std::vector<std::string> texts(const std::string& dataset, std::uint64_t most) const;

  /// A whole number or a text that an object has as attribute; none where it lacks it or that is of another kind.
  std::optional<std::int64_t> number(const std::string& object, const std::string& attribute) const;
  std::optional<std::string> text(const std::string& object, const std::string& attribute) const;

 private:
  std::string name_;  ///< for messages
  std::int64_t id_ = -1;
};

}  // namespace tenon::fem::hdf5
