#include "session/whiteboard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

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

TEST(Whiteboard, AFullSketchTookNoStrokesEvenAfterItWasCleared) {
  Whiteboard board;
  for (int i = 0; i < 5000; ++i) ASSERT_THAT(board.apply(AddStroke{stroke("s" + std::to_string(i))}), test::IsOk());
  EXPECT_THAT(board.apply(AddStroke{stroke("one more")}), test::Fails(Errc::kTooLarge));
  ASSERT_THAT(board.apply(EraseStroke{"s7", false}), test::IsOk());
  EXPECT_THAT(board.apply(AddStroke{stroke("one more")}), test::IsOk());
  ASSERT_THAT(board.apply(ClearSketch{}), test::IsOk());
  for (int i = 0; i < 5000; ++i) ASSERT_THAT(board.apply(AddStroke{stroke("t" + std::to_string(i))}), test::IsOk());
  EXPECT_EQ(board.sketch().strokes.size(), 5000u);
  EXPECT_EQ(board.sketch().strokes.back().id, "t4999");
  EXPECT_THAT(board.apply(EraseStroke{"s8", true}), test::Fails(Errc::kNotFound)) << "what was cleared long ago";
}

TEST(Whiteboard, AfterAThousandGoalsNoRobotCouldBeSentAnywhereEverAgain) {
  Whiteboard board;
  for (int i = 0; i < 1000; ++i) ASSERT_THAT(board.apply(goal_at("g" + std::to_string(i), {1, 1})), test::IsOk());
  EXPECT_THAT(board.apply(goal_at("new", {1, 1})), test::Fails(Errc::kTooLarge)) << "all of them wait";
  ASSERT_THAT(board.apply(CancelGoal{"g500"}), test::IsOk());
  ASSERT_THAT(board.apply(CancelGoal{"g3"}), test::IsOk());
  ASSERT_THAT(board.apply(goal_at("new", {2, 2})), test::IsOk());
  EXPECT_EQ(board.goals.size(), 1000u);
  EXPECT_EQ(board.find_goal("g3"), nullptr) << "the oldest that is over makes room";
  EXPECT_NE(board.find_goal("g500"), nullptr);
  EXPECT_EQ(board.goals.back().id, "new");
}

TEST(Whiteboard, RemovedPointsOfInterestMakeRoomForNewOnes) {
  Whiteboard board;
  for (int i = 0; i < 5000; ++i)
    ASSERT_THAT(board.apply(poi_at("p" + std::to_string(i), PlaceFrame::kMap, {1, 1})), test::IsOk());
  EXPECT_THAT(board.apply(poi_at("new", PlaceFrame::kMap, {1, 1})), test::Fails(Errc::kTooLarge));
  EXPECT_THAT(board.apply(poi_at("p3", PlaceFrame::kMap, {5, 5})), test::IsOk()) << "moving one is no new one";
  ASSERT_THAT(board.apply(RemovePoi{"p9"}), test::IsOk());
  EXPECT_THAT(board.apply(poi_at("new", PlaceFrame::kMap, {1, 1})), test::IsOk());
  EXPECT_EQ(board.pois.size(), 5000u);
  EXPECT_FALSE(board.pois.contains("p9"));
}

TEST(Whiteboard, AnchorsAndVerdictsHadNoEnd) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  for (int i = 0; i < 1000; ++i)
    ASSERT_THAT(board.apply(AddAnchor{"a" + std::to_string(i), {30, 30}, {0, 0}}), test::IsOk());
  EXPECT_THAT(board.apply(AddAnchor{"more", {30, 30}, {0, 0}}), test::Fails(Errc::kTooLarge));
  EXPECT_THAT(board.apply(AddAnchor{"a7", {40, 30}, {0, 0}}), test::IsOk()) << "one that is there may move";
  for (int i = 0; i < 5100; ++i)
    ASSERT_THAT(board.apply(JudgePair{{1.0 * i, 0}, {0, 0}, Verdict::kConfirmed}), test::IsOk());
  EXPECT_EQ(board.pair_verdicts.size(), 5000u);
  EXPECT_EQ(board.pair_verdicts.back().p_sketch_px, Point2(5099, 0)) << "the newest are kept";
}

TEST(Whiteboard, AScaleInMillimetresMadeAPlanOfManyKilometres) {
  Whiteboard board;
  LayoutMap layout = square_plan();
  for (const double bad : {0.0, -1.0, 10.0, std::nan(""), 10.1}) {
    layout.scale->metres_per_pixel = bad;
    EXPECT_THAT(board.apply(SetLayout{"plan", layout}), test::Fails(Errc::kInvalidArgument)) << bad;
  }
  layout.scale->metres_per_pixel = 9;  // 200 px: 1.8 km
  EXPECT_THAT(board.apply(SetLayout{"plan", layout}), test::IsOk());
  layout.corners[2].p_px = {260, 220};
  EXPECT_THAT(board.apply(SetLayout{"plan", layout}), test::Fails(Errc::kInvalidArgument));
  layout.scale.reset();
  EXPECT_THAT(board.apply(SetLayout{"plan", layout}), test::IsOk()) << "a drawing without a scale has no width";
  layout.corners[2].p_px = {1e7, 0};
  EXPECT_THAT(board.apply(SetLayout{"plan", layout}), test::Fails(Errc::kInvalidArgument));
}

int changes(const Whiteboard& board) {
  const WhiteboardRevisions& r = board.revisions;
  return r.layout_frame + r.plan + r.sketch + r.goals;
}

TEST(Whiteboard, SayingTheSameTwiceCostsNoSecondSolve) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  const std::vector<Command> commands{AddAnchor{"a", {30, 30}, {1, 2}},
                                      JudgeWall{1, WallVerdict::kGone},
                                      MeasureWall{2, 4.5},
                                      PinCorner{3, Point2(1, 2)},
                                      AddStroke{stroke("s")},
                                      SetSketchSheet{500, 400},
                                      JudgePair{{1, 1}, {2, 2}, Verdict::kRejected},
                                      poi_at("p", PlaceFrame::kLayoutPx, {40, 40}),
                                      goal_at("g", {1, 1}),
                                      EraseStroke{"s", false},
                                      ClearSketch{},
                                      CancelGoal{"g"},
                                      RemovePoi{"p"},
                                      PinCorner{3, std::nullopt},
                                      MeasureWall{2, std::nullopt},
                                      JudgeWall{1, WallVerdict::kNone},
                                      RemoveAnchor{"a"}};
  for (std::size_t i = 0; i < commands.size(); ++i) {
    ASSERT_THAT(board.apply(commands[i]), test::IsOk()) << i;
    const int before = changes(board);
    ASSERT_THAT(board.apply(commands[i]), test::IsOk()) << i;
    EXPECT_EQ(changes(board), before) << "command " << i;
  }
}

/// Every refusal leaves the board as it was.
TEST(Whiteboard, ChangesNothingWhenItRefuses) {
  const double nan = std::nan("");
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(goal_at("g", {1, 1})), test::IsOk());
  const int before = changes(board);
  Stroke pointless = stroke("s"), endless = stroke("s"), nowhere = stroke("s");
  pointless.points_px.clear();
  endless.points_px.assign(20'001, Point2(1, 1));
  nowhere.points_px.push_back({nan, 1});
  PlacePoi wordy = poi_at("p", PlaceFrame::kMap, {1, 1});
  wordy.poi.label = std::string(201, 'x');
  SetGoal turning = goal_at("h", {1, 1}), nobodys = goal_at("h", {1, 1});
  turning.goal.heading_rad = nan, nobodys.goal.robot.clear();
  const std::vector<Command> refused{SetStart{"r", {nan, 1}, 0},
                                     SetStart{"r", {1, 1}, nan},
                                     AddAnchor{"", {1, 1}, {1, 1}},
                                     AddAnchor{std::string(65, 'a'), {1, 1}, {1, 1}},
                                     AddAnchor{"a", {1, 1}, {2e6, 1}},
                                     JudgeWall{-1, WallVerdict::kGone},
                                     JudgeWall{4, WallVerdict::kGone},
                                     AddStroke{pointless},
                                     AddStroke{endless},
                                     AddStroke{nowhere},
                                     SetSketchSheet{15, 100},
                                     SetSketchSheet{100, 8193},
                                     JudgePair{{nan, 1}, {1, 1}, Verdict::kConfirmed},
                                     wordy,
                                     turning,
                                     nobodys,
                                     goal_at("h", {nan, 1}),
                                     goal_at(std::string(65, 'g'), {1, 1}),
                                     RemovePoi{"none"},
                                     SetExploring{"", true}};
  for (std::size_t i = 0; i < refused.size(); ++i) {
    EXPECT_FALSE(board.apply(refused[i]).ok()) << i;
    EXPECT_EQ(changes(board), before) << i;
  }
  EXPECT_TRUE(board.anchors.empty() && board.pois.empty() && board.sketch().strokes.empty() && !board.start);
  EXPECT_EQ(board.goals.size(), 1u);
}

TEST(Whiteboard, APointMovedByAnotherPersonKeepsTheTimeItWasFirstPlaced) {
  Whiteboard board;
  PlacePoi first = poi_at("p", PlaceFrame::kMap, {1, 1}), second = poi_at("p", PlaceFrame::kMap, {2, 2});
  first.poi.created = 10, second.poi.created = 20;
  first.poi.author = "Anna", second.poi.author = "Bo";
  ASSERT_THAT(board.apply(first), test::IsOk());
  ASSERT_THAT(board.apply(second), test::IsOk());
  EXPECT_EQ(board.pois.at("p").created, 10);
  EXPECT_EQ(board.pois.at("p").author, "Bo");
  EXPECT_EQ(board.pois.at("p").place.p, Point2(2, 2));
  ASSERT_THAT(board.apply(RemovePoi{"p"}), test::IsOk());
  ASSERT_THAT(board.apply(second), test::IsOk());
  EXPECT_FALSE(board.pois.at("p").removed) << "placing it again takes the removal back";
}

TEST(Whiteboard, StopsOneRobotOrAllAndAReleaseOfAllReleasesEachOfThem) {
  Whiteboard board;
  ASSERT_THAT(board.apply(EmergencyStop{"fox", true}), test::IsOk());
  EXPECT_TRUE(board.is_stopped("fox") && !board.is_stopped("owl"));
  ASSERT_THAT(board.apply(EmergencyStop{"", true}), test::IsOk());
  EXPECT_TRUE(board.is_stopped("owl"));
  ASSERT_THAT(board.apply(EmergencyStop{"", false}), test::IsOk());
  EXPECT_FALSE(board.is_stopped("fox") || board.is_stopped("owl"));
  ASSERT_THAT(board.apply(SetExploring{"owl", true}), test::IsOk());
  EXPECT_TRUE(board.explores("owl") && !board.explores("fox"));
}

}  // namespace
}  // namespace smokemap
