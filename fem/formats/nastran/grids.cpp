#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem::nastran {
namespace {

constexpr int longest_chain = 500;

/// Systems and grids refer to each other, so each is found when it is first needed.
class Geometry {
 public:
  explicit Geometry(Draft& draft);
  void fill();

 private:
  struct System {
    Card card;
    int first_field;  ///< behind the system's number
    Frame frame;
    enum { unknown, open, known } state = unknown;
  };
  struct Grid {
    Card card;
    Vec3 position;
    enum { unknown, open, known } state = unknown;
  };

  void add_system(const Card& card, int field, int first_field);
  const Frame& frame(const Card& asker, int field, const char* label, long id, int depth);
  Frame build(const System& system, int depth);
  const Vec3& position(Grid& grid, int depth);
  const Vec3& position(const Card& asker, int field, const char* label, int depth);
  long with_default(const Card& grid, int field, const char* label) const;
  void guard(const Card& card, int depth) const {
    if (depth > longest_chain)
      card.refuse(0, fmt::format("hangs on a chain of more than {} coordinate systems", longest_chain),
                  "Define it relative to a system nearer to the basic one");
  }

  Draft& draft_;
  std::optional<Card> defaults_;  ///< GRDSET
  Register known_systems_{"coordinate system"}, known_grids_{"GRID"};
  std::unordered_map<long, System> systems_;
  std::vector<Grid> grids_;
  Frame basic_;
};

Geometry::Geometry(Draft& draft) : draft_(draft) {
  for (const Card& card : draft.take("GRDSET")) {
    if (defaults_ && !defaults_->same_as(card)) card.refuse(0, "stands twice", "Keep one GRDSET card");
    defaults_ = card;
  }
  for (const char* name : {"CORD2R", "CORD2C", "CORD2S"})
    for (const Card& card : draft.take(name)) add_system(card, 1, 2);
  for (const char* name : {"CORD1R", "CORD1C", "CORD1S"})
    for (const Card& card : draft.take(name)) {
      add_system(card, 1, 2);
      if (!card.blank(5)) add_system(card, 5, 6);
    }
  const std::vector<Card> grids = draft.take("GRID");
  grids_.reserve(grids.size());
  for (const Card& card : grids) {
    const long id = card.id(1, "ID");
    if (!known_grids_.admit(id, card, draft.losses)) continue;
    draft.node_of.try_emplace(id, static_cast<int>(grids_.size()));
    draft.sorted_grids.push_back(id);
    grids_.push_back({card, Vec3::Zero()});
  }
  if (!std::ranges::is_sorted(draft.sorted_grids)) std::ranges::sort(draft.sorted_grids);
}

void Geometry::add_system(const Card& card, int field, int first_field) {
  const long id = card.id(field, "CID");
  if (known_systems_.admit(id, card, draft_.losses)) systems_.emplace(id, System{card, first_field, {}});
}

const Frame& Geometry::frame(const Card& asker, int field, const char* label, long id, int depth) {
  if (id == 0) return basic_;
  const auto found = systems_.find(id);
  if (found == systems_.end())
    asker.refuse(field, fmt::format("field {} names coordinate system {}, which is not defined", label, id),
                 "Add its CORD card or correct the number");
  System& system = found->second;
  if (system.state == System::open)
    asker.refuse(field, fmt::format("field {} closes a circle: coordinate system {} is defined by itself", label, id),
                 "Define one of the systems in the basic system (RID 0)");
  if (system.state == System::unknown) {
    guard(asker, depth);
    system.state = System::open;
    system.frame = build(system, depth + 1);
    system.state = System::known;
  }
  return system.frame;
}

// A: origin, B: on the z axis, C: in the x–z plane
Frame Geometry::build(const System& system, int depth) {
  const Card& card = system.card;
  std::array<Vec3, 3> corner;
  const int first = system.first_field;
  if (card.name()[4] == '1') {
    constexpr std::array<const char*, 3> labels{"G1", "G2", "G3"};
    for (int i = 0; i < 3; ++i)
      corner[static_cast<std::size_t>(i)] = position(card, first + i, labels[static_cast<std::size_t>(i)], depth);
  } else {
    const Frame& reference = frame(card, first, "RID", card.integer(first, "RID", 0), depth);
    constexpr std::array<const char*, 9> labels{"A1", "A2", "A3", "B1", "B2", "B3", "C1", "C2", "C3"};
    for (int i = 0; i < 3; ++i) {
      Vec3 c;
      for (int j = 0; j < 3; ++j)
        c[j] = card.real(first + 1 + 3 * i + j, labels[static_cast<std::size_t>(3 * i + j)], 0.0);
      corner[static_cast<std::size_t>(i)] = reference.position(c);
    }
  }
  const Vec3 z = corner[1] - corner[0], in_plane = corner[2] - corner[0], y = z.cross(in_plane);
  if (!(y.norm() > 1e-12 * z.norm() * in_plane.norm()))
    card.refuse(0, "is no coordinate system: its three points lie on one line",
                "Give an origin, a second point on the z axis and a third off that axis");
  Frame result;
  const char kind = card.name()[5];
  result.kind = kind == 'R'   ? Frame::Kind::rectangular
                : kind == 'C' ? Frame::Kind::cylindrical
                              : Frame::Kind::spherical;
  result.origin = corner[0];
  result.axes << y.cross(z).normalized(), y.normalized(), z.normalized();
  return result;
}

const Vec3& Geometry::position(const Card& asker, int field, const char* label, int depth) {
  const int* const found = draft_.node_of.find(asker.id(field, label));
  if (!found)
    asker.refuse(field, fmt::format("field {} names GRID {}, which is not defined", label, asker.at(field)),
                 "Add the GRID card or correct the number");
  return position(grids_[static_cast<std::size_t>(*found)], depth);
}

const Vec3& Geometry::position(Grid& grid, int depth) {
  if (grid.state == Grid::known) return grid.position;
  if (grid.state == Grid::open)
    grid.card.refuse(2, "closes a circle: its coordinate system is defined by the grid itself",
                     "Give the grid in the basic system (CP 0)");
  guard(grid.card, depth);
  grid.state = Grid::open;
  const Vec3 c(grid.card.real(3, "X1", 0.0), grid.card.real(4, "X2", 0.0), grid.card.real(5, "X3", 0.0));
  grid.position = frame(grid.card, 2, "CP", with_default(grid.card, 2, "CP"), depth + 1).position(c);
  grid.state = Grid::known;
  return grid.position;
}

/// An integer field of a GRID, which GRDSET fills where it is blank.
long Geometry::with_default(const Card& grid, int field, const char* label) const {
  if (grid.blank(field) && defaults_) return defaults_->integer(field, label, 0);
  return grid.integer(field, label, 0);
}

void Geometry::fill() {
  for (auto& [id, system] : systems_) draft_.frames.emplace(id, frame(system.card, 1, "CID", id, 0));
  for (Grid& grid : grids_) {
    const Card& card = grid.card;
    const Vec3 at = position(grid, 0);
    const long cd = with_default(card, 6, "CD");
    if (cd < 0)
      card.refuse(6, fmt::format("field CD is {}: fluid points are not read", cd),
                  "Remove the fluid part of the model");
    if (with_default(card, 8, "SEID") != 0)
      draft_.losses.add("GRID SEID", "superelement of the grid: all are read as one structure");
    const Card& ps = card.blank(7) && defaults_ ? *defaults_ : card;
    draft_.permanent_spc.push_back(ps.components(7, "PS"));
    const Mat3 axes = draft_.frame_at(card, 6, "CD", cd, at);
    if (axes != Mat3::Identity()) draft_.deck.turned_nodes.push_back(card.id(1, "ID"));
    draft_.axes.push_back(axes);
    draft_.deck.mesh.points.push_back(at);
    draft_.deck.mesh.point_ids.push_back(card.id(1, "ID"));
  }
  draft_.deck.model.nodes = draft_.deck.mesh.points;
  draft_.deck.model.node_ids = draft_.deck.mesh.point_ids;
  draft_.carries.assign(grids_.size(), false);
  draft_.governed.assign(grids_.size(), 0);
}

}  // namespace

void read_grids(Draft& draft) { Geometry(draft).fill(); }

Vec3 Frame::position(const Vec3& c) const {
  constexpr double degree = std::numbers::pi / 180.0;
  const double a = c[1] * degree, b = c[2] * degree;
  Vec3 local = c;
  if (kind == Kind::cylindrical) local = {c[0] * std::cos(a), c[0] * std::sin(a), c[2]};
  if (kind == Kind::spherical) local = c[0] * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  return origin + axes * local;
}

std::optional<Mat3> Frame::axes_at(const Vec3& position) const {
  if (kind == Kind::rectangular) return axes;
  const Vec3 local = axes.transpose() * (position - origin);
  const double rho = std::hypot(local.x(), local.y());
  if (rho <= 1e-12 * (position.norm() + origin.norm())) return std::nullopt;
  const Vec3 around(-local.y() / rho, local.x() / rho, 0.0), outward = local.normalized();
  Mat3 natural;
  if (kind == Kind::cylindrical)
    natural << Vec3(local.x() / rho, local.y() / rho, 0.0), around, Vec3::UnitZ();
  else
    natural << outward, around.cross(outward), around;
  return axes * natural;
}

Mat3 Draft::frame_at(const Card& card, int field, const char* label, long id, const Vec3& position) const {
  const auto found = frames.find(id);
  if (id != 0 && found == frames.end())
    card.refuse(field, fmt::format("field {} names coordinate system {}, which is not defined", label, id),
                "Add its CORD card or correct the number");
  const std::optional<Mat3> result = id == 0 ? Mat3::Identity() : found->second.axes_at(position);
  if (!result)
    card.refuse(field,
                fmt::format("lies on the polar axis of coordinate system {}, so its directions are undefined", id),
                "Give a rectangular system");
  return *result;
}

std::optional<Axis> basic_axis(const Vec3& unit) {
  int direction = 0;
  const double largest = unit.cwiseAbs().maxCoeff(&direction);
  Vec3 rest = unit;
  rest[direction] = 0.0;
  if (rest.norm() > 1e-12 * largest) return std::nullopt;
  return Axis{direction, unit[direction] > 0.0 ? 1.0 : -1.0};
}

std::optional<Directions> basic_directions(unsigned components, const Mat3& axes) {
  unsigned result = 0;
  for (const unsigned half : {0U, 3U}) {
    const unsigned three = (components >> half) & 0b111U;
    if (three == 0 || three == 0b111U) {
      result |= three << half;
      continue;
    }
    for (int d = 0; d < 3; ++d) {
      if ((three >> d & 1U) == 0) continue;
      const auto axis = basic_axis(axes.col(d));
      if (!axis) return std::nullopt;
      result |= 1U << (static_cast<unsigned>(axis->direction) + half);
    }
  }
  return static_cast<Directions>(result);
}

}  // namespace tenon::fem::nastran
