#include "acg/sensed_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

TEST(SensedFaces, AreTheSameWhereverTheFrameLies) {
  auto random = random_stream(43, 1);
  for (int i = 0; i < 20; ++i) {
    const Pose2 T(uniform(random, -40, 40), uniform(random, -40, 40), uniform(random, -kPi, kPi));
    FaceWatch watch, moved;
    for (const double off : {1.5, 2.0, 2.6}) watch.look(0.1, off), moved.look(0.1, off, T);
    const SensedFaces here = watch.faces(), there = moved.faces(T.heading());
    const Point2 u(std::cos(T.heading()), std::sin(T.heading())), v(-u.y(), u.x());
    for (const double at : {0.0, 0.7, -0.5}) {
      const Point2 a = T * Point2(at, 1), b = T * Point2(at, 3);
      EXPECT_NEAR(there.support(u.dot(a), v.dot(a), v.dot(b), 0.1), here.support(at, 1, 3, 0.1), 1e-9) << at;
    }
  }
}

/// Whether the way from a to b comes through the box around `middle`.
bool crosses(const Point2& a, const Point2& b, const Point2& middle, const Point2& half) {
  double enter = 0, leave = 1;
  for (const int k : {0, 1}) {
    const double step = b[k] - a[k], low = middle[k] - half[k] - a[k], high = middle[k] + half[k] - a[k];
    if (std::abs(step) < 1e-12) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / step, high / step));
    leave = std::min(leave, std::max(low / step, high / step));
  }
  return enter < leave;
}

// Beams were followed in steps of 10 cm over rows of 5 cm: one that ran across the rows left out every other of them.
TEST(SensedFaces, CountEveryCellThatABeamCrosses) {
  auto random = random_stream(43, 3);
  const Pose2 pose(3.33, -1.07, 0.7);
  const Point2 corners[2] = {{-3.2, -8.1}, {9.8, 6.3}};
  FaceWatch watch;
  std::vector<std::pair<Point2, Point2>> beams;
  for (const int node : {0, 1}) {  // two nodes, for one alone does not say that nothing is there
    watch.state.poses.push_back({pose.x(), pose.y(), pose.heading()});
    watch.views.emplace_back();
    // A slanting face speaks for no wall here; it only makes the raster large.
    watch.views.back().pieces.push_back({{pose.inverse() * corners[0], pose.inverse() * corners[1]}, 40});
    for (int i = 0; i < 40 && node == 0; ++i) {
      const double bearing = uniform(random, -kPi, kPi), range = uniform(random, 1, 6);
      watch.views.back().rays.push_back({bearing, Point2(std::cos(bearing), std::sin(bearing)), range, true});
      const Point2 way = watch.views.back().rays.back().way;
      beams.emplace_back(pose * (0.1 * way), pose * ((range - 0.15) * way));
    }
    if (node == 1) watch.views[1].rays = watch.views[0].rays;
  }
  const SensedFaces faces = watch.faces();
  const Point2 low = corners[0] - Point2(0.5, 0.5);
  int crossed = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto& [a, b] = beams[uniform_index(random, beams.size())];
    const Point2 near =
        a + uniform01(random) * (b - a) + Point2(uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1));
    const Point2 cell(std::floor((near.x() - low.x()) / 0.05), std::floor((near.y() - low.y()) / 0.1));
    const Point2 middle = low + Point2(0.05 * (cell.x() + 0.5), 0.1 * (cell.y() + 0.5));
    const auto any = [&](double grown) {
      return std::any_of(beams.begin(), beams.end(), [&](const auto& beam) {
        return crosses(beam.first, beam.second, middle, Point2(0.025 + grown, 0.05 + grown));
      });
    };
    if (any(-1e-6) != any(1e-6)) continue;  // it grazes the border
    crossed += any(0);
    EXPECT_EQ(faces.support(middle.x(), middle.y(), middle.y(), 0.1), any(0) ? -1 : 0) << middle.transpose();
  }
  EXPECT_GT(crossed, 1000);
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
