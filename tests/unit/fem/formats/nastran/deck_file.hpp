#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fem/error.hpp"
#include "fem/formats/nastran.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

namespace tenon::fem {

inline NastranDeck read_deck(const std::string& content, const NastranOptions& options = {}) {
  const testing::Scratch folder;
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
