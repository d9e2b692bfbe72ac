#include "interfaces/cli/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tenon::cli {
namespace {

const char* severity_name(fem::Severity severity) {
  static constexpr const char* names[] = {"note", "warning", "error"};
  return names[static_cast<std::size_t>(severity)];
}

/// "ok" for what was held against a limit and kept it.
const char* label(const fem::Finding& f) {
  if (f.severity == fem::Severity::error) return "FAILED";
  if (f.severity == fem::Severity::warning) return "warn  ";
  return f.count > 0 ? "note  " : "ok    ";
}

std::string sentence(const fem::Finding& f) {
  std::string text = f.where.empty() ? f.what : fmt::format("{} {}: {}", f.count, f.what, fmt::join(f.where, ", "));
  if (f.count > static_cast<long>(f.where.size()) && !f.where.empty()) text += ", ...";
  if (f.severity == fem::Severity::note) return text;
  if (std::isfinite(f.value) && std::isfinite(f.limit))
    text += fmt::format(" (worst {:.3g}, limit {:.3g})", f.value, f.limit);
  if (!f.cure.empty()) text += fmt::format(". {}.", f.cure);
  return text;
}

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

}  // namespace

Subjected remark(std::string subject, std::string what, bool good) {
  return {std::move(subject),
          {.severity = good ? fem::Severity::note : fem::Severity::error, .check = "scene", .what = std::move(what)}};
}

bool good(const std::vector<Subjected>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Subjected& s) { return s.finding.severity == fem::Severity::error; });
}

Json to_json(const std::vector<Subjected>& findings) {
  Json list = Json::array();
  for (const auto& [subject, f] : findings)
    list.push_back({{"subject", subject},
                    {"check", f.check},
                    {"severity", severity_name(f.severity)},
                    {"good", f.severity != fem::Severity::error},
                    {"what", f.what},
                    {"count", f.count},
                    {"where", f.where},
                    {"value", number(f.value)},
                    {"limit", number(f.limit)},
                    {"cure", f.cure}});
  return list;
}

void print_people(const std::vector<Subjected>& findings) {
  for (const auto& [subject, finding] : findings)
    print(wrapped(fmt::format("{} {}: {}", label(finding), subject, sentence(finding)), 4));
}

}  // namespace tenon::cli
