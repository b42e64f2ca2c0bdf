#include "acg/wall_sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acg/corner_links.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// Rays of a robot at the origin with these ranges around it, turned by `turn`; what is not under 8 m is free.
std::vector<ScanRay> turned_rays(const std::vector<double>& ranges, double turn) {
  std::vector<ScanRay> rays;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double bearing = wrap_angle(2 * kPi * static_cast<double>(i) / static_cast<double>(ranges.size()) + turn);
    rays.push_back({bearing, {std::cos(bearing), std::sin(bearing)}, ranges[i], ranges[i] < 8});
  }
  std::sort(rays.begin(), rays.end(), [](const ScanRay& a, const ScanRay& b) { return a.bearing_rad < b.bearing_rad; });
  return rays;
}

TEST(SeeWall, SaysTheSameHoweverTheRobotIsTurnedAndTheWallIsDrawn) {
  auto random = random_stream(45, 4);
  std::size_t ends = 0;
  for (int i = 0; i < 60; ++i) {
    const double y = uniform(random, 0.5, 3), from = uniform(random, -3, 0), to = uniform(random, 0, 3);
    std::vector<double> ranges;
    for (int k = 0; k < 720; ++k) {
      const double bearing = 2 * kPi * k / 720, range = std::sin(bearing) > 1e-3 ? (y - 0.1) / std::sin(bearing) : 9;
      const double x = range * std::cos(bearing);
      ranges.push_back(range < 8 && x > from && x < to ? range : 8);
    }
    const Segment2 wall{{-2.03, y}, {2.01, y}};
    const WallSight straight = see_wall(turned_rays(ranges, 0), 0, wall, 0.1, 40, {true, true});
    const Pose2 T(0, 0, uniform(random, -kPi, kPi));
    const auto turned_by = turned_rays(ranges, T.heading());
    const WallSight turned = see_wall(turned_by, 0, {T * wall.a, T * wall.b}, 0.1, 40, {true, true});
    EXPECT_EQ(turned.bins, straight.bins);
    WallSight other = see_wall(turned_by, 0, {T * wall.b, T * wall.a}, 0.1, 40, {true, true});
    std::reverse(other.bins.begin(), other.bins.end());
    EXPECT_EQ(other.bins, straight.bins);
    for (const std::size_t e : {0u, 1u}) {
      ASSERT_EQ(turned.ends[e].size(), straight.ends[e].size());
      ASSERT_EQ(other.ends[1 - e].size(), straight.ends[e].size());
      for (std::size_t k = 0; k < straight.ends[e].size(); ++k, ++ends)
        EXPECT_NEAR((turned.ends[e][k].end_robot - T * straight.ends[e][k].end_robot).norm(), 0, 1e-9);
    }
  }
  EXPECT_GT(ends, 40u);
}

TEST(CornerSectors, LieHalfAThicknessBesideBothWallsWhateverTheirAngle) {
  auto random = random_stream(45, 5);
  std::size_t all = 0;
  for (int i = 0; i < 100; ++i) {
    PlanModel plan;
    GraphState state;
    state.corners = {{uniform(random, -5, 5), uniform(random, -5, 5)}};
    const auto arms = 2 + uniform_index(random, 3);
    for (int k = 1; k <= static_cast<int>(arms); ++k) {
      const double heading = uniform(random, -kPi, kPi), length = uniform(random, 1, 4);
      state.corners.push_back(
          {state.corners[0][0] + length * std::cos(heading), state.corners[0][1] + length * std::sin(heading)});
      const bool outwards = uniform01(random) < 0.5;
      plan.walls.push_back({outwards ? 0 : k, outwards ? k : 0, length, heading, uniform(random, 0.02, 0.2), true});
    }
    plan.corners.resize(arms + 1);
    double opening = 0;
    for (const CornerSector& s : corner_sectors(plan, state)) {
      const Point2 corner = state.corner(0), crossing = corner - s.offset_map;
      const auto arm = [&](int wall) { return Segment2{corner, state.corner(wall + 1)}; };
      EXPECT_EQ(s.corner, 0);
      EXPECT_NEAR(signed_line_distance(arm(s.wall_a), crossing),
                  plan.walls[static_cast<std::size_t>(s.wall_a)].half_thickness_m, 1e-9);
      EXPECT_NEAR(signed_line_distance(arm(s.wall_b), crossing),
                  -plan.walls[static_cast<std::size_t>(s.wall_b)].half_thickness_m, 1e-9);
      const double to_bisector = wrap_angle(s.orientation_rad - arm(s.wall_a).heading());
      EXPECT_NEAR(to_bisector < 0 ? to_bisector + 2 * kPi : to_bisector, s.opening_rad / 2, 1e-9);
      opening += s.opening_rad;
      ++all;
    }
    EXPECT_LE(opening, 2 * kPi + 1e-9);
  }
  EXPECT_GT(all, 150u);
}

}  // namespace
}  // namespace smokemap
