#include "features/corners.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/check.hpp"

namespace smokemap {
namespace {

/// A wall as seen from a corner on its line: the way it leads, and on which side of that way it is free.
struct Arm {
  double heading_rad = 0;
  bool free_on_left = false;
  double reach_m = 0;  ///< from the corner to where the wall was seen
};

/// One arm where the wall ends near the corner, two where it runs through, none where it stays away.
std::vector<Arm> arms_at(const WallLine& wall, const Point2& corner, double largest_reach_m) {
  const Segment2& s = wall.segment;
  const double length = s.length(), at = along(s, corner) * length;  // metres from a
  const double reach = std::max({0.0, -at, at - length});
  if (reach > largest_reach_m) return {};
  std::vector<Arm> arms;
  const bool near_a = at<largest_reach_m, near_b = at> length - largest_reach_m;
  // An arm must be longer than what may be missing of it.
  if (!near_b || (near_a && at < length - at)) arms.push_back({s.heading(), true, reach});
  if (!near_a || (near_b && at > length - at)) arms.push_back({wrap_angle(s.heading() + kPi), false, reach});
  return arms;
}

/// The free sector between two arms, if both walls are free towards the same one.
std::optional<Corner> sector_between(const Arm& one, const Arm& two) {
  if (one.free_on_left == two.free_on_left) return std::nullopt;
  const Arm& from = one.free_on_left ? one : two;  // counter-clockwise from here ...
  const Arm& to = one.free_on_left ? two : one;    // ... to there it is free
  Corner corner;
  corner.opening_rad = wrap_angle(to.heading_rad - from.heading_rad);
  if (corner.opening_rad < 0) corner.opening_rad += 2 * kPi;
  corner.orientation_rad = wrap_angle(from.heading_rad + 0.5 * corner.opening_rad);
  return corner;
}

Eigen::Matrix2d crossing_covariance(const WallLine& a, const WallLine& b, const Point2& corner) {
  Eigen::Matrix2d normals;
  normals << a.segment.normal().transpose(), b.segment.normal().transpose();
  const auto variance = [&](const WallLine& wall) {
    const double by_turn = wall.sigma_rad * (corner - wall.segment.midpoint()).norm();
    return wall.sigma_m * wall.sigma_m + by_turn * by_turn;
  };
  const Eigen::Matrix2d back = normals.inverse();
  return back * Eigen::Vector2d(variance(a), variance(b)).asDiagonal() * back.transpose();
}

double confidence_of(const WallLine& a, const WallLine& b, const Arm& arm_a, const Arm& arm_b,
                     const CornerParams& params) {
  const double seen = std::exp(-(arm_a.reach_m + arm_b.reach_m) / params.largest_reach_m);
  const auto solid = [&](const WallLine& wall) {
    return std::min(1.0, wall.segment.length() / (2.5 * params.min_wall_m));
  };
  return seen * solid(a) * solid(b);
}

bool same_corner(const Corner& a, const Corner& b, double merge_m) {
  constexpr double kSameAngle_rad = 0.5;
  return (a.position - b.position).norm() < merge_m &&
         std::abs(wrap_angle(a.orientation_rad - b.orientation_rad)) < kSameAngle_rad &&
         std::abs(a.opening_rad - b.opening_rad) < kSameAngle_rad;
}

}  // namespace

Result<Ok> CornerParams::validate() const {
  return ParamCheck("CornerParams")
      .in_range("min_angle_rad", min_angle_rad, 0.05, 1.5)
      .positive("largest_reach_m", largest_reach_m)
      .positive("min_wall_m", min_wall_m)
      .in_range("merge_m", merge_m, 0, 10)
      .result();
}

std::vector<Corner> find_corners(const std::vector<WallLine>& walls, const CornerParams& params) {
  std::vector<Corner> corners;
  const auto keep = [&](const Corner& corner) {
    for (Corner& other : corners) {
      if (!same_corner(other, corner, params.merge_m)) continue;
      if (corner.confidence > other.confidence) other = corner;
      return;
    }
    corners.push_back(corner);
  };
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (walls[i].segment.length() < params.min_wall_m) continue;
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const Segment2 &a = walls[i].segment, &b = walls[j].segment;
      if (b.length() < params.min_wall_m || line_angle_between(a.heading(), b.heading()) < params.min_angle_rad)
        continue;
      const auto crossing = line_intersection(a, b);
      if (!crossing) continue;
      for (const Arm& arm_a : arms_at(walls[i], *crossing, params.largest_reach_m))
        for (const Arm& arm_b : arms_at(walls[j], *crossing, params.largest_reach_m)) {
          auto corner = sector_between(arm_a, arm_b);
          if (!corner) continue;
          corner->position = *crossing;
          corner->covariance = crossing_covariance(walls[i], walls[j], *crossing);
          corner->confidence = confidence_of(walls[i], walls[j], arm_a, arm_b, params);
          corner->wall_a = static_cast<int>(i);
          corner->wall_b = static_cast<int>(j);
          keep(*corner);
        }
    }
  }
  return corners;
}

}  // namespace smokemap
