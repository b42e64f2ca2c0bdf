#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "geometry/pose2.hpp"

namespace smokemap {

using Colour = std::array<int, 3>;  ///< blue, green, red

/// Colours across one place of a side of a sheet, from the outside inwards.
class RimProfile {
 public:
  /// @param inward  unit
  /// @param low,high  offsets along it, px, that are looked at
  RimProfile(const cv::Mat& bgr, const Point2& p, const Point2& inward, int low, int high);
  /// Median colour of the offsets [from, to), in which a thin line does not show; nothing where the picture ends.
  std::optional<Colour> median(int from, int to) const;

 private:
  int low_;
  std::vector<bool> seen_;
  std::vector<Colour> colours_;
};

/// Of any channel.
int largest_difference(const Colour& a, const Colour& b);

}  // namespace smokemap
