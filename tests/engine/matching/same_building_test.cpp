#include "matching/same_building.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <random>

#include "matching/match.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/building_pictures.hpp"
#include "tests/support/plan_pictures.hpp"
#include "tests/support/plan_sketches.hpp"

namespace smokemap {
namespace {

constexpr double kShownAsSure = 0.8;  // by the page

double surest(const Matching& matching) {
  double most = 0;
  for (const RegionPair& pair : matching.pairs) most = std::max(most, pair.confidence);
  return most;
}

test::PlanPicture building_of(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return seed % 3 == 0   ? test::office_plan(random, 4)
         : seed % 3 == 1 ? test::hall_plan(random)
                         : test::building_plan(random);
}

/// A drawing with the usual slips, all rooms in it.
Segmentation drawing_of(const test::PlanPicture& plan, std::uint64_t seed) {
  std::mt19937_64 random(seed + 100);
  test::SketchHabits habits;
  habits.quarter_turns = static_cast<int>(seed % 4), habits.bend_px = 4, habits.uneven = 0.1;
  return *segmentation_from_labels(test::sketch_of(plan, habits, random).picture.rooms);
}

Segmentation mirror_image(const cv::Mat& rooms) {
  cv::Mat mirrored;
  cv::flip(rooms, mirrored, 1);
  return *segmentation_from_labels(mirrored);
}

/// A building, a drawing of it, and what matching says of the two; made once, because several tests ask for it.
struct Own {
  Segmentation drawing, map;
  Matcher matcher;
  Matching before;  ///< any taps
};

const Own& own_of(std::uint64_t seed) {
  static std::map<std::uint64_t, Own> known;
  if (const auto found = known.find(seed); found != known.end()) return found->second;
  const test::PlanPicture plan = building_of(seed);
  const Segmentation drawing = drawing_of(plan, seed), map = *segmentation_from_labels(plan.rooms);
  const Matcher matcher = *Matcher::create(drawing, map);
  return known.emplace(seed, Own{drawing, map, matcher, *matcher.solve({}, {})}).first->second;
}

TEST(SameBuilding, RisesWithEveryKindOfEvidenceAndWithTaps) {
  const FitEvidence some{0.5, 0.5, 0.1, 10};
  const double before = same_building(some, 0);
  for (double FitEvidence::*kind : {&FitEvidence::likeness, &FitEvidence::explained, &FitEvidence::lead}) {
    FitEvidence more = some;
    more.*kind += 0.3;
    EXPECT_GT(same_building(more, 0), before);
  }
  for (int taps = 0; taps < 4; ++taps) EXPECT_GT(same_building(some, taps + 1), same_building(some, taps));
  EXPECT_EQ(same_building(some, 100), same_building(some, 4)) << "a person may be wrong about the whole building";
}

TEST(SameBuilding, FallsWhenOneMapHasManyMoreRooms) {
  double before = 1;
  for (const double ratio : {1.0, 1.5, 2.0, 4.0}) {
    const double now = same_building({0.7, 0.7, 0.1, 10, ratio}, 0);
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(SameBuilding, SaysLessTheFewerRoomsThereAre) {
  for (const FitEvidence& good : {FitEvidence{0.95, 1, 0.1, 0}, FitEvidence{0.3, 0.3, -0.1, 0}}) {
    double before = 0;
    for (int regions = 1; regions < 40; ++regions) {
      FitEvidence evidence = good;
      evidence.regions = regions;
      const double decided = std::abs(same_building(evidence, 0) - 0.5);
      EXPECT_GE(decided, before);
      before = decided;
    }
  }
  EXPECT_LT(same_building({1, 1, 0, 1}, 0), kShownAsSure) << "one room fits into every building";
}

TEST(SameBuilding, IsNeverQuiteSureOfAnything) {
  EXPECT_LT(same_building({1, 1, 2, 1000}, 9), 1);
  EXPECT_GT(same_building({0, 0, -2, 1000}, 0), 0);
}

TEST(SameBuilding, TellsABuildingFromOthersAndFromItsMirrorImage) {
  double like = 0;
  for (std::uint64_t seed = 4; seed <= 6; ++seed) {
    const Segmentation& drawing = own_of(seed).drawing;
    const double own = own_of(seed).before.same_building;
    EXPECT_GT(own, 0.9);
    EXPECT_LT(match(drawing, mirror_image(own_of(seed).map.labels))->same_building, own);
    const Matching other_kind = *match(drawing, *segmentation_from_labels(building_of(seed + 1).rooms));
    EXPECT_LT(other_kind.same_building, 0.6);
    EXPECT_LT(surest(other_kind), kShownAsSure);
    like += match(drawing, *segmentation_from_labels(building_of(seed + 30).rooms))->same_building;
  }
  // One kind and as many rooms, drawn carefully: nobody could be sure from the rooms alone, but it is less than
  // certain.
  EXPECT_LT(like / 3, 0.9);
}

TEST(SameBuilding, ADrawingOfAnotherBuildingIsDoubtfulAndNoRoomIsSure) {
  // It was matched room by room with 0.97: confidences took it for granted that the plan was the right one.
  std::mt19937_64 random(7);
  const test::PlanPicture hall = test::hall_plan(random), office = test::office_plan(random, 4);
  const Matching matching = *match(drawing_of(hall, 7), *segmentation_from_labels(office.rooms));
  EXPECT_FALSE(matching.pairs.empty());
  EXPECT_LT(matching.same_building, kFitsFrom);
  EXPECT_TRUE(matching.doubtful);
  EXPECT_LT(surest(matching), kFitsFrom);
}

TEST(SameBuilding, WhatIsDoubtfulAsAWholeHasNoSureRoomButThoseAPersonNamed) {
  for (const std::uint64_t seed : {1, 3, 4}) {
    const Segmentation drawing = drawing_of(building_of(seed), seed);
    const Segmentation map = *segmentation_from_labels(building_of(seed + 1).rooms);
    const std::vector<RegionPair> said = {{1, 1, 1, Verdict::kConfirmed}};
    const Matching matching = *match(drawing, map, {}, said);
    if (!matching.doubtful) continue;
    for (const RegionPair& pair : matching.pairs) {
      if (pair.verdict == Verdict::kConfirmed)
        EXPECT_EQ(pair.confidence, 1);
      else
        EXPECT_LE(pair.confidence, 0.75);
    }
    for (const RegionPair& pair : matching.runner_up) EXPECT_LE(pair.confidence, 0.75);
  }
}

TEST(SameBuilding, RightTapsRaiseIt) {
  int raised = 0, all = 0;
  for (const std::uint64_t seed : {1, 3, 4, 6}) {
    const auto& [drawing, map, matcher, before] = own_of(seed);
    const RegionPair surest_pair = before.pairs.back();
    RegionPair said = surest_pair;
    said.verdict = Verdict::kConfirmed;
    const Matching after = *matcher.solve({}, {said});
    raised += after.same_building >= before.same_building, all += 1;
  }
  EXPECT_GE(raised, all - 1);
}

TEST(SameBuilding, RightTapsNeverLowerItBelowWhatWasSaidWithoutThem) {
  // Two right taps made seven of fourteen robot maps of their own building "another building": what a person binds is
  // not what the answer would have chosen, so that it looked poorer than the mirror image that nobody had tapped.
  for (const std::uint64_t seed : {1, 3, 4, 6}) {
    const auto& [drawing, map, matcher, before] = own_of(seed);
    std::vector<Pin> pins;
    for (const RegionPair& pair : before.pairs) {
      pins.push_back({drawing.regions[static_cast<size_t>(pair.label_a - 1)].anchor_px,
                      map.regions[static_cast<size_t>(pair.label_b - 1)].anchor_px});
      if (pins.size() > 2) break;
      EXPECT_GE(matcher.solve(pins, {})->same_building, before.same_building)
          << "seed " << seed << ", taps " << pins.size();
    }
  }
}

TEST(SameBuilding, RoomsThatWereRejectedMayLowerIt) {
  const auto& [drawing, map, matcher, before] = own_of(4);
  std::vector<RegionPair> said = before.pairs;
  for (RegionPair& pair : said) pair.verdict = Verdict::kRejected;
  EXPECT_LT(matcher.solve({}, said)->same_building, before.same_building);
  said.front().verdict = Verdict::kConfirmed;
  EXPECT_LT(matcher.solve({}, said)->same_building, before.same_building);
}

TEST(SameBuilding, OfAMirroredDrawingIsAskedAgainstTheDrawingAsItIs) {
  const test::PlanPicture plan = building_of(4);
  MatchParams either;
  either.allow_mirror = true;
  const Segmentation map = *segmentation_from_labels(plan.rooms);
  const Matching mirrored = *match(mirror_image(plan.rooms), map, {}, {}, either);
  EXPECT_LT(mirrored.turn_b_a.determinant(), 0);
  EXPECT_GT(mirrored.same_building, 0.8);
  EXPECT_NEAR(match(map, map, {}, {}, either)->same_building, mirrored.same_building, 0.1);
}

}  // namespace
}  // namespace smokemap
