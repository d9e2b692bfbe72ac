#include "fem/formats/write_gmsh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "fem/formats/gmsh/content.hpp"

namespace tenon::fem {
namespace gmsh {
namespace {

/// Text or the bytes of this machine, by the same calls.
class Output {
 public:
  Output(std::ostream& stream, bool binary) : stream_(stream), binary_(binary) {}

  bool binary() const { return binary_; }
  void line(std::string_view text) {
    fmt::format_to(std::back_inserter(text_), "{}\n", text);
    flush();
  }
  template <class T>
  void put(T value) {
    if (binary_) {
      const char* bytes = reinterpret_cast<const char*>(&value);
      text_.append(bytes, bytes + sizeof value);
    } else {
      fmt::format_to(std::back_inserter(text_), "{} ", value);
    }
  }
  void integer(int value) { put(value); }
  void size(std::size_t value) { put(value); }
  void real(double value) { put(value); }
  /// Ends a line of text; nothing between the records of a binary file.
  void end() {
    if (!binary_) text_.push_back('\n');
    flush();
  }
  /// Ends the data of a section.
  void close(std::string_view section) {
    if (binary_) text_.push_back('\n');
    line(section);
  }
  void write() {
    stream_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

 private:
  void flush() {
    if (text_.size() >= 1 << 16) write();
  }

  std::ostream& stream_;
  bool binary_;
  fmt::memory_buffer text_;
};

/// Cells of one type in the same groups, and the discrete entity that Gmsh wants for them.
struct EntityBlock {
  int type = 0;  ///< Gmsh's
  CellType cell = CellType::vertex;
  std::vector<std::pair<int, int>> cells;  ///< block and place in it; of made vertices: −1 and the point
};
struct Entity {
  int dimension = 0, tag = 0;
  std::vector<int> groups;
  Eigen::AlignedBox3d box;
  std::vector<EntityBlock> blocks;
};

/// The mesh's numbers if they are positive, each stands once and all fit the 4 bytes that data has for them, else
/// 1, 2, ...
std::vector<long> numbers(std::vector<long> own, std::size_t n) {
  std::vector<long> sorted = own;
  std::ranges::sort(sorted);
  constexpr long most = std::numeric_limits<int>::max();
  const bool good = own.size() == n && (n == 0 || (sorted.front() > 0 && sorted.back() <= most)) &&
                    std::ranges::adjacent_find(sorted) == sorted.end();
  if (!good) {
    own.resize(n);
    for (std::size_t i = 0; i < n; ++i) own[i] = static_cast<long>(i) + 1;
  }
  return own;
}

const ElementType& element_type_of(CellType type) {
  for (int k = 1;; ++k)
    if (const ElementType* e = element_type(k); e->type == type) return *e;
}

void check_name(const char* of, const std::string& name) {
  if (name.empty()) throw ModelError(fmt::format("a {} has no name", of), "Give it one");
  if (name.find_first_of("\"\n\r") != std::string::npos)
    throw ModelError(
        fmt::format("the name of {} '{}' holds a quote or a line end, which .msh has no way to write", of, name),
        "Give it another name");
}

class Writer {
 public:
  Writer(const Mesh& mesh, std::ostream& stream, bool binary) : mesh_(mesh), out_(stream, binary) {}

  void write() {
    check();
    number();
    name_groups();
    make_entities();
    header();
    write_entities();
    write_nodes();
    write_elements();
    for (const auto& [name, values] : mesh_.point_data) write_field("NodeData", name, point_numbers_, values);
    for (const auto& [name, blocks] : mesh_.cell_data) write_cell_data(name, blocks);
    out_.write();
  }

 private:
  void check() const;
  void number();
  void name_groups();
  int group(int dimension, const std::string& name);
  void make_entities();
  Entity& entity(int dimension, std::vector<int> groups);
  void add_cell(int block, int place, const std::vector<int>& groups);
  const int* nodes_of(const std::pair<int, int>& cell) const;
  void header();
  void write_entities();
  void write_nodes();
  void write_elements();
  void write_cell_data(const std::string& name, const std::vector<Eigen::MatrixXd>& blocks);
  void write_field(const char* section, const std::string& name, const std::vector<long>& ids,
                   const Eigen::MatrixXd& values);
  void write_columns(const char* section, const std::string& name, const std::vector<long>& ids,
                     const Eigen::Ref<const Eigen::MatrixXd>& values);

  const Mesh& mesh_;
  Output out_;
  std::vector<long> point_numbers_, cell_numbers_;  ///< cells of all blocks, one after the other; then made vertices
  std::vector<std::size_t> first_;                  ///< of a block in cell_numbers_
  std::map<DimTag, std::string> names_;
  std::map<std::pair<int, std::string>, int> tags_;
  std::map<std::pair<int, std::vector<int>>, std::size_t> entity_of_;  // until they are sorted
  std::vector<Entity> entities_;
  std::vector<int> made_;  ///< points that got a vertex cell
};

void Writer::check() const {
  const auto fail = [](const std::string& what) {
    throw ModelError(what, "Give one entry a block and point of the mesh");
  };
  for (const auto& [name, points] : mesh_.point_sets)
    for (const int p : points)
      if (p < 0 || p >= static_cast<int>(mesh_.points.size()))
        fail(fmt::format("point set '{}' has no place {} in the mesh", name, p));
  for (const auto& [name, blocks] : mesh_.cell_sets) {
    if (blocks.size() > mesh_.cells.size()) fail(fmt::format("cell set '{}' has more blocks than the mesh", name));
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (const int c : blocks[b])
        if (c < 0 || c >= mesh_.cells[b].size())
          fail(fmt::format("cell set '{}' has no cell {} in block {}", name, c, b + 1));
  }
  for (const auto& [name, values] : mesh_.point_data)
    if (values.rows() != static_cast<Eigen::Index>(mesh_.points.size()))
      fail(fmt::format("point data '{}' has {} rows for {} points", name, values.rows(), mesh_.points.size()));
  for (const auto& [name, blocks] : mesh_.cell_data) {
    if (blocks.size() != mesh_.cells.size())
      fail(fmt::format("cell data '{}' has {} blocks, the mesh {}", name, blocks.size(), mesh_.cells.size()));
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (blocks[b].size() > 0 && blocks[b].rows() != mesh_.cells[b].size())
        fail(fmt::format("cell data '{}' has {} rows for {} cells", name, blocks[b].rows(), mesh_.cells[b].size()));
  }
  const auto n_points = static_cast<int>(mesh_.points.size());
  for (const CellBlock& block : mesh_.cells)
    for (const int node : block.nodes)
      if (node < 0 || node >= n_points)
        fail(fmt::format("a {} names point {} of {}", tenon::fem::name(block.type), node, n_points));
  for (const Vec3& x : mesh_.points)
    if (!x.allFinite()) throw ModelError("a point lies nowhere: its coordinates are not finite", "Correct the mesh");
}

void Writer::number() {
  point_numbers_ = numbers(mesh_.point_ids, mesh_.points.size());
  std::vector<long> own;
  std::size_t count = 0;
  for (const CellBlock& block : mesh_.cells) {
    first_.push_back(count);
    count += static_cast<std::size_t>(block.size());
    own.insert(own.end(), block.ids.begin(), block.ids.end());
  }
  cell_numbers_ = numbers(std::move(own), count);
}

/// The tag that the file had, else the next free one of the dimension.
int Writer::group(int dimension, const std::string& name) {
  const auto [entry, added] = tags_.try_emplace({dimension, name}, 0);
  if (!added) return entry->second;
  const auto known = mesh_.field_data.find(name);
  int tag = known != mesh_.field_data.end() && known->second.second == dimension ? known->second.first : 0;
  if (tag <= 0 || names_.contains({dimension, tag}))
    for (tag = 1; names_.contains({dimension, tag}); ++tag) {
    }
  names_.emplace(DimTag{dimension, tag}, name);
  return entry->second = tag;
}

void Writer::name_groups() {
  for (const auto& [name, blocks] : mesh_.cell_sets)
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (!blocks[b].empty()) group(dimension(mesh_.cells[b].type), name);
}

Entity& Writer::entity(int dimension, std::vector<int> groups) {
  const auto [entry, added] = entity_of_.try_emplace({dimension, groups}, entities_.size());
  if (added) {
    int tag = 1;
    for (const Entity& e : entities_) tag += e.dimension == dimension ? 1 : 0;
    entities_.push_back({dimension, tag, std::move(groups), {}, {}});
  }
  return entities_[entry->second];
}

void Writer::add_cell(int block, int place, const std::vector<int>& groups) {
  const CellType type = block < 0 ? CellType::vertex : mesh_.cells[static_cast<std::size_t>(block)].type;
  Entity& e = entity(dimension(type), groups);
  const int number = element_type_of(type).number;
  if (e.blocks.empty() || e.blocks.back().type != number) {
    const auto known = std::ranges::find(e.blocks, number, &EntityBlock::type);
    if (known == e.blocks.end())
      e.blocks.push_back({number, type, {}});
    else
      std::rotate(known, known + 1, e.blocks.end());
  }
  e.blocks.back().cells.emplace_back(block, place);
  const int* nodes = nodes_of(e.blocks.back().cells.back());
  for (int i = 0; i < node_count(type); ++i) e.box.extend(mesh_.points[static_cast<std::size_t>(nodes[i])]);
}

const int* Writer::nodes_of(const std::pair<int, int>& cell) const {
  if (cell.first < 0) return &made_[static_cast<std::size_t>(cell.second)];
  const CellBlock& block = mesh_.cells[static_cast<std::size_t>(cell.first)];
  return &block.nodes[static_cast<std::size_t>(cell.second * node_count(block.type))];
}

// One entity for each list of groups that cells of a dimension share.
void Writer::make_entities() {
  for (std::size_t b = 0; b < mesh_.cells.size(); ++b) {
    const CellBlock& block = mesh_.cells[b];
    std::vector<std::vector<int>> groups(static_cast<std::size_t>(block.size()));
    for (const auto& [name, blocks] : mesh_.cell_sets)
      if (b < blocks.size())
        for (const int c : blocks[b]) groups[static_cast<std::size_t>(c)].push_back(group(dimension(block.type), name));
    for (int c = 0; c < block.size(); ++c) {
      auto& list = groups[static_cast<std::size_t>(c)];
      std::ranges::sort(list);
      list.erase(std::unique(list.begin(), list.end()), list.end());
      add_cell(static_cast<int>(b), c, list);
    }
  }
  // vertices for the points of sets that have none; a point in several sets gets one
  std::map<int, std::vector<int>> alone;
  for (const auto& [name, points] : mesh_.point_sets) {
    std::set<int> missing(points.begin(), points.end());
    if (const auto cells = mesh_.cell_sets.find(name); cells != mesh_.cell_sets.end())
      for (std::size_t b = 0; b < cells->second.size(); ++b)
        if (mesh_.cells[b].type == CellType::vertex)
          for (const int c : cells->second[b]) missing.erase(mesh_.cells[b].nodes[static_cast<std::size_t>(c)]);
    for (const int p : missing) alone[p].push_back(group(0, name));
  }
  made_.reserve(alone.size());
  const long last = cell_numbers_.empty() ? 0 : *std::ranges::max_element(cell_numbers_);
  for (auto& [point, groups] : alone) {
    std::ranges::sort(groups);
    made_.push_back(point);
    cell_numbers_.push_back(last + static_cast<long>(made_.size()));
    add_cell(-1, static_cast<int>(made_.size()) - 1, groups);
  }
  if (entities_.empty() && !mesh_.points.empty()) entity(0, {}).box.extend(mesh_.points[0]);
  std::ranges::stable_sort(entities_, {}, &Entity::dimension);
}

void Writer::header() {
  out_.line("$MeshFormat");
  out_.line(fmt::format("4.1 {} 8", out_.binary() ? 1 : 0));
  if (out_.binary()) {
    out_.integer(1);
    out_.close("$EndMeshFormat");
  } else {
    out_.line("$EndMeshFormat");
  }
  if (names_.empty()) return;
  out_.line("$PhysicalNames");
  out_.line(std::to_string(names_.size()));
  for (const auto& [dim_tag, name] : names_) {
    check_name("set", name);
    out_.line(fmt::format("{} {} \"{}\"", dim_tag.first, dim_tag.second, name));
  }
  out_.line("$EndPhysicalNames");
}

void Writer::write_entities() {
  out_.line("$Entities");
  std::array<std::size_t, 4> counts{};
  for (const Entity& e : entities_) ++counts[static_cast<std::size_t>(e.dimension)];
  for (const std::size_t n : counts) out_.size(n);
  out_.end();
  for (const Entity& e : entities_) {
    out_.integer(e.tag);
    for (const double x : e.box.min()) out_.real(x);
    if (e.dimension > 0)
      for (const double x : e.box.max()) out_.real(x);
    out_.size(e.groups.size());
    for (const int g : e.groups) out_.integer(g);
    if (e.dimension > 0) out_.size(0);  // entities that bound it
    out_.end();
  }
  out_.close("$EndEntities");
}

void Writer::write_nodes() {
  out_.line("$Nodes");
  const std::size_t n = point_numbers_.size();
  const auto [least, most] = std::ranges::minmax_element(point_numbers_);
  out_.size(n == 0 ? 0 : 1);
  out_.size(n);
  out_.size(n == 0 ? 0 : static_cast<std::size_t>(*least));
  out_.size(n == 0 ? 0 : static_cast<std::size_t>(*most));
  out_.end();
  if (n > 0) {  // all on one entity, of the highest dimension
    const Entity& e = entities_.back();
    out_.integer(e.dimension);
    out_.integer(e.tag);
    out_.integer(0);
    out_.size(n);
    out_.end();
    for (const long number : point_numbers_) {
      out_.size(static_cast<std::size_t>(number));
      out_.end();
    }
    for (const Vec3& x : mesh_.points) {
      for (const double c : x) out_.real(c);
      out_.end();
    }
  }
  out_.close("$EndNodes");
}

void Writer::write_elements() {
  out_.line("$Elements");
  std::size_t blocks = 0;
  for (const Entity& e : entities_) blocks += e.blocks.size();
  const auto [least, most] = std::ranges::minmax_element(cell_numbers_);
  const bool none = cell_numbers_.empty();
  out_.size(blocks);
  out_.size(cell_numbers_.size());
  out_.size(none ? 0 : static_cast<std::size_t>(*least));
  out_.size(none ? 0 : static_cast<std::size_t>(*most));
  out_.end();
  const std::size_t made_from = cell_numbers_.size() - made_.size();
  for (const Entity& e : entities_)
    for (const EntityBlock& block : e.blocks) {
      const ElementType& type = element_type_of(block.cell);
      out_.integer(e.dimension);
      out_.integer(e.tag);
      out_.integer(type.number);
      out_.size(block.cells.size());
      out_.end();
      std::array<std::size_t, 27> ordered{};
      for (const auto& cell : block.cells) {
        const auto place = static_cast<std::size_t>(cell.second);
        out_.size(static_cast<std::size_t>(
            cell_numbers_[cell.first < 0 ? made_from + place : first_[static_cast<std::size_t>(cell.first)] + place]));
        const int* nodes = nodes_of(cell);
        const auto n = static_cast<std::size_t>(node_count(block.cell));
        for (std::size_t i = 0; i < n; ++i)
          ordered[type.vtk_order[i]] = static_cast<std::size_t>(point_numbers_[static_cast<std::size_t>(nodes[i])]);
        for (std::size_t i = 0; i < n; ++i) out_.size(ordered[i]);
        out_.end();
      }
    }
  out_.close("$EndElements");
}

// in the order of the elements, on which some readers rely
void Writer::write_cell_data(const std::string& name, const std::vector<Eigen::MatrixXd>& blocks) {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& values : blocks) columns = std::max(columns, values.cols());
  std::vector<long> ids;
  Eigen::MatrixXd all = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(cell_numbers_.size() - made_.size()),
                                                  columns, std::numeric_limits<double>::quiet_NaN());
  for (const Entity& e : entities_)
    for (const EntityBlock& block : e.blocks)
      for (const auto& [b, place] : block.cells) {
        if (b < 0) continue;
        const Eigen::MatrixXd& values = blocks[static_cast<std::size_t>(b)];
        if (values.size() > 0) all.row(static_cast<Eigen::Index>(ids.size())).head(values.cols()) = values.row(place);
        ids.push_back(cell_numbers_[first_[static_cast<std::size_t>(b)] + static_cast<std::size_t>(place)]);
      }
  write_field("ElementData", name, ids, all);
}

void Writer::write_field(const char* section, const std::string& name, const std::vector<long>& ids,
                         const Eigen::MatrixXd& values) {
  check_name("data", name);
  if (values.cols() == 0) return;
  if (values.array().isInf().any())
    throw ModelError(fmt::format("data '{}' hold infinity", name), "Leave out what is not known as NaN");
  if (values.cols() <= 9) return write_columns(section, name, ids, values);
  for (Eigen::Index c = 0; c < values.cols(); ++c)
    write_columns(section, fmt::format("{}_{}", name, c + 1), ids, values.col(c));
}

void Writer::write_columns(const char* section, const std::string& name, const std::vector<long>& ids,
                           const Eigen::Ref<const Eigen::MatrixXd>& values) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    if (!values.row(r).hasNaN()) rows.push_back(r);
  const Eigen::Index components = values.cols() <= 1 ? 1 : values.cols() <= 3 ? 3 : 9;
  out_.line(fmt::format("${}", section));
  out_.line(fmt::format("1\n\"{}\"\n1\n0\n3\n0\n{}\n{}", name, components, rows.size()));
  for (const Eigen::Index r : rows) {
    out_.integer(static_cast<int>(ids[static_cast<std::size_t>(r)]));
    for (Eigen::Index c = 0; c < components; ++c) out_.real(c < values.cols() ? values(r, c) : 0.0);
    out_.end();
  }
  out_.close(fmt::format("$End{}", section));
}

}  // namespace
}  // namespace gmsh

void write_gmsh(const std::filesystem::path& path, const Mesh& mesh, const GmshOptions& options) {
  AtomicFile file(path);
  gmsh::Writer(mesh, file.stream(), options.binary).write();
  file.commit();
}

}  // namespace tenon::fem
