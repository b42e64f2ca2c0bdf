#include "session/carrier.hpp"

#include <gtest/gtest.h>

#include "tests/engine/session/scene.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::poi_at;
using test::square_plan;

TEST(Carrier, ABottleOnThePlanLandsWhereThePlanLies) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {120, 120})), test::IsOk());
  const PlanStart start{Pose2(1, 2, kPi / 2), 0.3, 0.05};
  const MergedMap merged = plan_alone(board.layout->layout, start);
  const SketchReading none;
  const Transferred t = Carrier(board, merged, none).to_map(board.pois.at("p").place);
  ASSERT_TRUE(t.p);
  const Point2 p_layout = board.layout->layout.frame().to_metres({120, 120});
  EXPECT_THAT(*t.p, test::IsNearPoint(start.T_layout_robot.inverse() * p_layout, 1e-6));
  EXPECT_GT(t.sigma, 0.1) << "never without its error";
}

TEST(Carrier, AnEarlierPlansPlaceIsNoPlace) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"one", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {120, 120})), test::IsOk());
  ASSERT_THAT(board.apply(SetLayout{"two", square_plan(300)}), test::IsOk());
  const MergedMap merged = plan_alone(board.layout->layout, std::nullopt);
  const SketchReading none;
  const Transferred t = Carrier(board, merged, none).to_map(board.pois.at("p").place);
  EXPECT_FALSE(t.p);
  EXPECT_EQ(t.reason, "it was placed on an earlier plan");
}

TEST(Carrier, ASketchThatWasNotReadHasNoPlaces) {
  const Whiteboard board;
  const MergedMap merged;
  const SketchReading none;
  EXPECT_FALSE(Carrier(board, merged, none).to_map({PlaceFrame::kSketchPx, {5, 5}, 0}).p);
  EXPECT_FALSE(Carrier(board, merged, none).to_map({PlaceFrame::kLayoutPx, {5, 5}, 0}).p);
  EXPECT_TRUE(Carrier(board, merged, none).to_map({PlaceFrame::kMap, {5, 5}, 0}).p);
}

TEST(Carrier, TheWorseThePlanFitsTheLessSureIsThePlace) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {120, 120})), test::IsOk());
  MergedMap merged = plan_alone(board.layout->layout, PlanStart{});
  const SketchReading none;
  double last = 1.0;
  for (const char* verdict : {"fits", "unknown", "doubtful", "does not fit"}) {
    merged.fit.verdict = verdict;
    const Transferred t = Carrier(board, merged, none).to_map(board.pois.at("p").place);
    ASSERT_TRUE(t.p);
    EXPECT_LT(t.confidence, last) << verdict;
    last = t.confidence;
  }
  EXPECT_FALSE(Carrier(board, merged, none).to_map(board.pois.at("p").place).reason.empty());
}

TEST(Carrier, APlanThatIsNotAlignedHasNoPlaces) {
  Whiteboard board;
  ASSERT_THAT(board.apply(SetLayout{"plan", square_plan()}), test::IsOk());
  ASSERT_THAT(board.apply(poi_at("p", PlaceFrame::kLayoutPx, {120, 120})), test::IsOk());
  const MergedMap nothing;
  const SketchReading none;
  const Transferred t = Carrier(board, nothing, none).to_map(board.pois.at("p").place);
  EXPECT_FALSE(t.p);
  EXPECT_EQ(t.reason, "the plan is not aligned with the robot's map yet");
}

TEST(Carrier, APlaceOnAnEarlierRunsMapHasNone) {
  const Whiteboard board;
  const MergedMap merged;
  const SketchReading none;
  const Transferred t = Carrier(board, merged, none).to_map({PlaceFrame::kMap, {5, 5}, kEarlierMap});
  EXPECT_FALSE(t.p);
  EXPECT_FALSE(t.reason.empty());
}

}  // namespace
}  // namespace smokemap
