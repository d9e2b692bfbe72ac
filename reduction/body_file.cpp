#include "reduction/body_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"
#include "fem/formats/file_bytes.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/matrix_rows.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "tenon reduced body";
constexpr const char* remake = "Write it again with 'tenon reduce'";

constexpr std::array<std::pair<const char*, const char*>, 5> unit_system{
    {{"length", "m"}, {"mass", "kg"}, {"time", "s"}, {"angle", "rad"}, {"vectors", "linear first: x y z rx ry rz"}}};

Json units() {
  Json all = Json::object();
  for (const auto& [key, value] : unit_system) all[key] = value;
  return all;
}

Json to_json(const Eigen::Ref<const Eigen::MatrixXd>& A) { return matrix_rows<Json>(A); }

Json list(const Eigen::Ref<const Eigen::VectorXd>& v) {
  Json values = Json::array();
  for (const double x : v) values.push_back(x);
  return values;
}

// Reads with a path for messages: "ports[2].Phi".
class Reader {
 public:
  Reader(const Json& node, std::string path, const std::string& file)
      : node_(node), path_(std::move(path)), file_(file) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError({.file = file_}, path_.empty() ? what : fmt::format("'{}' {}", path_, what), remake);
  }
  Reader operator[](const char* key) const {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (!node_.is_object() || !node_.contains(key)) Reader(node_, path, file_).refuse("is missing");
    return {node_[key], path, file_};
  }
  std::vector<Reader> items() const {
    if (!node_.is_array()) refuse("is not a list");
    std::vector<Reader> all;
    for (std::size_t k = 0; k < node_.size(); ++k) all.emplace_back(node_[k], fmt::format("{}[{}]", path_, k), file_);
    return all;
  }
  bool null() const { return node_.is_null(); }
  double number() const {
    if (!node_.is_number()) refuse("is not a finite number");
    return node_.get<double>();
  }
  int integer() const {
    if (!node_.is_number_integer()) refuse("is not a whole number");
    return node_.get<int>();
  }
  std::string text() const {
    if (!node_.is_string()) refuse("is not a text");
    return node_.get<std::string>();
  }
  Eigen::VectorXd vector(Eigen::Index size) const {
    const auto all = items();
    if (size >= 0 && static_cast<Eigen::Index>(all.size()) != size)
      refuse(fmt::format("has {} numbers where {} are expected", all.size(), size));
    Eigen::VectorXd v(static_cast<Eigen::Index>(all.size()));
    for (std::size_t k = 0; k < all.size(); ++k) v[static_cast<Eigen::Index>(k)] = all[k].number();
    return v;
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) const {
    const auto all = items();
    if (static_cast<Eigen::Index>(all.size()) != rows)
      refuse(fmt::format("has {} rows where {} are expected", all.size(), rows));
    Eigen::MatrixXd A(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i) A.row(i) = all[static_cast<std::size_t>(i)].vector(columns);
    return A;
  }

 private:
  const Json& node_;
  std::string path_;
  const std::string& file_;
};

Json certificate_json(const Certificate& c) {
  return {{"basis", c.basis},
          {"source", c.source},
          {"source_hash", c.source_hash},
          {"nodes", c.nodes},
          {"elements", c.elements},
          {"dofs", c.dofs},
          {"modes_found", c.modes_found},
          {"modes_counted", c.modes_counted},
          {"count_shift_rad2_s2", c.count_shift},
          {"max_residual", c.max_residual},
          {"max_orthogonality", c.max_orthogonality},
          {"valid_below_rad_s", c.valid_below},
          {"left_out", c.left_out}};
}

Certificate read_certificate(const Reader& r) {
  Certificate c;
  c.basis = r["basis"].text();
  c.source = r["source"].text();
  c.source_hash = r["source_hash"].text();
  c.nodes = r["nodes"].integer();
  c.elements = r["elements"].integer();
  c.dofs = r["dofs"].integer();
  c.modes_found = r["modes_found"].integer();
  c.modes_counted = r["modes_counted"].integer();
  c.count_shift = r["count_shift_rad2_s2"].number();
  c.max_residual = r["max_residual"].number();
  c.max_orthogonality = r["max_orthogonality"].number();
  c.valid_below = r["valid_below_rad_s"].number();
  for (const Reader& sentence : r["left_out"].items()) c.left_out.push_back(sentence.text());
  return c;
}

Json integrals_json(const ShapeIntegrals& s) {
  const NodeGyroscopics& g = s.nodes;
  Json nodes = nullptr;
  if (s.has_nodes())
    nodes = {{"J", to_json(g.J)}, {"C0", to_json(g.C0)}, {"A", to_json(g.A)},
             {"T", to_json(g.T)}, {"B", to_json(g.B)},   {"U", to_json(g.U)}};
  return {{"J1", to_json(s.J1)}, {"J2", to_json(s.J2)}, {"C1", to_json(s.C1)}, {"nodes", std::move(nodes)}};
}

ShapeIntegrals read_integrals(const Reader& r, Eigen::Index n) {
  ShapeIntegrals s{r["J1"].matrix(6, n), r["J2"].matrix(6 * n, n), r["C1"].matrix(3 * n, n), {}};
  if (const Reader g = r["nodes"]; !g.null())
    s.nodes = {g["J"].matrix(3, 3),     g["C0"].matrix(3, n),    g["A"].matrix(3, 3 * n),
               g["T"].matrix(3 * n, n), g["B"].matrix(3 * n, n), g["U"].matrix(n * n, n)};
  return s;
}

Json stiffening_json(const GeometricStiffness& g) { return {{"K", to_json(g.K)}, {"spin", to_json(g.spin)}}; }

Json parse(const std::filesystem::path& path) {
  const std::string text = fem::read_bytes(path);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t end = std::min<std::size_t>(error.byte, text.size());
    const std::size_t line_start = end == 0 ? 0 : text.rfind('\n', end - 1) + 1;  // npos + 1 = 0
    const long line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(line_start), '\n');
    throw InputError({path.string(), line, static_cast<long>(end - std::min(end, line_start))},
                     text.empty() ? "the file is empty" : "this is not JSON from here on", remake);
  } catch (const Json::exception& error) {
    throw InputError({.file = path.string()}, fmt::format("a number cannot be held ({})", error.what()), remake);
  }
}

ReducedBody from_json(const Reader& r) {
  if (const std::string format = r["format"].text(); format != format_name)
    r["format"].refuse(fmt::format("is '{}', not '{}'", format, format_name));
  const int version = r["version"].integer();
  if (version < oldest_body_file_version || version > body_file_version)
    r["version"].refuse(fmt::format("is {}; this program reads versions {} to {}", version, oldest_body_file_version,
                                    body_file_version));
  for (const auto& [key, value] : unit_system)
    if (const std::string unit = r["units"][key].text(); unit != value)
      r["units"][key].refuse(fmt::format("is '{}', not '{}'", unit, value));
  ReducedBody body;
  body.name = r["name"].text();
  const std::string kind = r["kind"].text();
  if (kind != "cantilever" && kind != "free-free") r["kind"].refuse(fmt::format("is '{}'", kind));
  body.kind = kind == "cantilever" ? ReducedBody::Kind::cantilever : ReducedBody::Kind::free_free;
  body.reference = r["reference"].vector(3);
  body.parent = r["parent"].integer();
  body.omega = r["omega_rad_s"].vector(-1);
  const Eigen::Index n = body.omega.size();
  body.zeta = r["zeta"].vector(n);
  const bool full = !r["C"].items().empty();
  body.C = r["C"].matrix(full ? n : 0, full ? n : 0);
  body.L = r["L"].matrix(n, 6);
  body.D = r["D"].matrix(6, 6);
  for (const Reader& port : r["ports"].items())
    body.ports.push_back(
        {port["name"].text(), port["position"].vector(3), port["axes"].matrix(3, 3), port["Phi"].matrix(6, n)});
  body.certificate = read_certificate(r["certificate"]);
  for (const Reader& point : r["node_positions"].items()) body.node_positions.emplace_back(point.vector(3));
  const auto rows = static_cast<Eigen::Index>(r["node_shapes"].items().size());
  if (rows != 0 && rows != 6 * static_cast<Eigen::Index>(body.node_positions.size()))
    r["node_shapes"].refuse(fmt::format("has {} rows for {} nodes", rows, body.node_positions.size()));
  body.node_shapes = r["node_shapes"].matrix(rows, rows == 0 ? 0 : n);
  if (version < 3) return body;
  if (const Reader s = r["shape_integrals"]; !s.null())
    body.shape_integrals = std::make_shared<const ShapeIntegrals>(read_integrals(s, n));
  if (const Reader g = r["geometric_stiffness"]; !g.null()) {
    const auto loads = GeometricStiffness::inertia_loads + 6 * static_cast<Eigen::Index>(body.ports.size());
    body.stiffening = std::make_shared<const GeometricStiffness>(
        GeometricStiffness{g["K"].matrix((n + 3) * (n + 3), loads), g["spin"].matrix(6, 6)});
  }
  return body;
}

}  // namespace

void write_body(const std::filesystem::path& path, const ReducedBody& body) {
  check(body);
  Json ports = Json::array();
  for (const BodyPort& port : body.ports)
    ports.push_back({{"name", port.name},
                     {"position", list(port.position)},
                     {"axes", to_json(port.axes)},
                     {"Phi", to_json(port.Phi)}});
  Json positions = Json::array();
  for (const Vec3& x : body.node_positions) positions.push_back(list(x));
  const Json file = {{"format", format_name},
                     {"version", body_file_version},
                     {"units", units()},
                     {"name", body.name},
                     {"kind", body.kind == ReducedBody::Kind::cantilever ? "cantilever" : "free-free"},
                     {"certificate", certificate_json(body.certificate)},
                     {"reference", list(body.reference)},
                     {"parent", body.parent},
                     {"omega_rad_s", list(body.omega)},
                     {"zeta", list(body.zeta)},
                     {"C", to_json(body.C)},
                     {"L", to_json(body.L)},
                     {"D", to_json(body.D)},
                     {"ports", std::move(ports)},
                     {"node_positions", std::move(positions)},
                     {"node_shapes", to_json(body.node_shapes)},
                     {"shape_integrals", body.shape_integrals ? integrals_json(*body.shape_integrals) : Json()},
                     {"geometric_stiffness", body.stiffening ? stiffening_json(*body.stiffening) : Json()}};
  fem::AtomicFile out(path);
  out.stream() << file << '\n';  // shortest digits that read back to the same double
  out.commit();
}

ReducedBody read_body(const std::filesystem::path& path) {
  const std::string file = path.string();
  const Json json = parse(path);
  ReducedBody body = from_json(Reader(json, "", file));
  try {
    check(body);
  } catch (const ModelError& error) {
    throw InputError({.file = file}, error.what(), remake);
  }
  return body;
}

std::string file_hash(const std::filesystem::path& path) {
  const fem::MappedFile file(path);
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char byte : file.bytes()) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
  return fmt::format("fnv1a64:{:016x}", hash);
}

}  // namespace tenon::reduction
