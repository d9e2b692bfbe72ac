#pragma once

#include <filesystem>
#include <vector>

/// `tenon doctor --cost`: what forward dynamics of chains costs, counted and measured on this machine.
namespace tenon::cli {

struct CostOptions {
  std::filesystem::path scene;  ///< measured itself, in place of chains
  std::vector<int> bodies{10};  ///< of the chains
  std::filesystem::path svg;    ///< a picture of the ratios (Figure 2 of the paper); none when empty
  bool json = false;
};

int run_cost(const CostOptions& options);

}  // namespace tenon::cli
