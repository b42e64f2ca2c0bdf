#include "matching/transfer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "core/random.hpp"
#include "matching/chain.hpp"
#include "matching/match.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"
#include "tests/support/plan_sketches.hpp"

namespace smokemap {
namespace {

int room_at(const cv::Mat& rooms, const Point2& p) {
  const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
  return x >= 0 && y >= 0 && x < rooms.cols && y < rooms.rows ? rooms.at<unsigned short>(y, x) : 0;
}

/// A sketch of an office with the true pairs, so that carrying points is tested alone.
struct TrueMatch {
  test::PlanPicture plan;
  test::PlanSketch sketch;
  Segmentation a, b;
  Matching matching;

  TrueMatch(std::uint64_t seed, const test::SketchHabits& habits) {
    std::mt19937_64 random(seed);
    plan = test::office_plan(random);
    sketch = test::sketch_of(plan, habits, random);
    a = *segmentation_from_labels(sketch.picture.rooms);
    b = *segmentation_from_labels(plan.rooms);
    for (const Region& region : a.regions) {
      const int room = test::true_room(a.labels, region.label, sketch.picture.rooms).room;
      for (const Region& other : b.regions)
        if (test::true_room(b.labels, other.label, plan.rooms).room == room)
          matching.pairs.push_back({region.label, other.label, 0.9, Verdict::kProposed});
    }
    matching.turn_b_a = Eigen::Rotation2Dd(habits.quarter_turns * std::numbers::pi / 2).toRotationMatrix();
  }

  std::vector<Point2> points(std::uint64_t seed, int count) const {
    std::mt19937_64 random(seed);
    std::vector<Point2> found;
    while (static_cast<int>(found.size()) < count) {
      const Point2 p(std::floor(uniform(random, 0, a.labels.cols)), std::floor(uniform(random, 0, a.labels.rows)));
      if (room_at(a.labels, p) != 0) found.push_back(p);
    }
    return found;
  }
};

TEST(PointTransfer, PutsEveryPointIntoItsRoomNearItsPlace) {
  for (int turns = 0; turns < 4; ++turns) {
    test::SketchHabits habits;
    habits.quarter_turns = turns;
    const TrueMatch truth(20 + static_cast<std::uint64_t>(turns), habits);
    const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
    double squared = 0, variance = 0;
    const auto points = truth.points(1, 300);
    for (const Point2& p : points) {
      const Transferred place = transfer(p);
      ASSERT_TRUE(place.p.has_value()) << place.reason;
      EXPECT_EQ(room_at(truth.plan.rooms, *place.p), room_at(truth.sketch.picture.rooms, p));
      EXPECT_GT(place.sigma, 0);
      squared += (*place.p - truth.sketch.on_plan(p)).squaredNorm() / 2;
      variance += place.sigma * place.sigma;
    }
    EXPECT_LT(std::sqrt(squared / 300), 12);
    EXPECT_LT(squared, 2 * variance);  // not more certain than it is
  }
}

TEST(PointTransfer, ComesBackNearWhereItStarted) {
  const TrueMatch truth(31, {});
  const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
  double sum = 0;
  const auto points = truth.points(2, 200);
  for (const Point2& p : points) {
    const Transferred there = transfer(p);
    const Transferred back = transfer.inverse(*there.p);
    ASSERT_TRUE(back.p.has_value());
    sum += (*back.p - p).norm();
  }
  EXPECT_LT(sum / 200, 8);
}

TEST(PointTransfer, BringsPinsExactlyToWhereThePersonSaid) {
  const TrueMatch truth(32, {});
  std::vector<Pin> pins;
  for (const Point2& p : truth.points(3, 3)) {
    const Point2 plan = truth.sketch.on_plan(p);
    pins.push_back({p, Point2(std::round(plan.x()), std::round(plan.y()))});
  }
  const PointTransfer transfer(truth.a, truth.b, truth.matching, pins);
  const PointTransfer without(truth.a, truth.b, truth.matching, {});
  for (const Pin& pin : pins) {
    EXPECT_LT((*transfer(pin.p_a_px).p - pin.p_b_px).norm(), 1.5);
    EXPECT_LT(transfer(pin.p_a_px).sigma, without(pin.p_a_px).sigma);
  }
}

TEST(PointTransfer, IsContinuousInsideARoom) {
  const TrueMatch truth(33, {});
  const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
  for (const Region& region : truth.a.regions) {
    const double reach = 0.6 * region.clearance_px;
    Point2 before = *transfer(region.anchor_px).p;
    for (double step = 0; step <= reach; step += 0.5) {
      const Point2 here = *transfer(region.anchor_px + Point2(step, 0)).p;
      EXPECT_LT((here - before).norm(), 3);
      before = here;
    }
  }
}

TEST(PointTransfer, TakesDoorsToDoors) {
  const TrueMatch truth(34, {});
  const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
  int doors = 0;
  for (const RegionBorder& border : truth.a.borders) {
    const Transferred place = transfer(border.line_px.midpoint());
    double nearest = 1e9;
    for (const RegionBorder& other : truth.b.borders)
      nearest = std::min(nearest, (*place.p - other.line_px.midpoint()).norm());
    EXPECT_LT(nearest, 8);
    ++doors;
  }
  EXPECT_GE(doors, 8);
}

TEST(PointTransfer, NeverEndsInAWallNorInARoomThatIsNotThePartner) {
  std::mt19937_64 random(40);
  for (std::uint64_t seed = 41; seed < 45; ++seed) {
    const TrueMatch truth(seed, test::random_habits(random));
    const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
    for (const Point2& p : truth.points(seed, 150)) {
      const Transferred there = transfer(p);
      if (!there.p) continue;
      const int label_a = room_at(truth.a.labels, p), label_b = room_at(truth.b.labels, *there.p);
      EXPECT_NE(label_b, 0);
      EXPECT_TRUE(std::any_of(truth.matching.pairs.begin(), truth.matching.pairs.end(), [&](const RegionPair& pair) {
        return pair.label_a == label_a && pair.label_b == label_b;
      }));
      EXPECT_GT(there.sigma, 0);
    }
  }
}

TEST(PointTransfer, IsAsSureAsItIsRightOnDrawingsOfAllHabits) {
  // Two in three lie within one and a half standard deviations per coordinate if the errors are normal.
  std::mt19937_64 random(50);
  double within = 0, all = 0;
  for (std::uint64_t seed = 51; seed < 59; ++seed) {
    const TrueMatch truth(seed, test::random_habits(random));
    const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
    for (const Point2& p : truth.points(seed, 100))
      if (const Transferred there = transfer(p); there.p)
        all += 1, within += (*there.p - truth.sketch.on_plan(p)).norm() < 1.5 * there.sigma;
  }
  EXPECT_GT(within / all, 0.65);
}

TEST(PointTransfer, GoesFromSketchOverPlanToMapAndBack) {
  // A sketch of a plan, and a map that is the plan turned and half as large again.
  const TrueMatch truth(60, {});
  const PointTransfer to_plan(truth.a, truth.b, truth.matching, {});
  const Eigen::Rotation2Dd turn(0.4);
  const PointWay to_map = [&](const Point2& p) {
    Transferred there;
    there.p = 1.5 * (turn * p), there.sigma = 2, there.confidence = 0.9;
    return there;
  };
  const PointWay from_map = [&](const Point2& p) {
    Transferred there;
    there.p = turn.inverse() * p / 1.5, there.sigma = 2 / 1.5, there.confidence = 0.9;
    return there;
  };
  const PointWay there = chained(to_plan, to_map);
  const PointWay back = chained(from_map, [&](const Point2& p) { return to_plan.inverse(p); });
  double squared = 0, variance = 0;
  const auto points = truth.points(4, 150);
  for (const Point2& p : points) {
    const Transferred on_map = there(p);
    ASSERT_TRUE(on_map.p.has_value());
    EXPECT_GT(on_map.sigma, 1.4 * to_plan(p).sigma);
    EXPECT_NEAR(on_map.confidence, 0.81, 1e-9);
    const Transferred home = carry_on(on_map, back);
    ASSERT_TRUE(home.p.has_value());
    squared += (*home.p - p).squaredNorm() / 2, variance += home.sigma * home.sigma;
  }
  EXPECT_LT(std::sqrt(squared / 150), 8);
  EXPECT_LT(squared, variance);
}

TEST(PointTransfer, SaysWhyThereIsNoPlace) {
  TrueMatch truth(35, {});
  const RegionPair gone = truth.matching.pairs.back();
  truth.matching.pairs.pop_back();
  truth.matching.pairs.push_back({gone.label_a, gone.label_b, 0, Verdict::kRejected});
  const PointTransfer transfer(truth.a, truth.b, truth.matching, {});
  const Transferred lost = transfer(truth.a.regions[static_cast<size_t>(gone.label_a - 1)].anchor_px);
  EXPECT_FALSE(lost.p.has_value());
  EXPECT_FALSE(lost.reason.empty());
  EXPECT_EQ(lost.confidence, 0);
  const Transferred wall = transfer(Point2(-300, 5));
  EXPECT_FALSE(wall.p.has_value());
  EXPECT_FALSE(wall.reason.empty());
  EXPECT_FALSE(transfer.inverse(truth.b.regions[static_cast<size_t>(gone.label_b - 1)].anchor_px).p.has_value());
}

TEST(PointTransfer, OutlivesTheMapsItWasMadeFrom) {
  std::optional<PointTransfer> transfer;
  Point2 p;
  {
    const TrueMatch truth(36, {});
    transfer.emplace(truth.a, truth.b, truth.matching, std::vector<Pin>{});
    p = truth.a.regions[0].anchor_px;
  }
  EXPECT_TRUE((*transfer)(p).p.has_value());
}

}  // namespace
}  // namespace smokemap
