#include "acg/wall_rivals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// One drawn wall along y at x = 0, from y = 0 to y = 4, 10 cm thick, and what two nodes see beside it.
struct RivalScene {
  PlanModel plan;
  GraphState state;
  std::vector<NodeView> views;
  std::vector<WallState> walls;

  RivalScene() { draw(0); }

  void draw(double x) {
    const int first = static_cast<int>(plan.corners.size());
    for (const double y : {0.0, 4.0}) {
      plan.corners.push_back({x, y});
      state.corners.push_back({x, y});
    }
    plan.walls.push_back({first, first + 1, 4, kPi / 2, 0.05, true});
    walls.push_back(WallState::kConfirmed);
  }
  /// Twice a face at x, from y = from to y = to, seen from `off_m` beside it.
  void see(double x, double off_m, double from = 0, double to = 4) {
    for (int i = 0; i < 2; ++i) {
      const Pose2 pose(x + off_m, 2 + 0.1 * i, 0.2 * i);
      state.poses.push_back({pose.x(), pose.y(), pose.heading()});
      views.emplace_back();
      views.back().pieces.push_back({{pose.inverse() * Point2(x, from), pose.inverse() * Point2(x, to)}, 40});
      for (double y = from + 0.02; y < to; y += 0.02) {
        const Point2 hit = pose.inverse() * Point2(x, y);
        views.back().rays.push_back({std::atan2(hit.y(), hit.x()), hit.normalized(), hit.norm(), true});
      }
    }
  }
  std::vector<double> rivals() const {
    return wall_rivals_m(views, std::vector<bool>(views.size(), true), plan, state, walls);
  }
};

TEST(WallRivals, AreWallsThatNobodyDrewBesideOneSeenFromTheNextRoom) {
  RivalScene scene;
  scene.see(0.05, 2);
  EXPECT_EQ(scene.rivals()[0], 0);
  scene.see(-0.53, -2);  // another face, seen from the other side: of a wall with its middle at -0.5
  EXPECT_NEAR(scene.rivals()[0], 0.5, 0.12);
}

TEST(WallRivals, AreNotWhatAnotherDrawnWallExplains) {
  RivalScene scene;
  scene.draw(-0.5);
  scene.see(0.05, 2);
  scene.see(-0.53, -2);
  EXPECT_EQ(scene.rivals(), (std::vector<double>{0, 0}));
  scene.walls[1] = WallState::kMissing;
  EXPECT_GT(scene.rivals()[0], 0.3) << "a wall that is not there explains nothing";
}

TEST(WallRivals, AreNeitherTheOtherFaceOfTheWallNorAThingThatCoversHalfOfIt) {
  RivalScene thick, covered;
  thick.see(0.05, 2), thick.see(-0.10, -2);
  EXPECT_EQ(thick.rivals()[0], 0);
  covered.see(0.05, 2), covered.see(-0.53, -2, 0, 2);
  EXPECT_EQ(covered.rivals()[0], 0);
}

TEST(WallRivals, AreOnlyAskedForWhereAWallIsSaidToBe) {
  RivalScene scene;
  scene.see(0.05, 2), scene.see(-0.53, -2);
  for (const WallState state : {WallState::kUnseen, WallState::kMissing}) {
    scene.walls[0] = state;
    EXPECT_EQ(scene.rivals()[0], 0);
  }
}

}  // namespace
}  // namespace smokemap
