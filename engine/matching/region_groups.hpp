#pragma once

#include <vector>

#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// Regions of both maps that are one place together: one to one mostly, several where a map splits what the other does
/// not.
struct RegionGroup {
  std::vector<int> labels_a;  ///< sorted
  std::vector<int> labels_b;  ///< sorted
  double confidence = 0;      ///< of its least sure pair
};

/// Connected components of the pairs that are not rejected.
std::vector<RegionGroup> group_pairs(const std::vector<RegionPair>& pairs);

}  // namespace smokemap
