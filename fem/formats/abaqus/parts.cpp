#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {
namespace {

struct Part {
  std::vector<Block> blocks;
  Place place;
  std::string name;
  bool placed = false;
};

/// Numbers of nodes and elements all lie below this power of ten.
long room_for_numbers(const std::vector<Block>& blocks) {
  constexpr long most = 1'000'000'000'000L;
  long largest = 0;
  for (const Block& block : blocks) {
    if (block.keyword != "NODE" && block.keyword != "ELEMENT") continue;
    for (DataLines line(block); line.next();)
      if (const auto id = parse_integer(line.at(0))) {
        if (*id >= most) line.fail(0, "a number below 10^12, in a deck of instances");
        largest = std::max(largest, *id);
      }
  }
  long room = 10;
  while (room <= largest) room *= 10;
  return room;
}

/// Takes the blocks of a deck apart into those of parts and the rest, in which each instance gets its part's.
struct Assembly {
  Draft& draft;
  std::map<std::string, Part> parts{};  ///< upper case
  std::vector<Block> placed{};
  Part* part = nullptr;  ///< under way
  int instance = -1;     ///< under way
  std::size_t kept = 0;  ///< by the copies [byte]

  void take(Block block);
  void begin_part(const Block& block);
  void begin_instance(const Block& block);
};

void Assembly::begin_part(const Block& block) {
  const auto [entry, added] = parts.try_emplace(block.upper_value("NAME"), Part{{}, block.place, block.value("NAME")});
  if (!added)
    block.refuse(fmt::format("part '{}' stands already at {}", block.value("NAME"), to_string(entry->second.place)),
                 "Give it a name of its own or remove one of the two");
  part = &entry->second;
}

// two points on an axis and the angle about it, after the translation
void turn(const DataLines& line, Instance& placement) {
  const double angle = line.real(6, "the angle in degrees", 0.0) * std::numbers::pi / 180.0;
  if (angle == 0.0) return;
  const Vec3 a(line.real(0, "point a", 0.0), line.real(1, "point a", 0.0), line.real(2, "point a", 0.0)),
      b(line.real(3, "point b", 0.0), line.real(4, "point b", 0.0), line.real(5, "point b", 0.0));
  if (!((b - a).norm() > 0.0))
    line.refuse(0, "points a and b of the rotation are one: they fix no axis", "Correct one");
  placement.rotation = Eigen::AngleAxisd(angle, (b - a).normalized()).toRotationMatrix();
  placement.shift = placement.rotation * (placement.shift - a) + a;
}

/// What has directions of its own and would not turn with its instance; names of sets and materials do not.
void refuse_directions(const Block& block) {
  static const std::set<std::string> turned{"NODE",
                                            "ELEMENT",
                                            "NSET",
                                            "ELSET",
                                            "SURFACE",
                                            "BEAM SECTION",
                                            "SHELL SECTION",
                                            "MASS",
                                            "ORIENTATION",
                                            "SOLID SECTION",
                                            "BEAM GENERAL SECTION"};
  if (!turned.contains(block.keyword))
    block.refuse(fmt::format("*{} in a part of which an instance is turned is not read", block.keyword),
                 "Give it in the assembly, or write the deck flat");
}

// translation; then two points on an axis and an angle about it
void Assembly::begin_instance(const Block& block) {
  Instance placement{.name = block.value("NAME")};
  const auto index = static_cast<int>(draft.instances.size());
  if (placement.name.empty() || !draft.instance_of.emplace(upper(placement.name), index).second)
    block.refuse(
        fmt::format("instance '{}' {}", placement.name, placement.name.empty() ? "has no NAME" : "is a second one"),
        "Give every *INSTANCE a NAME of its own");
  if (block.has("LIBRARY")) block.refuse("*INSTANCE from a LIBRARY is not read", "Write the deck with its mesh");
  DataLines line(block);
  if (line.next()) {
    placement.shift = Vec3(line.real(0, "the translation in x", 0.0), line.real(1, "the translation in y", 0.0),
                           line.real(2, "the translation in z", 0.0));
    if (line.next()) turn(line, placement);
  }
  const auto found = parts.find(block.upper_value("PART"));
  if (found == parts.end()) {
    std::vector<std::string> names;
    for (const auto& [key, known] : parts) names.push_back(known.name);
    const std::string near = near_miss(block.value("PART"), names);
    block.refuse(fmt::format("there is no part '{}'", block.value("PART")),
                 near.empty() ? "Define it by *PART above the assembly" : fmt::format("Did you mean '{}'?", near));
  }
  found->second.placed = true;
  for (const Block& of_part : found->second.blocks) {
    kept += sizeof(Block);
    for (const Piece& piece : of_part.data) kept += piece.text.size();
  }
  std::size_t files = 0;
  for (const Source& source : draft.text.files) files += source.pages.bytes().size();
  if (kept > 100 * files)
    block.refuse("the parts placed up to here hold more than a hundred times what the deck does",
                 "Write the deck flat");
  instance = index;
  draft.instances.push_back(std::move(placement));
  for (const Block& of_part : found->second.blocks) {
    if (!draft.instances.back().rotation.isIdentity(0.0)) refuse_directions(of_part);
    placed.push_back(of_part);
    placed.back().scope = instance;
  }
}

void Assembly::take(Block block) {
  if (block.keyword == "PART") {
    begin_part(block);
  } else if (block.keyword == "END PART") {
    part = nullptr;
  } else if (part) {
    part->blocks.push_back(std::move(block));
  } else if (block.keyword == "INSTANCE") {
    begin_instance(block);
  } else if (block.keyword == "END INSTANCE") {
    instance = -1;
  } else {
    block.scope = instance;
    if (!draft.scope(block).rotation.isIdentity(0.0)) refuse_directions(block);
    placed.push_back(std::move(block));
  }
}

}  // namespace

void place_parts(Draft& draft) {
  const auto is_of_parts = [](const Block& b) { return b.keyword == "PART" || b.keyword == "INSTANCE"; };
  if (std::ranges::none_of(draft.text.blocks, is_of_parts)) return;
  Assembly assembly{draft};
  for (Block& block : draft.text.blocks) assembly.take(std::move(block));
  for (const auto& [key, part] : assembly.parts) {
    if (part.placed) continue;
    if (draft.instances.empty())
      throw InputError(part.place, fmt::format("part '{}' is placed by no *INSTANCE", part.name),
                       "Add the *ASSEMBLY with its instances");
    draft.losses.add("*PART", "part that no instance places");
  }
  draft.text.blocks = std::move(assembly.placed);
  const long room = room_for_numbers(draft.text.blocks);
  for (std::size_t k = 0; k < draft.instances.size(); ++k) {
    draft.instances[k].first_number = static_cast<long>(k) * room;
    draft.instances[k].room = room;
    if (k > 0)
      draft.losses.add("*INSTANCE", fmt::format("nodes and elements of '{}' are numbered from {} on",
                                                draft.instances[k].name, draft.instances[k].first_number + 1));
  }
  draft.model.first_number = static_cast<long>(draft.instances.size()) * room;
  draft.model.room = room;
}

}  // namespace tenon::fem::abaqus
