#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fem/formats/nastran/named_shapes.hpp"
#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

using Vec2 = Eigen::Vector2d;

/// Sections at fractions of the length, as a card gives them.
struct Stations {
  std::vector<double> at;
  std::vector<BeamSection> sections;  ///< shear and mass centres not set yet
};

/// Where the neutral axis and the non-structural mass lie at the two ends, from the shear centre.
struct Centres {
  std::array<Vec2, 2> neutral{Vec2::Zero(), Vec2::Zero()}, mass{Vec2::Zero(), Vec2::Zero()};
  bool warps = false;
};

Vec2 along(const std::array<Vec2, 2>& ends, double t) { return (1.0 - t) * ends[0] + t * ends[1]; }

double fraction(const Card& card, int field, const Stations& known) {
  const double t = card.real(field, "X/XB", 1.0);
  if (!(t > 0.0 && t <= 1.0)) card.fail(field, "X/XB", "a fraction of the length, above 0 and at most 1");
  if (std::ranges::find(known.at, t) != known.at.end())
    card.fail(field, "X/XB", "another place: there is a section already");
  return t;
}

/// The stations in order, with one at each end: without one at B it is as A.
void complete(Stations& s) {
  if (std::ranges::find(s.at, 1.0) == s.at.end()) {
    s.at.push_back(1.0);
    s.sections.push_back(s.sections[0]);
  }
  std::vector<std::size_t> order(s.at.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return s.at[i]; });
  Stations sorted;
  for (const std::size_t i : order) {
    sorted.at.push_back(s.at[i]);
    sorted.sections.push_back(s.sections[i]);
  }
  s = std::move(sorted);
}

bool same(const BeamSection& a, const BeamSection& b) {
  return a.A == b.A && a.Iy == b.Iy && a.Iz == b.Iz && a.Iyz == b.Iyz && a.J == b.J && a.nsm == b.nsm &&
         a.kappa_y == b.kappa_y && a.kappa_z == b.kappa_z && a.shear_y == b.shear_y && a.shear_z == b.shear_z &&
         a.nsm_y == b.nsm_y && a.nsm_z == b.nsm_z;
}

void append(Draft& draft, long id, const std::string& name, int m, Stations stations, const Centres& centres,
            Properties& properties) {
  Model& model = draft.deck.model;
  for (std::size_t i = 0; i < stations.at.size(); ++i) {
    BeamSection& s = stations.sections[i];
    const Vec2 neutral = along(centres.neutral, stations.at[i]), mass = along(centres.mass, stations.at[i]) - neutral;
    s.name = i == 0 ? name : fmt::format("{} at {:g}", name, stations.at[i]);
    s.shear_y = -neutral.x();
    s.shear_z = -neutral.y();
    s.nsm_y = s.nsm > 0.0 ? mass.x() : 0.0;
    s.nsm_z = s.nsm > 0.0 ? mass.y() : 0.0;
  }
  Property property{.section = static_cast<int>(model.beam_sections.size()),
                    .material = m,
                    .neutral = centres.neutral,
                    .warps = centres.warps};
  const bool uniform =
      std::ranges::all_of(stations.sections, [&](const BeamSection& s) { return same(s, stations.sections[0]); });
  if (uniform) {
    model.beam_sections.push_back(stations.sections[0]);
  } else {
    property.taper = static_cast<int>(model.tapers.size());
    model.tapers.emplace_back();
    for (std::size_t i = 0; i < stations.at.size(); ++i) {
      model.tapers.back().push_back({stations.at[i], static_cast<int>(model.beam_sections.size())});
      model.beam_sections.push_back(std::move(stations.sections[i]));
    }
    draft.losses.add("PBEAM taper", "between stations the roots of area and second moments vary linearly");
  }
  properties.beams.emplace(id, property);
}

/// What a line of constants holds, in its order.
constexpr std::array<double BeamSection::*, 6> members{&BeamSection::A,   &BeamSection::Iz, &BeamSection::Iy,
                                                       &BeamSection::Iyz, &BeamSection::J,  &BeamSection::nsm};

/// A I1 I2 I12 J NSM from field `first` on; blanks are as in `otherwise`.
BeamSection constants(const Card& card, int first, const BeamSection& otherwise) {
  BeamSection s;
  s.A = card.non_negative(first, "A", otherwise.A);
  s.Iz = card.non_negative(first + 1, "I1", otherwise.Iz);
  s.Iy = card.non_negative(first + 2, "I2", otherwise.Iy);
  s.Iyz = card.real(first + 3, "I12", otherwise.Iyz);
  s.J = card.non_negative(first + 4, "J", otherwise.J);
  s.nsm = card.non_negative(first + 5, "NSM", otherwise.nsm);
  if (!(s.A > 0.0)) card.fail(first, "A", "a number above zero");
  if (!(s.Iz > 0.0)) card.fail(first + 1, "I1", "a number above zero");
  if (!(s.Iy > 0.0)) card.fail(first + 2, "I2", "a number above zero");
  if (!(s.Iyz * s.Iyz < s.Iy * s.Iz))
    card.fail(first + 3, "I12", fmt::format("I12² below I1·I2 = {:g}, as of every real section", s.Iy * s.Iz));
  return s;
}

/// A line between the ends whose blanks lie on the straight line from A to B.
struct Blanks {
  std::size_t station;
  int first;
};

void fill(const Card& card, const std::vector<Blanks>& lines, Stations& stations) {
  const BeamSection A = stations.sections.front();
  const auto b = std::ranges::find(stations.at, 1.0);
  const BeamSection B =
      b == stations.at.end() ? A : stations.sections[static_cast<std::size_t>(b - stations.at.begin())];
  for (const auto& [station, first] : lines)
    for (int i = 0; i < 6; ++i) {
      const auto member = members[static_cast<std::size_t>(i)];
      const double t = stations.at[station];
      if (card.blank(first + i)) stations.sections[station].*member = (1.0 - t) * A.*member + t * B.*member;
    }
}

bool is_word(std::string_view text) {
  const std::string word = upper(text);
  return word == "YES" || word == "YESA" || word == "NO";
}

// PID MID A I1 I2 I12 J NSM / C1 .. F2 / SO X/XB A .. NSM / C1 .. F2 / .. / K1 K2 S1 S2 NSI(A) NSI(B) CW(A) CW(B) /
// M1(A) M2(A) M1(B) M2(B) N1(A) N2(A) N1(B) N2(B). Lines of stress points C1 .. F2 stand behind A where no station
// does, and behind every SO = YES.
void read_pbeam(Draft& draft, const Card& card, const MaterialIndex& materials, Properties& properties) {
  const long id = card.id(1, "PID");
  Stations stations{{0.0}, {constants(card, 3, {})}};
  std::vector<Blanks> between;
  int row = 9;
  if (row <= card.size() && !is_word(card.at(row))) row += 8;
  while (row <= card.size() && is_word(card.at(row))) {
    const double t = fraction(card, row + 1, stations);
    if (t < 1.0) between.push_back({stations.at.size(), row + 2});
    stations.at.push_back(t);
    stations.sections.push_back(constants(card, row + 2, BeamSection(stations.sections.front())));
    const bool stress = upper(card.at(row)) == "YES";
    row += stress && !is_word(card.at(row + 8)) ? 16 : 8;
  }
  fill(card, between, stations);
  complete(stations);
  const double K1 = card.non_negative(row, "K1", 1.0), K2 = card.non_negative(row + 1, "K2", 1.0);
  for (BeamSection& s : stations.sections) {
    s.kappa_y = K1;
    s.kappa_z = K2;
  }
  for (const int s : {2, 3})
    if (card.real(row + s, "S1, S2", 0.0) != 0.0)
      draft.losses.add_physical("PBEAM S1, S2", "relief of shear by taper", card.place(row + s));
  for (const int nsi : {4, 5})
    if (card.real(row + nsi, "NSI", 0.0) != 0.0)
      draft.losses.add_physical("PBEAM NSI", "moment of inertia of the non-structural mass", card.place(row + nsi));
  Centres centres;
  centres.warps = card.real(row + 6, "CW", 0.0) != 0.0 || card.real(row + 7, "CW", 0.0) != 0.0;
  const auto pair = [&](int first, const char* label, const Vec2& otherwise) {
    return Vec2(card.real(first, label, otherwise.x()), card.real(first + 1, label, otherwise.y()));
  };
  centres.mass[0] = pair(row + 8, "M1, M2", Vec2::Zero());
  centres.mass[1] = pair(row + 10, "M1, M2", centres.mass[0]);
  centres.neutral[0] = pair(row + 12, "N1, N2", Vec2::Zero());
  centres.neutral[1] = pair(row + 14, "N1, N2", centres.neutral[0]);
  append(draft, id, fmt::format("pbeam {}", id), material(materials, card, 2, "MID"), std::move(stations), centres,
         properties);
}

// PID MID GROUP TYPE, from field 9 on DIMi and NSM of A, then SO X/XB DIMi NSM of each station
void read_pbeaml(Draft& draft, const Card& card, const MaterialIndex& materials, Properties& properties) {
  const long id = card.id(1, "PID");
  const int n = dimensions_of(card), m = material(materials, card, 2, "MID");
  const double nu = draft.deck.model.materials[static_cast<std::size_t>(m)].nu;
  Stations stations;
  std::vector<double> first;
  const auto section = [&](int at) {
    std::vector<double> dim;
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      dim.push_back(first.empty() || !card.blank(at + i) ? card.positive(at + i, "DIM") : first[k]);
    }
    if (first.empty()) first = dim;
    BeamSection s = named_shape(card, dim, at, nu);
    s.nsm = card.non_negative(at + n, "NSM", stations.sections.empty() ? 0.0 : stations.sections[0].nsm);
    return s;
  };
  stations.at.push_back(0.0);
  stations.sections.push_back(section(9));
  for (int at = 9 + n + 1; at <= card.size(); at += n + 3) {
    stations.at.push_back(fraction(card, at + 1, stations));
    stations.sections.push_back(section(at + 2));
  }
  complete(stations);
  Centres centres;
  for (std::size_t i = 0; i < 2; ++i) {
    const BeamSection& s = i == 0 ? stations.sections.front() : stations.sections.back();
    centres.neutral[i] = centres.mass[i] = -Vec2(s.shear_y, s.shear_z);  // the mass lies at the centroid
    centres.warps |= s.shear_y != 0.0 || s.shear_z != 0.0;
  }
  centres.warps |= upper(card.at(4)).starts_with('I');
  draft.losses.add("PBEAML", "J and shear coefficients are those of our section shapes");
  append(draft, id, fmt::format("pbeaml {}", id), m, std::move(stations), centres, properties);
}

}  // namespace

void read_beam_sections(Draft& draft, const MaterialIndex& materials, Properties& properties) {
  Register known("PBEAM or PBEAML");
  for (const Card& card : draft.take("PBEAM"))
    if (known.admit(card.id(1, "PID"), card, draft.losses)) read_pbeam(draft, card, materials, properties);
  for (const Card& card : draft.take("PBEAML"))
    if (known.admit(card.id(1, "PID"), card, draft.losses)) read_pbeaml(draft, card, materials, properties);
}

}  // namespace tenon::fem::nastran
