#include "session/sketch_reader.hpp"

#include <gtest/gtest.h>

#include "tests/engine/session/scene.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

Stroke pen(const std::string& id, std::vector<Point2> points_px) {
  Stroke stroke;
  stroke.id = id;
  stroke.points_px = std::move(points_px);
  return stroke;
}

/// Two rooms side by side with a doorway between them, in sheet pixels.
SketchMap two_rooms() {
  SketchMap sketch;
  sketch.width_px = 900, sketch.height_px = 700;
  sketch.strokes = {pen("outline", {{100, 100}, {800, 100}, {800, 600}, {100, 600}, {100, 100}}),
                    pen("upper", {{350, 100}, {350, 300}}), pen("lower", {{350, 380}, {350, 600}})};
  return sketch;
}

/// The same rooms as a plan of 14 x 10 m at 0.02 m a pixel.
std::shared_ptr<const LayoutView> two_room_plan() {
  LayoutMap layout;
  layout.width_px = 900, layout.height_px = 700;
  for (const Point2& p : {Point2(100, 100), Point2(800, 100), Point2(800, 600), Point2(100, 600), Point2(350, 100),
                          Point2(350, 310), Point2(350, 370), Point2(350, 600)})
    layout.corners.push_back({p, 2, 1});
  for (const auto& [a, b] : {std::pair(0, 4), {4, 1}, {1, 2}, {2, 7}, {7, 3}, {3, 0}, {4, 5}, {6, 7}})
    layout.walls.push_back({a, b, 6, 1, false});
  layout.openings.push_back({{{350, 310}, {350, 370}}, OpeningKind::kDoor, 1});
  layout.scale = LayoutScale{0.02, 0.02, true};
  return std::make_shared<const LayoutView>(LayoutView{"plan", layout});
}

TEST(SketchReader, AnEmptySketchIsNoWarningButHasNoPlaces) {
  SketchReader reader;
  const SketchReading reading = reader.read({}, two_room_plan(), {});
  ASSERT_TRUE(reading.sketch);
  EXPECT_TRUE(reading.sketch->warning.empty());
  EXPECT_FALSE(reading.to_plan);
  EXPECT_EQ(reading.no_transfer, "nothing is drawn yet");
  ASSERT_TRUE(reading.match) << "the plan's rooms are shown all the same";
  EXPECT_EQ(reading.match->map_regions.size(), 2u);
}

TEST(SketchReader, WithoutAPlanThereAreRegionsAndAReason) {
  SketchReader reader;
  const SketchReading reading = reader.read(two_rooms(), nullptr, {});
  EXPECT_EQ(reading.sketch->regions.size(), 2u);
  EXPECT_FALSE(reading.match);
  EXPECT_EQ(reading.no_transfer, "there is no plan to match the sketch with");
}

TEST(SketchReader, ASketchOfThePlanIsMatchedAndCarriesPoints) {
  SketchReader reader;
  const SketchReading reading = reader.read(two_rooms(), two_room_plan(), {});
  ASSERT_TRUE(reading.to_plan);
  ASSERT_TRUE(reading.match);
  EXPECT_FALSE(reading.match->matching.pairs.empty());
  const Transferred t = (*reading.to_plan)(Point2(220, 350));
  ASSERT_TRUE(t.p);
  EXPECT_THAT(*t.p / reading.pixels_per_layout_px, test::IsNearPoint(Point2(220, 350), 60));
  EXPECT_GT(t.sigma, 0);
  EXPECT_FALSE((*reading.to_plan)(Point2(20, 20)).p) << "outside of everything drawn";
}

TEST(SketchReader, WhatAPersonLinkedStaysLinkedAfterDrawingOn) {
  SketchReader reader;
  const std::vector<PairVerdict> said = {{{220, 350}, {560, 350}, Verdict::kConfirmed}};
  SketchMap sketch = two_rooms();
  for (int round = 0; round < 2; ++round) {
    const SketchReading reading = reader.read(sketch, two_room_plan(), said);
    ASSERT_TRUE(reading.match);
    const auto& pairs = reading.match->matching.pairs;
    EXPECT_TRUE(
        std::any_of(pairs.begin(), pairs.end(), [](const RegionPair& p) { return p.verdict == Verdict::kConfirmed; }))
        << "round " << round;
    sketch.strokes.push_back(pen("table", {{600, 300}, {650, 300}, {650, 340}, {600, 340}, {600, 300}}));
  }
}

TEST(SketchReader, ThePlansRegionsAreReadOnceAPlan) {
  SketchReader reader;
  const auto plan = two_room_plan();
  const auto first = reader.read(two_rooms(), plan, {}).match->map_regions;
  const auto second = reader.read(two_rooms(), plan, {}).match->map_regions;
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].outline_px, second[i].outline_px);
}

TEST(LabelAt, IsTheNearestRegionWithinReach) {
  Segmentation segmentation;
  segmentation.labels = cv::Mat::zeros(20, 20, CV_16U);
  segmentation.labels.at<std::uint16_t>(5, 5) = 3;
  segmentation.labels.at<std::uint16_t>(5, 9) = 4;
  EXPECT_EQ(label_at(segmentation, {5, 5}, 0), 3);
  EXPECT_EQ(label_at(segmentation, {6, 5}, 3), 3);
  EXPECT_EQ(label_at(segmentation, {8, 5}, 3), 4);
  EXPECT_EQ(label_at(segmentation, {15, 15}, 3), 0);
  EXPECT_EQ(label_at(segmentation, {-1e9, 5}, 3), 0);
  EXPECT_EQ(label_at(segmentation, {std::nan(""), 5}, 3), 0);
}

/// A long corridor with six rooms on its upper side: nothing like the plan.
SketchMap six_rooms() {
  SketchMap sketch;
  sketch.width_px = 1000, sketch.height_px = 400;
  sketch.strokes = {pen("outline", {{40, 40}, {940, 40}, {940, 340}, {40, 340}, {40, 40}}),
                    pen("corridor", {{40, 250}, {60, 250}})};
  for (int room = 0; room < 6; ++room) {
    const double x = 40 + 150 * room, n = room;
    sketch.strokes.push_back(pen("wall" + std::to_string(room), {{x, 40}, {x, 250}}));
    sketch.strokes.push_back(pen("front" + std::to_string(room), {{x + 60 + n, 250}, {x + 150, 250}}));
    sketch.strokes.push_back(pen("jamb" + std::to_string(room), {{x, 250}, {x + 10, 250}}));
  }
  return sketch;
}

TEST(SketchReader, SaysThatASketchIsNotOfThePlan) {
  SketchReader reader;
  const SketchReading reading = reader.read(six_rooms(), two_room_plan(), {});
  ASSERT_TRUE(reading.match);
  const Matching& matching = reading.match->matching;
  EXPECT_LT(matching.same_building, kFitsFrom);
  EXPECT_TRUE(matching.doubtful);
  EXPECT_NE(reading.sketch->warning.find("does not seem to show"), std::string::npos) << reading.sketch->warning;
  for (const RegionPair& pair : matching.pairs) EXPECT_LT(pair.confidence, 0.5);
}

TEST(SketchReader, AnswersATapAsOneWouldThatReadsEverythingAnew) {
  SketchReader warm;
  const auto plan = two_room_plan();
  (void)warm.read(two_rooms(), plan, {});
  SketchMap sketch = two_rooms();
  for (const Verdict verdict : {Verdict::kConfirmed, Verdict::kRejected, Verdict::kProposed}) {
    const std::vector<PairVerdict> said = {{{220, 350}, {560, 350}, verdict}};
    const SketchReading now = warm.read(sketch, plan, said), anew = SketchReader().read(sketch, plan, said);
    ASSERT_TRUE(now.match && anew.match);
    ASSERT_EQ(now.match->matching.pairs.size(), anew.match->matching.pairs.size());
    for (std::size_t i = 0; i < now.match->matching.pairs.size(); ++i)
      EXPECT_EQ(now.match->matching.pairs[i].confidence, anew.match->matching.pairs[i].confidence);
    EXPECT_EQ(now.sketch->warning, anew.sketch->warning);
    EXPECT_EQ(now.sketch->gaps.size(), anew.sketch->gaps.size());
  }
  sketch.strokes.push_back(pen("third", {{350, 350}, {800, 350}}));  // drawn on: the old rooms must not stay
  EXPECT_EQ(warm.read(sketch, plan, {}).sketch->regions.size(),
            SketchReader().read(sketch, plan, {}).sketch->regions.size());
  sketch.strokes.clear();
  EXPECT_TRUE(warm.read(sketch, plan, {}).sketch->regions.empty());
}

TEST(SketchReader, TakesAnotherPlanWithTheSameDrawing) {
  SketchReader reader;
  ASSERT_TRUE(reader.read(two_rooms(), two_room_plan(), {}).to_plan);
  EXPECT_FALSE(reader.read(two_rooms(), nullptr, {}).to_plan);
  const SketchReading again = reader.read(two_rooms(), two_room_plan(), {});
  EXPECT_TRUE(again.to_plan);
  EXPECT_EQ(again.sketch->regions.size(), 2u);
}

}  // namespace
}  // namespace smokemap
