#include "assembly/scene/document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace tenon::assembly {
namespace {

constexpr int deepest = 64;                        // a scene is five levels deep
constexpr std::size_t most_values = 200'000;       // values, aliases written out
constexpr std::size_t values_by_aliases = 10'000;  // of them beyond the bytes of the file: what aliases may add
constexpr const char* cure_of_aliases = "Write it without aliases that contain themselves";

Place place_of(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file};
  return {file, mark.line + 1, mark.column + 1};
}

/// Builds the value of a document from the parser's events: nothing is kept twice, and a document that grows beyond
/// bounds ends where it does.
class Builder : public YAML::EventHandler {
 public:
  Builder(std::string file, std::size_t bytes)
      : file_(std::move(file)), most_(std::min(most_values, values_by_aliases + bytes)) {
    root_.place = {file_, 1, 1};
  }
  Value take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { leaf(Value::Kind::null, mark, anchor, {}); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string& text) override {
    leaf(Value::Kind::scalar, mark, anchor, text);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(Value::Kind::list, mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(Value::Kind::map, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto named = named_.find(anchor);
    if (named == named_.end()) throw InputError(place(mark), "an alias stands inside what it names", cure_of_aliases);
    count(named->second.size, place(mark));
    add({named->second.value, named->second.size, named->second.height});
  }

 private:
  struct Part {
    Value value;
    std::size_t size = 1;  ///< values in it
    int height = 0;        ///< levels below it
  };
  struct Open {
    Part part;
    YAML::anchor_t anchor = 0;
    std::optional<Member> key;  ///< of a map, its value to come
    std::vector<Member> merged;
  };

  Place place(const YAML::Mark& mark) const {
    Place at = place_of(file_, mark);
    if (at.line == 0) at = stack_.empty() ? root_.place : stack_.back().part.value.place;
    return at;
  }
  void count(std::size_t values, const Place& at) {
    if ((count_ += values) > most_)
      throw InputError(at, "the document is too large for a scene",
                       fmt::format("It has more than {} values with its aliases written out: name fewer", most_));
  }
  Part begin(Value::Kind kind, const YAML::Mark& mark) {
    Part part;
    part.value.kind = kind;
    part.value.place = place(mark);
    count(1, part.value.place);
    if (stack_.size() > deepest) throw InputError(part.value.place, "nesting is too deep", cure_of_aliases);
    return part;
  }
  void leaf(Value::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor, const std::string& text) {
    Part part = begin(kind, mark);
    part.value.text = text;
    name(anchor, part);
    add(std::move(part));
  }
  void open(Value::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    stack_.push_back({begin(kind, mark), anchor, {}, {}});
  }
  void close() {
    Open done = std::move(stack_.back());
    stack_.pop_back();
    Value& value = done.part.value;
    for (Member& member : done.merged)  // what the map says itself wins over what it takes in
      if (!value.find(member.key)) value.members.push_back(std::move(member));
    name(done.anchor, done.part);
    add(std::move(done.part));
  }
  void name(YAML::anchor_t anchor, const Part& part) {
    if (anchor == 0) return;
    count(part.size, part.value.place);  // a copy
    named_[anchor] = part;
  }

  void add(Part part) {
    if (stack_.empty()) {
      root_ = std::move(part.value);
      return;
    }
    Open& in = stack_.back();
    in.part.size += part.size;
    in.part.height = std::max(in.part.height, part.height + 1);
    if (static_cast<int>(stack_.size()) + part.height > deepest)
      throw InputError(part.value.place, "nesting is too deep", cure_of_aliases);
    if (in.part.value.kind == Value::Kind::list)
      in.part.value.items.push_back(std::move(part.value));
    else if (!in.key)
      key(in, std::move(part.value));
    else
      member(in, std::move(part.value));
  }
  static void key(Open& in, Value value) {
    if (value.kind != Value::Kind::scalar) throw InputError(value.place, "a key is not a word", "Write `name: value`");
    in.key = Member{std::move(value.text), std::move(value.place), {}};
  }
  static void member(Open& in, Value value) {
    Member member = std::move(*in.key);
    in.key.reset();
    if (member.key == "<<") {
      if (value.kind != Value::Kind::map)
        throw InputError(member.place, "`<<` does not name a map", "Write `<<: *anchor` of a map");
      in.merged = std::move(value.members);
      return;
    }
    if (const Value* twin = in.part.value.find(member.key))
      throw InputError(member.place,
                       fmt::format("the key '{}' stands twice (first on line {})", member.key, twin->place.line),
                       "Keep one of the two");
    member.value = std::move(value);
    in.part.value.members.push_back(std::move(member));
  }

  std::string file_;
  std::size_t most_, count_ = 0;
  Value root_;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, Part> named_;
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
Value one_document(const std::string& file, const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Builder builder(file, text.size());
  Documents documents;
  if (!parser.HandleNextDocument(builder)) return builder.take();
  for (int last = -1; parser.HandleNextDocument(documents); last = documents.start.pos) {
    if (!documents.empty)
      throw InputError(place_of(file, documents.start), "a second document begins behind `---`",
                       "Keep one scene a file");
    if (documents.start.pos == last)
      throw InputError(place_of(file, documents.start), "this is not YAML: the text here belongs to nothing before it",
                       "Check indentation and brackets near this place");
  }
  return builder.take();
}

}  // namespace

Value read_document(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path))
    throw InputError({path.string()}, "cannot be read", "Check the name; a scene is a YAML or JSON file");
  std::stringstream text;
  text << stream.rdbuf();
  try {
    return one_document(path.string(), text.str());
  } catch (const YAML::Exception& fault) {
    throw InputError(place_of(path.string(), fault.mark), fmt::format("this is not YAML: {}", fault.msg),
                     "Check indentation, brackets and quotes near this place");
  }
}

}  // namespace tenon::assembly
