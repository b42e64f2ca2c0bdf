#pragma once

#include <optional>

#include "navigation/planner.hpp"

namespace smokemap {

struct FrontierParams {
  double min_size_m = 0.5;      ///< shorter borders between seen and unseen are noise
  double gain_per_metre = 1.5;  ///< how much way a metre of border is worth
  double avoid_radius_m = 0.7;  ///< around places that could not be reached before
};

/// Where to look next: a border between ground that was seen and ground that was not (but may be driven on), near and
/// long.
struct Frontier {
  Point2 target = Point2::Zero();  ///< drivable, beside the border
  double size_m = 0;
  double cost = 0;
};

/// @param avoid places that failed before
/// @param toward when looking for a way to somewhere: frontiers near to it count as near
/// Nothing when everything reachable was seen.
std::optional<Frontier> best_frontier(const CostMap& map, const Point2& start, const std::vector<Point2>& avoid,
                                      const FrontierParams& params, const std::optional<Point2>& toward = std::nullopt);

}  // namespace smokemap
