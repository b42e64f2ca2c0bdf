#include "session/whiteboard.hpp"

#include <gtest/gtest.h>

#include "tests/engine/session/scene.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::goal_at;
using test::poi_at;
using test::square_plan;
using test::stroke;

TEST(Whiteboard, TheSameCommandTwiceChangesNothingTheSecondTime) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(AddStroke{stroke("s1")}), test::IsOk());
  ASSERT_THAT(board.apply(goal_at("g1", {1, 1})), test::IsOk());
  const int sketch = board.revisions.sketch;
  ASSERT_THAT(board.apply(AddStroke{stroke("s1")}), test::IsOk());
  ASSERT_THAT(board.apply(goal_at("g1", {9, 9})), test::IsOk());
  EXPECT_EQ(board.revisions.sketch, sketch);
  EXPECT_EQ(board.sketch().strokes.size(), 1u);
  EXPECT_EQ(board.goals.size(), 1u);
  EXPECT_EQ(board.goals.front().place.p, Point2(1, 1));
}

TEST(Whiteboard, ErasedStrokesComeBack) {
  Whiteboard board;
  ASSERT_THAT(board.apply(AddStroke{stroke("s1")}), test::IsOk());
  ASSERT_THAT(board.apply(EraseStroke{"s1", false}), test::IsOk());
  EXPECT_TRUE(board.sketch().strokes.empty());
  ASSERT_THAT(board.apply(EraseStroke{"s1", true}), test::IsOk());
  EXPECT_EQ(board.sketch().strokes.size(), 1u);
  EXPECT_THAT(board.apply(EraseStroke{"s2", false}), test::Fails(Errc::kNotFound));
}

TEST(Whiteboard, RefusesWhatCannotBe) {
  Whiteboard board;
  EXPECT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {1, 1})), test::Fails(Errc::kNotFound));
  EXPECT_THAT(board.apply(poi_at("", PlaceFrame::kMap, {1, 1})), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(board.apply(poi_at("p", PlaceFrame::kMap, {std::nan(""), 1})), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(board.apply(CancelGoal{"g"}), test::Fails(Errc::kNotFound));
  EXPECT_THAT(board.apply(JudgeWall{0, WallVerdict::kGone}), test::Fails(Errc::kNotFound));
  LayoutMap broken = square_plan();
  broken.walls[0].corner_a = 99;
  EXPECT_THAT(board.apply(SetLayout{"plan", broken}), test::Fails(Errc::kInvalidArgument));
  EXPECT_FALSE(board.layout);
}

TEST(Whiteboard, AnotherPictureForgetsWhatWasSaidAboutTheOldOne) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(AddAnchor{"a", {30, 30}, {0, 0}}), test::IsOk());
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  EXPECT_EQ(board.anchors.size(), 1u) << "the same picture, walls corrected";
  ASSERT_THAT(board.apply(SetLayout{"two", square_plan()}), test::IsOk());
  EXPECT_TRUE(board.anchors.empty());
}

TEST(Whiteboard, OneRobotsReleaseDoesNotReleaseAll) {
  Whiteboard board;
  ASSERT_THAT(board.apply(EmergencyStop{"", true}), test::IsOk());
  ASSERT_THAT(board.apply(EmergencyStop{"robot1", false}), test::IsOk());
  EXPECT_TRUE(board.is_stopped("robot1"));
  ASSERT_THAT(board.apply(EmergencyStop{"", false}), test::IsOk());
  EXPECT_FALSE(board.is_stopped("robot1"));
}

TEST(Whiteboard, MeasuredWallsAndPinnedCornersStayUntilTakenBackOrThePlanChanges) {
  Whiteboard board;
  EXPECT_THAT(board.apply(MeasureWall{0, 4.2}), test::Fails(Errc::kNotFound)) << "there is no plan";
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  const int before = board.revisions.plan;
  ASSERT_THAT(board.apply(MeasureWall{0, 4.2}), test::IsOk());
  ASSERT_THAT(board.apply(PinCorner{3, Point2(1, 2)}), test::IsOk());
  EXPECT_GT(board.revisions.plan, before);
  EXPECT_EQ(board.wall_lengths_m.at(0), 4.2);
  EXPECT_EQ(board.corner_pins.at(3), Point2(1, 2));
  EXPECT_THAT(board.apply(MeasureWall{4, 4.2}), test::Fails(Errc::kNotFound));
  EXPECT_THAT(board.apply(MeasureWall{0, 0.0}), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(board.apply(MeasureWall{0, std::nan("")}), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(board.apply(PinCorner{-1, Point2(1, 2)}), test::Fails(Errc::kNotFound));
  EXPECT_THAT(board.apply(PinCorner{0, Point2(1, std::nan(""))}), test::Fails(Errc::kInvalidArgument));
  EXPECT_EQ(board.wall_lengths_m.size() + board.corner_pins.size(), 2u) << "what was refused changed nothing";
  ASSERT_THAT(board.apply(PinCorner{3, std::nullopt}), test::IsOk());
  EXPECT_TRUE(board.corner_pins.empty());
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  EXPECT_TRUE(board.wall_lengths_m.empty()) << "walls are counted anew";
}

}  // namespace
}  // namespace smokemap
