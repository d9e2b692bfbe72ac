#include "fem/formats/vtk/values.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

namespace tenon::fem::vtk {
namespace {

constexpr const char* write_again = "Write the file again";

bool is_white(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// 0 to 63, 64 for padding, −1 for what is no base64.
int digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 64 : -1;
}

/// Bytes as they stand or from base64, whose padding may stand after any part that was encoded alone.
class Stream {
 public:
  Stream(std::string_view bytes, bool base64) : rest_(bytes), base64_(base64) {}

  std::string read(std::uint64_t n) {
    const std::uint64_t most = base64_ ? spare_.size() + rest_.size() / 4 * 3 : rest_.size();
    if (n > most) throw ArrayFault{fmt::format("needs {} more bytes, at most {} are left", n, most), write_again};
    const auto count = static_cast<std::size_t>(n);
    if (!base64_) {
      std::string out(rest_.substr(0, count));
      rest_.remove_prefix(count);
      return out;
    }
    while (spare_.size() < count) decode_four();
    std::string out = spare_.substr(0, count);
    spare_.erase(0, count);
    return out;
  }

 private:
  void decode_four() {
    std::array<int, 4> d{};
    for (int& value : d) {
      while (!rest_.empty() && is_white(rest_.front())) rest_.remove_prefix(1);
      if (rest_.empty()) throw ArrayFault{"its base64 ends too early", write_again};
      value = digit(rest_.front());
      if (value < 0) throw ArrayFault{"holds a character that is no base64", write_again};
      rest_.remove_prefix(1);
    }
    if (d[0] == 64 || d[1] == 64 || (d[2] == 64 && d[3] != 64)) throw ArrayFault{"has misplaced '='", write_again};
    const int bits = d[0] << 18 | d[1] << 12 | (d[2] & 63) << 6 | (d[3] & 63);
    spare_ += static_cast<char>(bits >> 16 & 255);
    if (d[2] != 64) spare_ += static_cast<char>(bits >> 8 & 255);
    if (d[3] != 64) spare_ += static_cast<char>(bits & 255);
  }

  std::string_view rest_;
  bool base64_;
  std::string spare_;  ///< decoded, not yet read
};

template <class T>
T load(const char* bytes, bool swapped) {
  std::array<char, sizeof(T)> raw{};
  std::copy_n(bytes, sizeof(T), raw.begin());
  if (swapped) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), sizeof value);
  return value;
}

std::vector<std::uint64_t> words(Stream& stream, std::uint64_t n, const Encoding& encoding) {
  if (n > std::numeric_limits<std::uint64_t>::max() / 8) throw ArrayFault{"declares too many blocks", write_again};
  const std::string bytes = stream.read(n * encoding.word);
  std::vector<std::uint64_t> out;
  for (std::size_t at = 0; at < bytes.size(); at += encoding.word)
    out.push_back(encoding.word == 4 ? load<std::uint32_t>(bytes.data() + at, encoding.swapped)
                                     : load<std::uint64_t>(bytes.data() + at, encoding.swapped));
  return out;
}

/// The header [number of blocks, size of a block, size of the last (0: full), compressed sizes ...], then the blocks.
/// Not more than `most` bytes together.
std::string inflated(Stream& stream, const Encoding& encoding, std::uint64_t most) {
  const std::uint64_t blocks = words(stream, 1, encoding)[0];
  if (blocks == 0) return {};
  const auto sizes = words(stream, 2, encoding);
  std::string out;
  const auto packed_sizes = words(stream, blocks, encoding);
  for (std::size_t b = 0; b < packed_sizes.size(); ++b) {
    const bool last = b + 1 == packed_sizes.size();
    const std::uint64_t size = last && sizes[1] != 0 ? sizes[1] : sizes[0];
    const std::string packed = stream.read(packed_sizes[b]);
    if (size > most - out.size())
      throw ArrayFault{
          fmt::format("says that {} compressed bytes hold {}: more than a hundred times the file", packed.size(), size),
          "Write it again, or not compressed"};
    const std::size_t start = out.size();
    out.resize(start + static_cast<std::size_t>(size));
    auto found = static_cast<uLongf>(size);
    const int status = uncompress(reinterpret_cast<Bytef*>(out.data() + start), &found,
                                  reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
    if (status != Z_OK || found != size)
      throw ArrayFault{fmt::format("block {} of {} cannot be decompressed", b + 1, packed_sizes.size()), write_again};
  }
  return out;
}

template <class T>
void append_all(std::string_view bytes, bool swapped, Values& values) {
  if (bytes.size() % sizeof(T) != 0)
    throw ArrayFault{fmt::format("holds {} bytes, no whole number of values of {}", bytes.size(), sizeof(T)),
                     write_again};
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
    const T value = load<T>(bytes.data() + at, swapped);
    if constexpr (std::is_floating_point_v<T>)
      values.reals.push_back(static_cast<double>(value));
    else if (!std::in_range<std::int64_t>(value))
      throw ArrayFault{fmt::format("holds {}, which no signed whole number of 64 bits can be", value), write_again};
    else
      values.whole.push_back(static_cast<std::int64_t>(value));
  }
}

bool is_real(std::string_view type) { return type == "Float32" || type == "Float64"; }

[[noreturn]] void fail_type(std::string_view type) {
  throw ArrayFault{fmt::format("has type '{}', expected Int8 to UInt64, Float32 or Float64", type), write_again};
}

}  // namespace

Values text_values(std::string_view text, std::string_view type) {
  Values values{is_real(type), {}, {}};
  if (!values.real && !type.starts_with("Int") && !type.starts_with("UInt")) fail_type(type);
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    while (at != end && is_white(*at)) ++at;
    if (at == end) return values;
    double real = 0.0;
    std::int64_t whole = 0;
    const auto [next, error] = values.real ? std::from_chars(at, end, real) : std::from_chars(at, end, whole);
    if (error != std::errc() || (next != end && !is_white(*next))) {
      const char* const stop = std::find_if(at, end, is_white);
      throw ArrayFault{fmt::format("found '{}' in place of value {}", std::string_view(at, std::min(stop, at + 40)),
                                   values.size() + 1),
                       write_again};
    }
    if (values.real)
      values.reals.push_back(real);
    else
      values.whole.push_back(whole);
    at = next;
  }
}

Values raw_values(std::string_view data, std::string_view type, bool s) {
  Values values{is_real(type), {}, {}};
  if (type == "Float64")
    append_all<double>(data, s, values);
  else if (type == "Float32")
    append_all<float>(data, s, values);
  else if (type == "Int64")
    append_all<std::int64_t>(data, s, values);
  else if (type == "Int32")
    append_all<std::int32_t>(data, s, values);
  else if (type == "Int16")
    append_all<std::int16_t>(data, s, values);
  else if (type == "Int8")
    append_all<std::int8_t>(data, s, values);
  else if (type == "UInt64")
    append_all<std::uint64_t>(data, s, values);
  else if (type == "UInt32")
    append_all<std::uint32_t>(data, s, values);
  else if (type == "UInt16")
    append_all<std::uint16_t>(data, s, values);
  else if (type == "UInt8")
    append_all<std::uint8_t>(data, s, values);
  else
    fail_type(type);
  return values;
}

Values encoded_values(std::string_view bytes, bool base64, std::string_view type, const Encoding& encoding) {
  Stream stream(bytes, base64);
  const std::uint64_t size = type.ends_with("8") ? 1 : type.ends_with("16") ? 2 : type.ends_with("32") ? 4 : 8;
  const std::string data = encoding.zlib ? inflated(stream, encoding, 100 / 8 * size * encoding.file_bytes)
                                         : stream.read(words(stream, 1, encoding)[0]);
  return raw_values(data, type, encoding.swapped);
}

}  // namespace tenon::fem::vtk
