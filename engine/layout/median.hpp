#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace smokemap {

/// Half of the values are no larger, half no smaller; of two in the middle the larger. There must be one.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace smokemap
