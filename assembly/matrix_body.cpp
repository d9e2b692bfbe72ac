#include "assembly/matrix_body.hpp"

#include <algorithm>

#include "fem/formats/matrices/abaqus.hpp"
#include "fem/formats/matrices/calculix.hpp"
#include "fem/formats/matrices/matrix_market.hpp"
#include "fem/formats/matrices/superelement.hpp"
#include "fem/formats/read_mesh.hpp"

namespace tenon::assembly {
namespace {

using Program = MatrixFiles::Program;

fem::MatrixData read_data(const MatrixFiles& files) {
  switch (files.program) {
    case Program::nastran:
      return fem::read_nastran_superelement(files.job.string());
    case Program::calculix:
      return fem::read_calculix_matrices(files.job.string());
    case Program::abaqus:
      return fem::read_abaqus_matrices(files.job.string());
    default:
      return fem::read_market_matrices(files.K, files.M, files.labels);
  }
}

/// Places and sets of the nodes that have rows.
void add_places(const fem::Mesh& mesh, fem::MatrixData& data) {
  std::map<long, int> point;
  for (std::size_t i = 0; i < mesh.point_ids.size(); ++i) point.emplace(mesh.point_ids[i], static_cast<int>(i));
  std::vector<char> has_row(mesh.points.size(), 0);
  for (const fem::MatrixRow& row : data.rows)
    if (const auto found = point.find(row.node); !row.scalar && found != point.end()) {
      data.positions[row.node] = mesh.points[static_cast<std::size_t>(found->second)];
      has_row[static_cast<std::size_t>(found->second)] = 1;
    }
  for (const auto& [name, points] : mesh.point_sets)
    for (const int p : points)
      if (has_row[static_cast<std::size_t>(p)] != 0)
        data.sets[name].push_back(mesh.point_ids[static_cast<std::size_t>(p)]);
}

std::filesystem::path with_ending(std::filesystem::path name, const char* ending) { return name += ending; }

}  // namespace

fem::MatrixModel read_matrix_body(const MatrixFiles& files, const Units& units) {
  fem::MatrixData data = read_data(files);
  if (!files.deck.empty()) add_places(fem::read_mesh(files.deck), data);
  fem::MatrixModel body = fem::make_model(std::move(data));
  body.model = to_si(std::move(body.model), units);
  return body;
}

std::vector<std::filesystem::path> files_read(const MatrixFiles& files) {
  namespace fs = std::filesystem;
  std::vector<fs::path> candidates{files.K, files.M, files.labels, files.job, files.deck};
  for (const char* ending : {".sti", ".mas", ".dof"}) candidates.push_back(with_ending(files.job, ending));
  if (files.program == Program::nastran)
    for (const char* ending : {".op4", ".pch"}) candidates.push_back(fs::path(files.job).replace_extension(ending));
  std::error_code fault;
  std::vector<fs::path> parts;  // a folder lists its files in no order
  const fs::path folder = files.job.has_parent_path() ? files.job.parent_path() : fs::path(".");
  if (files.program == Program::abaqus)
    for (const auto& entry : fs::directory_iterator(folder, fault))
      for (const char* part : {"_STIF", "_MASS"})
        if (entry.path().filename().string().starts_with(files.job.filename().string() + part))
          parts.push_back(entry.path());
  std::ranges::sort(parts);
  candidates.insert(candidates.end(), parts.begin(), parts.end());
  std::vector<fs::path> found;
  for (const fs::path& file : candidates)
    if (!file.empty() && fs::is_regular_file(file, fault) && std::ranges::find(found, file) == found.end())
      found.push_back(file);
  return found;
}

}  // namespace tenon::assembly
