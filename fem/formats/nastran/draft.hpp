#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "fem/formats/nastran.hpp"
#include "fem/formats/nastran/cards.hpp"

/// What the steps of the reader share while cards become a mesh and a model.
namespace tenon::fem::nastran {

/// Losses as they are found; equal ones are counted together.
class LossReport {
 public:
  void add(const std::string& name, const std::string& note) { entry(name, note); }
  /// A loss that changes stiffness or mass, and the place of its first card.
  void add_physical(const std::string& name, const std::string& note, const Place& place);

  std::vector<Loss> losses() const;
  /// Throws InputError naming every physical loss, at the place of the first.
  void refuse_physical() const;

 private:
  struct Entry {
    Loss loss;
    Place first;
  };
  Entry& entry(const std::string& name, const std::string& note);
  std::vector<Entry> entries_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;
};

/// Values by the file's numbers: 16 to 24 bytes each where the numbers come in rising order, as they mostly do.
template <class Value>
class NumberMap {
 public:
  void reserve(std::size_t n) { rising_.reserve(n); }
  /// The value under that number, and whether it is new there.
  std::pair<const Value*, bool> try_emplace(long number, const Value& value) {
    if (const Value* const known = find(number)) return {known, false};
    if (rising_.empty() || number > rising_.back().first) {
      rising_.emplace_back(number, value);
      return {&rising_.back().second, true};
    }
    return {&others_.try_emplace(number, value).first->second, true};
  }
  bool contains(long number) const { return find(number) != nullptr; }
  /// Nothing when there is no such number.
  const Value* find(long number) const {
    if (rising_.empty()) return nullptr;
    if (number <= rising_.back().first) {
      // numbers without gaps are found at once
      const auto step = static_cast<std::size_t>(number - rising_.front().first);
      if (number >= rising_.front().first && step < rising_.size() && rising_[step].first == number)
        return &rising_[step].second;
      const auto at = std::ranges::lower_bound(rising_, number, {}, &std::pair<long, Value>::first);
      if (at != rising_.end() && at->first == number) return &at->second;
    }
    const auto other = others_.find(number);
    return other == others_.end() ? nullptr : &other->second;
  }

 private:
  std::vector<std::pair<long, Value>> rising_;
  std::unordered_map<long, Value> others_;
};

/// Cards that carry an identification number, each number once. A second identical card is a loss, a different one an
/// InputError that names both places.
class Register {
 public:
  explicit Register(std::string kind) : kind_(std::move(kind)) {}
  /// True when the number is new.
  bool admit(long id, const Card& card, LossReport& losses);
  const Card* find(long id) const { return cards_.find(id); }

 private:
  std::string kind_;
  NumberMap<Card> cards_;
};

/// Ids first .. last, as THRU and single numbers give them; never expanded, so a huge range costs nothing.
struct Range {
  long first = 0, last = 0;
};

/// Scalar points and the q-set, kept as the ranges of the cards.
struct ScalarPoints {
  std::vector<Range> points, q_set;
  std::vector<Range> held;  ///< by the selected SPC set
  bool contains(long id) const { return any_in({id, id}); }
  bool any_in(const Range& range) const;
  bool in_q_set(long id) const;
  bool is_held(long id) const;
};

/// The sets of SPC, MPC and NSM cards to apply, and where they were chosen.
struct Choice {
  long set = 0;
  Place place;
};
struct Selection {
  std::optional<Choice> spc, mpc, nsm;
  bool has_case_control = false;
  bool material_temperature = false;  ///< TEMPERATURE(MATERIAL), (INITIAL), (BOTH)
};

/// A coordinate system in the basic frame.
struct Frame {
  enum class Kind { rectangular, cylindrical, spherical };
  Kind kind = Kind::rectangular;
  Vec3 origin = Vec3::Zero();
  Mat3 axes = Mat3::Identity();

  /// Basic position of coordinates (x y z), (r θ z) or (r θ φ), angles in degrees.
  Vec3 position(const Vec3& coordinates) const;
  /// Directions of growing coordinates at a basic position, as columns; nothing on the polar axis.
  std::optional<Mat3> axes_at(const Vec3& position) const;
};

/// One matrix of axes a node; equal ones that follow each other are kept once.
class NodeAxes {
 public:
  void push_back(const Mat3& axes) {
    if (distinct_.empty() || distinct_.back() != axes) distinct_.push_back(axes);
    index_.push_back(static_cast<int>(distinct_.size()) - 1);
  }
  const Mat3& operator[](std::size_t node) const { return distinct_[static_cast<std::size_t>(index_[node])]; }

 private:
  std::vector<Mat3> distinct_;
  std::vector<int> index_;
};

struct Draft {
  std::map<std::string, std::vector<Card>> cards;  ///< by name, those still to be understood
  LossReport losses;
  NastranDeck deck;
  Selection selection;
  ScalarPoints scalars;

  std::unordered_map<long, Frame> frames;  ///< by CORD number, all but the basic one
  NumberMap<int> node_of;                  ///< GRID number → node
  std::vector<long> sorted_grids;          ///< for THRU
  NodeAxes axes;                           ///< of the displacement frame CD, a node each
  std::vector<unsigned> permanent_spc;     ///< PS of GRID, a node each
  std::vector<bool> carries;               ///< an element or the independent end of a link attaches to the node
  std::vector<unsigned> governed;          ///< basic directions that a link makes dependent, a node each
  std::map<long, int> scalar_node;         ///< SPOINT number → the node made for it

  /// The cards of that name, which then count as understood.
  std::vector<Card> take(const std::string& name);
  /// Node of a GRID number that a card names; throws InputError at the field.
  int node(const Card& card, int field, const char* label) const;
  /// Axes of a coordinate system at a basic position; throws InputError at the field that names it.
  Mat3 frame_at(const Card& card, int field, const char* label, long id, const Vec3& position) const;
  /// A node that is no GRID: at `position`, with basic axes.
  int make_node(const Vec3& position, long id);
  /// Ids from field `first` to the card's end (or `last`), with THRU between two of them; every single one is an
  /// integer > 0.
  static std::vector<Range> ranges(const Card& card, int first) { return ranges(card, first, card.size()); }
  static std::vector<Range> ranges(const Card& card, int first, int last);
  /// The GRIDs in a range, in rising order; a range of one must exist as GRID or SPOINT.
  std::vector<int> nodes_in(const Range& range, const Card& card) const;
};

/// Fills `draft.cards`.
void sort_cards(const Text& text, Draft& draft);

// The steps, in the order of their calls.
void read_grids(Draft& draft);          ///< GRDSET, CORDij, GRID
void read_scalar_points(Draft& draft);  ///< SPOINT, QSET
void read_elements(Draft& draft);  ///< MAT1/2/8, PBAR, PBARL, PBEAM, PBEAML, PROD, PTUBE, PSHELL, PCOMP, NSM, CBAR, CBEAM,
                                   ///< CROD, CONROD, CTUBE, shells, CONM2, and those of read_springs
void read_springs(Draft& draft, Register& elements);  ///< PELAS, CELAS1..4, PBUSH, CBUSH
void lump_masses(Draft& draft);                       ///< without PARAM,COUPMASS
void read_links(Draft& draft);                        ///< RBE2, RBE3
void read_boundary(Draft& draft);                     ///< ASET, ASET1, BSET, BSET1
void read_supports(Draft& draft);                     ///< SPC, SPC1, SPCADD, PS of GRID
void read_equations(Draft& draft);                    ///< MPC, MPCADD
void classify_rest(Draft& draft);                     ///< every card still in `cards` becomes a loss

/// The basic direction and sign that a unit vector points along, if it points along one (to 1e-12).
struct Axis {
  int direction = 0;
  double sign = 1.0;
};
std::optional<Axis> basic_axis(const Vec3& unit);

/// Directions given in `axes`, in the basic frame: when the translations and the rotations among them are all or none,
/// or the frame only renames the axes. Nothing when the frame is skew to them.
std::optional<Directions> basic_directions(unsigned components, const Mat3& axes);

/// The node that stands for a scalar point; it lies at the first grid among `fields` of the card that names it.
int scalar_node(Draft& draft, const Card& card, long id, const std::vector<int>& fields);

/// Which of the sets of one kind apply: the chosen one and, if it is an ADD card, the sets that card names. Sets that
/// do not apply become losses. `kind` is SPC, MPC or NSM; `cards` are those of every set (field 1 = set number).
std::vector<Card> selected(Draft& draft, const char* kind, const std::vector<Card>& cards,
                           const std::optional<Choice>& choice);

}  // namespace tenon::fem::nastran
