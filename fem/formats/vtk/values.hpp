#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Numbers of VTK's files, as text or encoded.
namespace tenon::fem::vtk {

/// What the file says of all its arrays.
struct Encoding {
  bool swapped = false;          ///< numbers have the other byte order
  bool zlib = false;             ///< encoded arrays are compressed in blocks
  std::size_t word = 4;          ///< bytes of a number of the header of encoded arrays: 4 or 8
  std::string_view appended;     ///< what follows the "_" of AppendedData
  bool appended_raw = false;     ///< as bytes, else in base64
  std::uint64_t file_bytes = 0;  ///< an array may not take more than a hundred times that
};

/// The values of one array: whole numbers or reals, never both.
struct Values {
  bool real = false;
  std::vector<std::int64_t> whole;
  std::vector<double> reals;

  std::size_t size() const { return real ? reals.size() : whole.size(); }
  double at(std::size_t i) const { return real ? reals[i] : static_cast<double>(whole[i]); }
};

/// A fault in an array: what was found, and what to do.
struct ArrayFault {
  std::string what;
  std::string cure;
};

/// Numbers of `type` ("Int32", "Float64", ...) written as text. Throws ArrayFault.
Values text_values(std::string_view text, std::string_view type);

/// Numbers of `type` as bytes, of the other byte order where `swapped`. Throws ArrayFault.
Values raw_values(std::string_view data, std::string_view type, bool swapped);

/// Numbers of `type` from bytes or base64 that begin with the header of `encoding`; what follows the array is left
/// alone. Throws ArrayFault, for an array of more than a hundred times the file's size too.
Values encoded_values(std::string_view bytes, bool base64, std::string_view type, const Encoding& encoding);

}  // namespace tenon::fem::vtk
