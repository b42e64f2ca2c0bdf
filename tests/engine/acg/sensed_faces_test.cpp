#include "acg/sensed_faces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

/// Nodes that see one face: of a wall along y, at x, from y = 0 to y = 4; the robots stand `off_m` beside it.
struct FaceWatch {
  GraphState state;
  std::vector<NodeView> views;

  void look(double x, double off_m, const Pose2& T = {}) {
    const Pose2 pose = T * Pose2(x + off_m, 2, 0.3);
    state.poses.push_back({pose.x(), pose.y(), pose.heading()});
    views.emplace_back();
    const Point2 a = T * Point2(x, 0), b = T * Point2(x, 4);
    views.back().pieces.push_back({{pose.inverse() * a, pose.inverse() * b}, 40});
    for (double y = 0.02; y < 4; y += 0.02) {
      const Point2 hit = pose.inverse() * (T * Point2(x, y));
      views.back().rays.push_back({std::atan2(hit.y(), hit.x()), hit.normalized(), hit.norm(), true});
    }
  }
  SensedFaces faces(double heading_rad = 0) const {
    return {views, std::vector<bool>(views.size(), true), state, heading_rad};
  }
};

TEST(SensedFaces, BelieveOneNodeHalfAndTwoNodesWhole) {
  FaceWatch watch;
  watch.look(0.1, 2);
  EXPECT_NEAR(watch.faces().support(0, 0.05, 3.95, 0.1), 0.5, 0.03);
  watch.look(0.1, 2);
  EXPECT_NEAR(watch.faces().support(0, 0.05, 3.95, 0.1), 1, 0.03);
  EXPECT_NEAR(watch.faces().support(0, -3.95, 3.95, 0.1), 0.5, 0.03) << "half of it is where nobody looked";
  EXPECT_LT(watch.faces().support(0.9, 1.6, 2.4, 0.1), -0.6) << "both saw through there";
  EXPECT_EQ(watch.faces().support(-0.4, 0.05, 3.95, 0.1), 0) << "behind the face nothing is known";
}

TEST(SensedFaces, TakeAFaceForTheSideFromWhichItWasSeen) {
  for (const double side : {-1.0, 1.0}) {
    FaceWatch watch;
    watch.look(0, 2 * side), watch.look(0, 2.5 * side);
    EXPECT_NEAR(watch.faces().support(-0.25 * side, 0.05, 3.95, 0.25), 1, 0.03);
    EXPECT_LT(watch.faces().support(0.25 * side, 1.5, 2.5, 0.25), 0) << "a wall cannot lie before its face";
  }
}

TEST(SensedFaces, AreTheSameWhereverTheFrameLiesButForTheRaster) {
  auto random = random_stream(43, 1);
  for (int i = 0; i < 20; ++i) {
    const Pose2 T(uniform(random, -40, 40), uniform(random, -40, 40), uniform(random, -kPi, kPi));
    FaceWatch watch, moved;
    for (const double off : {1.5, 2.0, 2.6}) watch.look(0.1, off), moved.look(0.1, off, T);
    const SensedFaces here = watch.faces(), there = moved.faces(T.heading());
    const Point2 u(std::cos(T.heading()), std::sin(T.heading())), v(-u.y(), u.x());
    // Beams are followed in steps of two rows, so a slanting raster misses some of the cells that they cross.
    for (const double at : {0.0, 0.7, -0.5}) {
      const Point2 a = T * Point2(at, 1), b = T * Point2(at, 3);
      EXPECT_NEAR(there.support(u.dot(a), v.dot(a), v.dot(b), 0.1), here.support(at, 1, 3, 0.1), 0.35) << at;
    }
  }
}

TEST(SensedFaces, AreWithinOneWhateverIsAsked) {
  auto random = random_stream(43, 2);
  FaceWatch watch;
  for (const double off : {-2.0, -1.0, 1.0, 1.5, 2.0}) watch.look(uniform(random, -1, 1), off);
  const SensedFaces faces = watch.faces(uniform(random, -0.2, 0.2));
  for (int i = 0; i < 500; ++i) {
    const double support = faces.support(uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -9, 9), 0.1);
    EXPECT_LE(std::abs(support), 1);
  }
}

TEST(SensedFaces, SayNothingWithoutNodesAndInAWorldTooLargeToCount) {
  EXPECT_EQ(SensedFaces({}, {}, {}, 0.4).support(0, 0, 1, 0.1), 0);
  FaceWatch watch;
  watch.look(0, 2), watch.look(0, 2, Pose2(1e6, 1e6, 0));
  EXPECT_EQ(watch.faces().support(0, 0, 4, 0.1), 0);
  EXPECT_EQ(SensedFaces(watch.views, {false, false}, watch.state, 0).support(0, 0, 4, 0.1), 0);
}

}  // namespace
}  // namespace smokemap
