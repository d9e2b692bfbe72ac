#pragma once

#include <memory>

/// The chain in Simbody, whose headers want C++17: kept in a file of its own.
namespace tenon::bench {

class SimbodyChain {
 public:
  explicit SimbodyChain(int bodies);
  ~SimbodyChain();
  void run();
  double acceleration(int k) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace tenon::bench
