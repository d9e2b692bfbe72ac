#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "fem/error.hpp"
#include "fem/formats/nastran.hpp"

namespace tenon::fem {

/// Decks written into a folder of their own, which goes with the object.
class DeckFolder {
 public:
  DeckFolder() {
    static std::atomic<int> count{0};
    folder_ = std::filesystem::temp_directory_path() /
              ("tenon-nastran-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(folder_);
  }
  ~DeckFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  DeckFolder(const DeckFolder&) = delete;
  DeckFolder& operator=(const DeckFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }

 private:
  std::filesystem::path folder_;
};

inline NastranDeck read_deck(const std::string& content, const NastranOptions& options = {}) {
  const DeckFolder folder;
  return read_nastran(folder.write("deck.bdf", content), options);
}

/// The message of the InputError that reading throws; a test failure when it throws none.
inline std::string refusal(const std::string& content, const NastranOptions& options = {}) {
  try {
    read_deck(content, options);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "read without an InputError:\n" << content;
  return {};
}

template <class T>
std::vector<T> elements_of(const Model& model) {
  std::vector<T> result;
  for (const Element& element : model.elements)
    if (const T* e = std::get_if<T>(&element)) result.push_back(*e);
  return result;
}

/// Count of losses of that name.
inline long lost(const Mesh& mesh, const std::string& name) {
  long count = 0;
  for (const Loss& loss : mesh.losses)
    if (loss.name == name) count += loss.count;
  return count;
}

}  // namespace tenon::fem
