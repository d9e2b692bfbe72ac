#include "fem/model_check.hpp"

#include <algorithm>

#include "fem/checks/cells.hpp"

namespace tenon::fem {
namespace {

std::vector<Finding> check_cells(const checks::Cells& cells, const CheckLimits& limits) {
  std::vector<Finding> findings;
  checks::check_parts(cells, limits, findings);
  checks::check_duplicates(cells, limits, findings);
  checks::check_shapes(cells, limits, findings);
  checks::check_nodes(cells, limits, findings);
  checks::check_edges(cells, limits, findings);
  return findings;
}

/// The assembler would refuse these.
bool faulty_element(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.check == "no_area" || f.check == "inverted"; });
}

}  // namespace

bool has_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::error; });
}

std::vector<Finding> check_mesh(const Mesh& mesh, const CheckLimits& limits) {
  return check_cells(checks::cells_of(mesh), limits);
}

std::vector<Finding> check_geometry(const Model& model, const CheckLimits& limits) {
  std::vector<Finding> findings = check_cells(checks::cells_of(model), limits);
  if (!faulty_element(findings)) checks::check_curvature(model, limits, findings);
  return findings;
}

std::vector<Finding> check_curvature(const Model& model, const CheckLimits& limits) {
  std::vector<Finding> findings;
  checks::check_curvature(model, limits, findings);
  return findings;
}

std::vector<Finding> check_model(const Model& model, const CheckLimits& limits, Structure* assembled) {
  std::vector<Finding> findings = check_geometry(model, limits);
  checks::check_masses(model, limits, findings);
  checks::check_supports(model, limits, findings);
  if (faulty_element(findings)) return findings;
  Model free = model;
  free.supports.clear();
  Structure structure = assemble(free);
  const auto add = [&findings](std::vector<Finding> more) {
    findings.insert(findings.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  add(check_matrices(free, structure, limits));
  add(check_constraints(free, structure.dofs, limits));
  if (assembled) *assembled = std::move(structure);
  return findings;
}

}  // namespace tenon::fem
