#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <tuple>

#include "fem/spatial.hpp"

namespace tenon::calculix {

/// A block of 2×1×4 C3D20R, 2×1×6 mm of steel (t, mm, s); its ends at z = 0 and 6 are the sets ROOT and TIP.
class Block {
 public:
  Block() {
    // corners, edge middles below, edge middles above, edge middles between, in half edges
    constexpr int local[20][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
                                  {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
                                  {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
    int element = 0;
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 2; ++i) {
        elements_ += fmt::format("{}", ++element);
        for (int l = 0; l < 20; ++l)
          elements_ +=
              fmt::format("{}{}", l == 14 ? ",\n" : ",", node(2 * i + local[l][0], local[l][1], 2 * k + local[l][2]));
        elements_ += '\n';
      }
  }

  /// @param held  at z = 0, else free
  std::string deck(const char* frequency_option, bool held = true) const {
    std::string text = "*NODE, NSET=NALL\n", root = "*NSET, NSET=ROOT\n", tip = "*NSET, NSET=TIP\n";
    for (const auto& [id, x] : positions) {
      text += fmt::format("{},{:.17g},{:.17g},{:.17g}\n", id, x.x(), x.y(), x.z());
      if (x.z() == 0.0) root += fmt::format("{},\n", id);
      if (x.z() == 6.0) tip += fmt::format("{},\n", id);
    }
    return text + "*ELEMENT, TYPE=C3D20R, ELSET=EALL\n" + elements_ + root + tip +
           "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000.,.3\n*DENSITY\n7.8E-9\n*SOLID SECTION, ELSET=EALL, "
           "MATERIAL=STEEL\n" +
           (held ? "*BOUNDARY\nROOT,1,3\n" : "") + "*STEP\n*FREQUENCY, " + frequency_option + "\n10\n*END STEP\n";
  }

  std::map<long, fem::Vec3> positions;

 private:
  long node(int i, int j, int k) {
    const auto [entry, added] = ids_.try_emplace({i, j, k}, static_cast<long>(ids_.size()) + 1);
    if (added) positions[entry->second] = {0.5 * i, 0.5 * j, 0.75 * k};
    return entry->second;
  }
  std::map<std::tuple<int, int, int>, long> ids_;
  std::string elements_;
};

}  // namespace tenon::calculix
