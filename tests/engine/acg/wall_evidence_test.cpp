#include "acg/wall_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// Rays of a robot at the origin against one face, y = 2 from x = from to x = to; free up to 8 m elsewhere.
std::vector<ScanRay> rays_at_a_face(double from, double to) {
  std::vector<ScanRay> rays;
  for (int i = -720; i < 720; ++i) {
    const double bearing = i * kPi / 720;
    ScanRay ray{bearing, {std::cos(bearing), std::sin(bearing)}, 8, false};
    const double range = ray.way.y() > 1e-3 ? 2 / ray.way.y() : 1e9, x = range * ray.way.x();
    if (range < 8 && x >= from && x <= to) ray.range_m = range, ray.hit = true;
    rays.push_back(ray);
  }
  return rays;
}

/// The wall behind that face: 20 cm thick, corners at x = -3 and 3.
struct OneWall {
  PlanModel plan;
  GraphState state;
  std::vector<NodeView> views;

  explicit OneWall(std::size_t nodes, double from = -2.5, double to = 1.5) {
    plan.corners = {{-3, 2.1}, {3, 2.1}};
    plan.walls = {{0, 1, 6, 0, 0.1, true}};
    plan.degree = {1, 1};
    state.corners = {{-3, 2.1}, {3, 2.1}};
    for (std::size_t i = 0; i < nodes; ++i) {
      views.emplace_back();
      views.back().rays = rays_at_a_face(from, to);
      state.poses.push_back({0, 0, 0});
    }
  }
  BeamReading read(BeamMemory& memory, double gate_m = 2) const {
    return memory.read(views, std::vector<bool>(views.size(), true), plan, state, {gate_m});
  }
};

TEST(SeeWall, SaysEchoesOnTheFaceAndBeamsThroughBesideIt) {
  const WallSight sight = see_wall(rays_at_a_face(-2.5, 1.5), 7, {{-3, 2.1}, {3, 2.1}}, 0.1, 60, {true, true});
  EXPECT_EQ(sight.wall, 7);
  ASSERT_EQ(sight.bins.size(), 60u);
  for (int i = 0; i < 60; ++i) {
    const double x = -3 + 0.1 * (i + 0.5);
    if (std::abs(x + 2.5) < 0.15 || std::abs(x - 1.5) < 0.15) continue;  // the face's ends fall into these
    EXPECT_EQ(sight.bins[static_cast<std::size_t>(i)], x > -2.5 && x < 1.5 ? 1 : -1) << "at x = " << x;
  }
}

TEST(SeeWall, SeesTheEndsOnlyWhereTheyStandFree) {
  const auto rays = rays_at_a_face(-2.5, 1.5);
  const WallSight both = see_wall(rays, 0, {{-3, 2.1}, {3, 2.1}}, 0.1, 60, {true, true});
  ASSERT_EQ(both.ends[0].size(), 1u);
  ASSERT_EQ(both.ends[1].size(), 1u);
  EXPECT_NEAR(both.ends[0].front().end_robot.x(), -2.5, 0.05);
  EXPECT_NEAR(both.ends[1].front().end_robot.x(), 1.5, 0.05);
  EXPECT_NEAR(both.ends[1].front().end_robot.y(), 2.0, 1e-6);
  const WallSight neither = see_wall(rays, 0, {{-3, 2.1}, {3, 2.1}}, 0.1, 60, {false, false});
  EXPECT_TRUE(neither.ends[0].empty() && neither.ends[1].empty());
}

TEST(SeeWall, SaysNothingFromInsideTheWallOrAlongIt) {
  for (const double y : {0.0, 0.1}) {
    const WallSight sight = see_wall(rays_at_a_face(-2, 2), 0, {{-3, y}, {3, y}}, 0.1, 60, {true, true});
    for (const std::int8_t bin : sight.bins) EXPECT_EQ(bin, 0);
  }
}

TEST(BeamMemory, CountsNodesAndFindsTheEndsThatTwoOfThemSaw) {
  const OneWall world(3);
  BeamMemory memory;
  const BeamReading reading = world.read(memory);
  EXPECT_EQ(reading.walls[0].hit[30], 3);
  EXPECT_EQ(reading.walls[0].through[55], 3);
  EXPECT_NEAR(reading.walls[0].hit_m(), 4.0, 0.25);
  EXPECT_NEAR(reading.walls[0].through_m(), 2.0, 0.25);
  ASSERT_EQ(reading.ends.size(), 6u);
  for (const EndLink& e : reading.ends) EXPECT_NEAR(e.misfit_m, e.corner == 0 ? -0.5 : -1.5, 0.06);
  EXPECT_TRUE(world.read(memory, 0.2).ends.empty());  // the gate
  BeamMemory one_node;
  EXPECT_TRUE(OneWall(1).read(one_node).ends.empty());
}

TEST(BeamMemory, SaysWhatAFreshOneSaysAfterTheWallMoved) {
  OneWall world(2);
  BeamMemory memory;
  (void)world.read(memory);
  for (const double shift : {0.005, 0.05, 0.4, -0.3}) {
    for (auto& c : world.state.corners) c[0] += shift;
    BeamMemory fresh;
    const BeamReading remembered = world.read(memory), anew = world.read(fresh);
    for (std::size_t i = 0; i < anew.ends.size() && i < remembered.ends.size(); ++i)
      EXPECT_NEAR(remembered.ends[i].misfit_m, anew.ends[i].misfit_m, 1e-9);  // ends are measured, bins are not
    EXPECT_NEAR(remembered.walls[0].hit_m(), anew.walls[0].hit_m(), 0.11);
    EXPECT_NEAR(remembered.walls[0].through_m(), anew.walls[0].through_m(), 0.11);
  }
}

TEST(BeamMemory, KeepsStillWhatItsCopyLearns) {
  OneWall world(2);
  BeamMemory memory;
  (void)world.read(memory);
  BeamMemory copy = memory;
  world.state.corners = {{-3, 5}, {3, 5}};
  EXPECT_EQ(world.read(copy).walls[0].hit_m(), 0);
  world.state.corners = {{-3, 2.1}, {3, 2.1}};
  EXPECT_NEAR(world.read(memory).walls[0].hit_m(), 4.0, 0.25);
}

}  // namespace
}  // namespace smokemap
