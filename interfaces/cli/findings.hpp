#pragma once

#include <string>
#include <vector>

#include "fem/model_check.hpp"
#include "interfaces/cli/output.hpp"

/// Findings of model checks as lines for people and as JSON.
namespace tenon::cli {

/// A finding and the body or file it is about.
struct Subjected {
  std::string subject;
  fem::Finding finding;
};

/// A finding that only says something; `good` false: a check that failed.
Subjected remark(std::string subject, std::string what, bool good = true);

bool good(const std::vector<Subjected>& findings);
Json to_json(const std::vector<Subjected>& findings);
void print_people(const std::vector<Subjected>& findings);

}  // namespace tenon::cli
