#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "fem/formats/abaqus.hpp"
#include "fem/formats/abaqus/text.hpp"

/// What the steps of the reader share while keywords become a mesh and a model.
namespace tenon::fem::abaqus {

/// What elements of a type are made of here.
enum class Formulation { beam, truss, shell, mass, rotary_inertia, spring_to_ground, spring, axial_spring, other };

struct ElementType {
  Formulation formulation = Formulation::other;
  std::optional<CellType> cell;  ///< none: no cell of the mesh
  int nodes = 0;                 ///< 0: as many as its line holds
};

/// By the name in TYPE=, upper case.
ElementType element_type(const std::string& name);

/// An element as the deck lists it; its nodes are those of a cell or stand here (springs, masses).
struct ListedElement {
  long id = 0;
  int type = 0;                   ///< of Draft::types
  int first_node = 0, nodes = 0;  ///< of Draft::element_nodes
  int block = -1, cell = -1;      ///< of the mesh
};

struct NamedType {
  std::string name;
  ElementType type;
  Place place;  ///< of its first *ELEMENT
  bool sectioned = false;
};

/// Losses as they are found, equal ones counted together; those that change stiffness or mass know their first place.
class LossReport {
 public:
  void add(const std::string& name, const std::string& note, long count = 1);
  void add_physical(const std::string& name, const std::string& note, const Place& place, long count = 1);
  std::vector<Loss> losses() const;
  /// Throws InputError naming every physical loss, at the place of the first.
  void refuse_physical() const;

 private:
  struct Entry {
    Loss loss;
    Place first;
  };
  std::vector<Entry> entries_;
};

/// A material card under way.
struct DraftMaterial {
  Material material;
  Place place;
  bool isotropic = true;
  std::optional<Ply> lamina = {};  ///< of a material that is not: what a thin layer of it needs, but its density
  bool varies = false;             ///< with temperature: the first line of its numbers is taken
};

/// A part placed in the assembly, or the model around them.
struct Instance {
  std::string name;
  Vec3 shift = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();              ///< a point x of the part lies at rotation x + shift
  long first_number = 0;                         ///< what its numbers of nodes and elements are counted from
  long room = std::numeric_limits<long>::max();  ///< they lie below, before that
};

struct Draft {
  Text text;
  std::vector<Instance> instances;
  std::map<std::string, int> instance_of;  ///< upper case
  Instance model;
  AbaqusDeck deck;
  LossReport losses;

  std::unordered_map<long, int> node_of;  ///< the file's number → node
  std::vector<NamedType> types;
  std::vector<ListedElement> elements;
  std::vector<int> element_nodes;
  std::unordered_map<long, int> element_of;                                   ///< the file's number → of `elements`
  std::map<std::string, std::pair<std::string, std::vector<int>>> node_sets;  ///< upper case → name, nodes
  std::map<std::string, std::pair<std::string, std::vector<int>>> element_sets;  ///< upper case → name, of `elements`
  std::map<std::string, DraftMaterial> materials;                                ///< upper case
  std::map<int, Mat3> node_axes;                                                 ///< *TRANSFORM; others: basic

  int node(const DataLines& line, std::size_t field, const char* what) const;
  /// Nodes of a number or a node set; throws InputError with near misses.
  std::vector<int> nodes(const DataLines& line, std::size_t field, const char* what) const;
  /// By the name that `user` gives it: within an instance that of the part's.
  const std::vector<int>& node_set(const std::string& name, const Block& user, const Place& place) const;
  const std::vector<int>& element_set(const std::string& name, const Block& user, const Place& place) const;
  const Instance& scope(const Block& block) const;
  /// A point of the block's part as one of the assembly.
  Vec3 place(const Block& block, const Vec3& x) const { return scope(block).rotation * x + scope(block).shift; }
  /// A node's or element's number within the block's part as one of the deck.
  long number(const Block& block, long given) const { return numbered_in(scope(block), given); }
  /// "arm-1.root" for a name within an instance, else the name itself; `key`: the same in upper case.
  std::string full_name(const std::string& name, const Block& block) const;
  std::string key(const std::string& name, const Block& block) const { return upper(full_name(name, block)); }
  /// One that its part has no room for is no one's.
  static long numbered_in(const Instance& instance, long given) {
    return given < instance.room ? instance.first_number + given : std::numeric_limits<long>::max();
  }
  /// Index of the instance that its INSTANCE= names; throws InputError with near misses.
  int instance(const Block& block) const;
  /// Nodes of an element of the deck.
  std::vector<int> nodes_of(int element) const;
  /// The *MATERIAL that a section names; throws InputError with near misses.
  const DraftMaterial& material(const Block& section, const std::string& name);
  /// Axes (columns) that dofs of a node are given in.
  const Mat3& axes(int node) const;
};

/// Axes (columns) of the *ORIENTATION of that name; nothing when it is of a kind that is not read (cylindrical,
/// by nodes or offsets). Throws InputError for a name that is not defined, with near misses, and for axes that are
/// none.
std::optional<Mat3> orientation(const Draft& draft, const Block& user, const std::string& name);

/// The axis about which the second line of that *ORIENTATION turns the others; 0 where it has none. Shells take it for
/// their normal.
long orientation_axis(const Draft& draft, const Block& user, const std::string& name);

// The steps, in the order of their calls.
void place_parts(Draft& draft);      ///< *PART, *INSTANCE: blocks of parts, once for each of their instances
void read_nodes(Draft& draft);       ///< *NODE
void read_elements(Draft& draft);    ///< *ELEMENT
void read_sets(Draft& draft);        ///< *NSET, *ELSET; then the mesh's sets
void read_transforms(Draft& draft);  ///< *TRANSFORM
void read_materials(Draft& draft);   ///< *MATERIAL and what stands under it
void read_sections(Draft& draft);    ///< *BEAM SECTION, *SHELL SECTION, *MASS, ... : the model's elements
void read_links(Draft& draft);       ///< *RIGID BODY, *COUPLING, *MPC, *EQUATION
void read_supports(Draft& draft);    ///< *BOUNDARY
void classify_rest(Draft& draft);    ///< every other keyword becomes a loss

}  // namespace tenon::fem::abaqus
