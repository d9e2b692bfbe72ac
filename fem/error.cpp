#include "fem/error.hpp"

#include <fmt/format.h>

namespace tenon {

std::string to_string(const Place& place) {
  if (place.line <= 0) return place.file;
  if (place.column <= 0) return fmt::format("{}:{}", place.file, place.line);
  return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

namespace {

/// A sentence ends once: questions ("Did you mean ...?") and sentences that bring their stop keep it. Control
/// characters that a damaged file brought into it are spelt out: a zero byte would end the message.
std::string sentence(const std::string& text) {
  std::string printed;
  for (const char c : text)
    if ((c >= 0 && c < 32 && c != '\n' && c != '\t') || c == 127)
      printed += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    else
      printed += c;
  const bool ended = !text.empty() && (text.back() == '?' || text.back() == '.');
  return ended ? printed : printed + '.';
}

}  // namespace

InputError::InputError(const Place& place, const std::string& what, const std::string& cure)
    : Error(fmt::format("{}: {} {}", to_string(place), sentence(what), sentence(cure))), place_(place) {}

ModelError::ModelError(const std::string& what, const std::string& cure)
    : Error(fmt::format("{} {}", sentence(what), sentence(cure))) {}

ModelError::ModelError(const std::string& file, const ModelError& fault) : Error(file + ": " + fault.what()) {}

NumericalError::NumericalError(const std::string& what, double figure, const std::string& cure)
    : Error(fmt::format("{} ({:.3g}). {}", what, figure, sentence(cure))), figure_(figure) {}

}  // namespace tenon
