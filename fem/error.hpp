#pragma once

#include <stdexcept>
#include <string>

namespace tenon {

/// Where in an input a fault lies; line and column count from 1, 0 means "the file as a whole".
struct Place {
  std::string file;
  long line = 0;
  long column = 0;
};

/// "file:line:column", shortened to what is known.
std::string to_string(const Place& place);

/// Base of everything the project throws on purpose. The message says what, where, why and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file or an argument does not say what it should: place, what was found, what was expected, what to do.
class InputError : public Error {
 public:
  /// Message: "<place>: <what>. <cure>."
  InputError(const Place& place, const std::string& what, const std::string& cure);
  const Place& place() const { return place_; }

 private:
  Place place_;
};

/// The model is readable but makes no physical sense (a part without a stiffness path, a loop in a tree, ...).
class ModelError : public Error {
 public:
  /// Message: "<what>. <cure>."
  ModelError(const std::string& what, const std::string& cure);
  /// The same fault, said of a file: "<file>: <message>".
  ModelError(const std::string& file, const ModelError& fault);
};

/// A result cannot be computed reliably; `figure` is the achieved value of the quantity that failed.
class NumericalError : public Error {
 public:
  /// Message: "<what> (<figure>). <cure>."
  NumericalError(const std::string& what, double figure, const std::string& cure);
  double figure() const { return figure_; }

 private:
  double figure_;
};

}  // namespace tenon
