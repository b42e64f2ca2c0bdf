// The generator of drawings that matching is tested and measured with: what it says is the truth must be the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>

#include "tests/support/plan_pictures.hpp"
#include "tests/support/plan_sketches.hpp"

namespace smokemap {
namespace {

std::set<int> rooms_in(const cv::Mat& rooms) {
  std::set<int> found;
  for (int y = 0; y < rooms.rows; ++y)
    for (int x = 0; x < rooms.cols; ++x) found.insert(rooms.at<unsigned short>(y, x));
  found.erase(0);
  return found;
}

TEST(PlanSketches, DrawEveryPointInTheRoomWhereItIsOnThePlan) {
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    std::mt19937_64 random(seed);
    const test::PlanPicture plan = seed % 2 ? test::hall_plan(random) : test::office_plan(random);
    const test::PlanSketch sketch = test::sketch_of(plan, test::random_habits(random), random);
    int checked = 0, same = 0;
    for (int y = 0; y < sketch.picture.rooms.rows; y += 3)
      for (int x = 0; x < sketch.picture.rooms.cols; x += 3) {
        const int room = sketch.picture.rooms.at<unsigned short>(y, x);
        if (room == 0) continue;
        const Point2 p = sketch.on_plan(Point2(x, y));
        const cv::Point at(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
        ASSERT_TRUE(cv::Rect({}, plan.rooms.size()).contains(at));
        checked += 1, same += plan.rooms.at<unsigned short>(at) == room;
      }
    EXPECT_GT(checked, 500);
    EXPECT_GT(same, 0.95 * checked);  // the rest lies in walls that were forgotten and doors drawn wide
  }
}

TEST(PlanSketches, LeaveOutWhatTheySayTheyLeaveOut) {
  std::mt19937_64 random(20);
  const test::PlanPicture plan = test::office_plan(random);
  test::SketchHabits habits;
  habits.rooms_left_out = 3;
  const test::PlanSketch sketch = test::sketch_of(plan, habits, random);
  EXPECT_EQ(sketch.left_out.size(), 3u);
  const std::set<int> drawn = rooms_in(sketch.picture.rooms);
  for (int room = 1; room <= static_cast<int>(plan.boxes.size()); ++room)
    EXPECT_EQ(drawn.contains(room), !sketch.left_out.contains(room));
}

TEST(PlanSketches, MirrorTurnsTheOtherWayRound) {
  std::mt19937_64 random(21);
  const test::PlanPicture plan = test::office_plan(random);
  for (const bool mirrored : {false, true}) {
    test::SketchHabits habits;
    habits.mirrored = mirrored, habits.bend_px = 0, habits.tilt_rad = 0;
    const test::PlanSketch sketch = test::sketch_of(plan, habits, random);
    const Point2 middle(sketch.to_plan.cols / 2, sketch.to_plan.rows / 2);
    const Point2 right = sketch.on_plan(middle + Point2(20, 0)) - sketch.on_plan(middle);
    const Point2 down = sketch.on_plan(middle + Point2(0, 20)) - sketch.on_plan(middle);
    EXPECT_EQ(right.x() * down.y() - right.y() * down.x() < 0, mirrored);
  }
}

TEST(PlanSketches, UnevenScaleGivesBothSidesOfTheCorridorTheirOwnWidths) {
  std::mt19937_64 random(22);
  const test::TwoSidedScale scale(0.5, 400, 300, random);
  double apart = 0;
  for (double x = 0; x < 400; x += 7) {
    EXPECT_LT(scale(x, 10), scale(x + 1, 10));  // no room is turned inside out
    EXPECT_LT(scale(x, 290), scale(x + 1, 290));
    apart = std::max(apart, std::abs(scale(x, 10) - scale(x, 290)));
  }
  EXPECT_GT(apart, 10);
}

TEST(PlanSketches, ShowOnlyThePartThatWasSeen) {
  std::mt19937_64 random(23);
  const test::PlanPicture plan = test::office_plan(random);
  test::SketchHabits habits;
  habits.seen = 0.5;
  const test::PlanSketch part = test::sketch_of(plan, habits, random);
  const double share = static_cast<double>(cv::countNonZero(part.picture.free_space)) /
                       (habits.scale * habits.scale * cv::countNonZero(plan.free_space));
  EXPECT_GT(share, 0.25);
  EXPECT_LT(share, 0.75);
}

}  // namespace
}  // namespace smokemap
