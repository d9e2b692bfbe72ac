#include "assembly/scene/document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace tenon::assembly {
namespace {

constexpr int deepest = 64;            // a scene is five levels deep; aliases can make a document contain itself
constexpr std::size_t most = 200'000;  // nodes after aliases are written out

Place place_of(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file};
  return {file, mark.line + 1, mark.column + 1};
}

class Walk {
 public:
  explicit Walk(std::string file) : file_(std::move(file)) {}

  Value operator()(const YAML::Node& node, const Place& outer, int depth) {
    Value value;
    value.place = place_of(file_, node.Mark());
    if (value.place.line == 0) value.place = outer;
    if (depth > deepest || ++count_ > most)
      throw InputError(value.place, depth > deepest ? "nesting is too deep" : "the document is too large for a scene",
                       "Write it without aliases that contain themselves");
    switch (node.Type()) {
      case YAML::NodeType::Scalar:
        value.kind = Value::Kind::scalar;
        value.text = node.Scalar();
        break;
      case YAML::NodeType::Sequence:
        value.kind = Value::Kind::list;
        for (const YAML::Node& item : node) value.items.push_back((*this)(item, value.place, depth + 1));
        break;
      case YAML::NodeType::Map:
        value.kind = Value::Kind::map;
        read_members(node, value, depth);
        break;
      case YAML::NodeType::Null:
      case YAML::NodeType::Undefined:
        break;
    }
    return value;
  }

 private:
  void read_members(const YAML::Node& node, Value& value, int depth) {
    std::vector<Member> merged;
    for (const auto& pair : node) {
      const Place place = place_of(file_, pair.first.Mark());
      if (!pair.first.IsScalar()) throw InputError(place, "a key is not a word", "Write `name: value`");
      Member member{pair.first.Scalar(), place, (*this)(pair.second, place, depth + 1)};
      if (member.key == "<<") {
        if (member.value.kind != Value::Kind::map)
          throw InputError(place, "`<<` does not name a map", "Write `<<: *anchor` of a map");
        merged = std::move(member.value.members);
      } else if (const Value* twin = value.find(member.key)) {
        throw InputError(place,
                         fmt::format("the key '{}' stands twice (first on line {})", member.key, twin->place.line),
                         "Keep one of the two");
      } else {
        value.members.push_back(std::move(member));
      }
    }
    for (Member& member : merged)  // what the map says itself wins over what it takes in
      if (!value.find(member.key)) value.members.push_back(std::move(member));
  }

  std::string file_;
  std::size_t count_ = 0;
};

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto found = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.key == key; });
  return found == members.end() ? nullptr : &found->value;
}

std::vector<std::string> Value::keys() const {
  std::vector<std::string> names;
  for (const Member& member : members) names.push_back(member.key);
  return names;
}

namespace {

/// Where the documents of a stream begin, and whether they hold anything.
struct Documents : YAML::EventHandler {
  YAML::Mark start;
  bool empty = true;

  void OnDocumentStart(const YAML::Mark& mark) override {
    start = mark;
    empty = true;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { empty = false; }
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override { empty = false; }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    empty = false;
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    empty = false;
  }
  void OnMapEnd() override {}
};

// A stray bracket makes the parser of yaml-cpp 0.7 hand out empty documents without end, all at one place.
void require_one_document(const std::string& file, const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Documents documents;
  if (!parser.HandleNextDocument(documents)) return;
  for (int last = documents.start.pos; parser.HandleNextDocument(documents); last = documents.start.pos) {
    if (!documents.empty)
      throw InputError(place_of(file, documents.start), "a second document begins behind `---`",
                       "Keep one scene a file");
    if (documents.start.pos == last)
      throw InputError(place_of(file, documents.start), "this is not YAML: the text here belongs to nothing before it",
                       "Check indentation and brackets near this place");
  }
}

}  // namespace

Value read_document(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw InputError({path.string()}, "cannot be read", "Check the name; a scene is a YAML or JSON file");
  std::stringstream text;
  text << stream.rdbuf();
  try {
    require_one_document(path.string(), text.str());
    const YAML::Node root = YAML::Load(text.str());
    return Walk(path.string())(root, {path.string(), 1, 1}, 0);
  } catch (const YAML::Exception& fault) {
    throw InputError(place_of(path.string(), fault.mark), fmt::format("this is not YAML: {}", fault.msg),
                     "Check indentation, brackets and quotes near this place");
  }
}

}  // namespace tenon::assembly
