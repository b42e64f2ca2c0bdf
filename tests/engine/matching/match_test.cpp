#include "matching/match.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>

#include "core/random.hpp"
#include "segmentation/segment.hpp"
#include "tests/support/plan_pictures.hpp"
#include "tests/support/plan_sketches.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// Regions as the generator meant them, so that matching is tested alone.
Segmentation truth_of(const test::PlanPicture& plan) {
  auto segmentation = segmentation_from_labels(plan.rooms);
  EXPECT_TRUE(segmentation.ok());
  return *segmentation;
}

/// Share of pairs that join a region to the same room of the plan, and share of regions of a that got their room.
struct Judged {
  double right = 0, found = 0;
};
Judged judge(const Segmentation& a, const cv::Mat& rooms_a, const Segmentation& b, const cv::Mat& rooms_b,
             const Matching& matching) {
  double right = 0;
  std::set<int> found;
  for (const RegionPair& pair : matching.pairs) {
    const bool same =
        test::true_room(a.labels, pair.label_a, rooms_a).room == test::true_room(b.labels, pair.label_b, rooms_b).room;
    right += same;
    if (same) found.insert(pair.label_a);
  }
  return {matching.pairs.empty() ? 0 : right / static_cast<double>(matching.pairs.size()),
          static_cast<double>(found.size()) / static_cast<double>(a.regions.size())};
}

bool has_pair(const std::vector<RegionPair>& pairs, int a, int b, Verdict verdict) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const RegionPair& pair) {
    return pair.label_a == a && pair.label_b == b && pair.verdict == verdict;
  });
}

TEST(Match, FindsAMapInItself) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 3; ++i) {
    const Segmentation map = truth_of(test::office_plan(random));
    const auto matching = match(map, map);
    ASSERT_THAT(matching, test::IsOk());
    EXPECT_EQ(matching->pairs.size(), map.regions.size());
    for (const RegionPair& pair : matching->pairs) EXPECT_EQ(pair.label_a, pair.label_b);
  }
}

TEST(Match, FindsATurnedMap) {
  std::mt19937_64 random(2);
  const test::PlanPicture plan = test::office_plan(random);
  for (const int code : {cv::ROTATE_90_CLOCKWISE, cv::ROTATE_180, cv::ROTATE_90_COUNTERCLOCKWISE}) {
    test::PlanPicture turned;
    cv::rotate(plan.rooms, turned.rooms, code);
    const Segmentation a = truth_of(turned), b = truth_of(plan);
    const auto matching = match(a, b);
    ASSERT_THAT(matching, test::IsOk());
    EXPECT_GT(judge(a, turned.rooms, b, plan.rooms, *matching).right, 0.95);
  }
}

TEST(Match, FindsTheRoomsOfSketchesDrawnTheWayPeopleDraw) {
  std::mt19937_64 random(3);
  double right = 0, found = 0;
  const int trials = 8;
  for (int trial = 0; trial < trials; ++trial) {
    const test::PlanPicture plan = test::office_plan(random);
    test::SketchHabits habits;
    habits.quarter_turns = trial % 4;
    habits.scale = uniform(random, 0.6, 1.6);
    habits.stretch = uniform(random, 0.8, 1.2);
    habits.tilt_rad = uniform(random, -0.08, 0.08);
    habits.rooms_left_out = trial % 3;
    const test::PlanSketch sketch = test::sketch_of(plan, habits, random);
    const Segmentation a = truth_of(sketch.picture), b = truth_of(plan);
    const auto matching = match(a, b);
    ASSERT_THAT(matching, test::IsOk());
    const Judged judged = judge(a, sketch.picture.rooms, b, plan.rooms, *matching);
    right += judged.right / trials, found += judged.found / trials;
  }
  EXPECT_GT(right, 0.8);
  EXPECT_GT(found, 0.8);
}

TEST(Match, TellsWhichOfTwoLikeEndsAfterOnePin) {
  // Three equal rooms in a row look the same from both ends: nothing but a person can tell.
  test::PlanPicture row;
  row.rooms = cv::Mat(80, 220, CV_16UC1, cv::Scalar(0));
  for (int i = 0; i < 3; ++i) row.rooms(cv::Rect(10 + 66 * i, 10, 60, 60)).setTo(i + 1);
  for (int i = 0; i < 2; ++i) row.rooms(cv::Rect(70 + 66 * i, 34, 6, 12)).setTo(i + 1);
  const Segmentation map = truth_of(row);
  const auto label_at = [&](int x) { return static_cast<int>(map.labels.at<unsigned short>(40, x)); };
  const auto blind = match(map, map);
  ASSERT_THAT(blind, test::IsOk());
  EXPECT_TRUE(blind->doubtful);
  EXPECT_FALSE(blind->runner_up.empty());
  ASSERT_TRUE(blind->next_pin_label_a.has_value());
  EXPECT_NE(*blind->next_pin_label_a, label_at(100));  // the middle one tells nothing
  const auto pinned = match(map, map, {{Point2(40, 40), Point2(172, 40)}});
  ASSERT_THAT(pinned, test::IsOk());
  EXPECT_TRUE(has_pair(pinned->pairs, label_at(40), label_at(172), Verdict::kProposed));
  EXPECT_TRUE(has_pair(pinned->pairs, label_at(172), label_at(40), Verdict::kProposed));
}

TEST(Match, KeepsWhatPeopleConfirmedAndRejected) {
  std::mt19937_64 random(5);
  const Segmentation map = truth_of(test::office_plan(random));
  const std::vector<RegionPair> verdicts = {{2, 4, 0, Verdict::kConfirmed}, {3, 3, 0, Verdict::kRejected}};
  const auto matching = match(map, map, {}, verdicts);
  ASSERT_THAT(matching, test::IsOk());
  EXPECT_TRUE(has_pair(matching->pairs, 2, 4, Verdict::kConfirmed));
  EXPECT_TRUE(has_pair(matching->pairs, 3, 3, Verdict::kRejected));
  EXPECT_FALSE(has_pair(matching->pairs, 3, 3, Verdict::kProposed));
  for (const RegionPair& pair : matching->pairs)
    if (pair.verdict == Verdict::kConfirmed) {
      EXPECT_EQ(pair.confidence, 1);
    }
}

TEST(Match, JoinsTheHalvesOfARoomThatOneMapSplits) {
  test::PlanPicture whole;
  whole.rooms = cv::Mat(120, 260, CV_16UC1, cv::Scalar(0));
  whole.rooms(cv::Rect(10, 10, 150, 90)).setTo(1);
  whole.rooms(cv::Rect(166, 20, 70, 50)).setTo(2);
  test::PlanPicture split;
  split.rooms = whole.rooms.clone();
  split.rooms(cv::Rect(95, 10, 65, 90)).setTo(3);
  const Segmentation a = truth_of(split), b = truth_of(whole);
  const auto matching = match(a, b);
  ASSERT_THAT(matching, test::IsOk());
  std::map<int, int> partner;
  for (const RegionPair& pair : matching->pairs) partner[pair.label_a] = pair.label_b;
  const auto label = [](const Segmentation& map, int x) {
    return static_cast<int>(map.labels.at<unsigned short>(40, x));
  };
  EXPECT_EQ(partner[label(a, 40)], label(b, 40));
  EXPECT_EQ(partner[label(a, 130)], label(b, 40));
  EXPECT_EQ(partner[label(a, 200)], label(b, 200));
}

TEST(Match, OrdersPairsWorstFirstWithConfidencesBetweenZeroAndOne) {
  std::mt19937_64 random(6);
  const test::PlanPicture plan = test::office_plan(random);
  const test::PlanSketch sketch = test::sketch_of(plan, {}, random);
  const auto matching = match(truth_of(sketch.picture), truth_of(plan));
  ASSERT_THAT(matching, test::IsOk());
  for (size_t i = 0; i < matching->pairs.size(); ++i) {
    EXPECT_GE(matching->pairs[i].confidence, 0);
    EXPECT_LE(matching->pairs[i].confidence, 1);
    if (i > 0) {
      EXPECT_GE(matching->pairs[i].confidence, matching->pairs[i - 1].confidence);
    }
  }
}

TEST(Match, GivesTheSameAnswerTwice) {
  std::mt19937_64 random(7);
  const test::PlanPicture plan = test::office_plan(random);
  const Segmentation a = truth_of(test::sketch_of(plan, {}, random).picture), b = truth_of(plan);
  const auto one = match(a, b), two = match(a, b);
  ASSERT_EQ(one->pairs.size(), two->pairs.size());
  for (size_t i = 0; i < one->pairs.size(); ++i) EXPECT_EQ(one->pairs[i].confidence, two->pairs[i].confidence);
}

TEST(Match, AnswersBadInputWithOneClearError) {
  std::mt19937_64 random(8);
  const Segmentation map = truth_of(test::office_plan(random));
  EXPECT_THAT(match(Segmentation(), map), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(match(map, Segmentation()), test::Fails(Errc::kDegenerate));
  EXPECT_THAT(match(map, map, {}, {{1, 99, 0, Verdict::kConfirmed}}), test::Fails(Errc::kConflict));
  MatchParams params;
  params.candidates = 0;
  EXPECT_THAT(match(map, map, {}, {}, params), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(match(map, map, {{Point2(-500, 1e6), Point2(3, 3)}}), test::IsOk());
}

TEST(Match, DoesNotMindTheScale) {
  std::mt19937_64 random(9);
  const test::PlanPicture plan = test::office_plan(random);
  const test::PlanSketch sketch = test::sketch_of(plan, {}, random);
  test::PlanPicture large;
  cv::resize(sketch.picture.rooms, large.rooms, cv::Size(), 2, 2, cv::INTER_NEAREST);
  const Segmentation a = truth_of(sketch.picture), a_large = truth_of(large), b = truth_of(plan);
  const auto small = match(a, b), scaled = match(a_large, b);
  ASSERT_THAT(scaled, test::IsOk());
  ASSERT_EQ(scaled->pairs.size(), small->pairs.size());
  EXPECT_EQ(judge(a_large, large.rooms, b, plan.rooms, *scaled).right,
            judge(a, sketch.picture.rooms, b, plan.rooms, *small).right);
}

TEST(Match, FindsADrawingSeenFromBelowOnlyWhenAPersonSaysSo) {
  std::mt19937_64 random(10);
  const test::PlanPicture plan = test::office_plan(random);
  test::SketchHabits habits;
  habits.mirrored = true, habits.quarter_turns = 1;
  const test::PlanSketch sketch = test::sketch_of(plan, habits, random);
  const Segmentation a = truth_of(sketch.picture), b = truth_of(plan);
  MatchParams params;
  EXPECT_GT(match(a, b, {}, {}, params)->turn_b_a.determinant(), 0);
  params.allow_mirror = true;
  const auto mirrored = match(a, b, {}, {}, params);
  EXPECT_LT(mirrored->turn_b_a.determinant(), 0);
  EXPECT_GT(judge(a, sketch.picture.rooms, b, plan.rooms, *mirrored).right, 0.95);
}

TEST(Match, SaysTheSameWhicheverWayTheSheetIsTurned) {
  std::mt19937_64 random(11);
  const test::PlanPicture plan = test::office_plan(random);
  const test::PlanSketch sketch = test::sketch_of(plan, {}, random);
  const Segmentation b = truth_of(plan), straight = truth_of(sketch.picture);
  const double wanted = judge(straight, sketch.picture.rooms, b, plan.rooms, *match(straight, b)).right;
  for (const int code : {cv::ROTATE_90_CLOCKWISE, cv::ROTATE_180}) {
    test::PlanPicture turned;
    cv::rotate(sketch.picture.rooms, turned.rooms, code);
    const Segmentation a = truth_of(turned);
    EXPECT_NEAR(judge(a, turned.rooms, b, plan.rooms, *match(a, b)).right, wanted, 0.12);  // one room of nine
  }
}

TEST(Match, FindsTheRestFromAPartOfTheBuilding) {
  std::mt19937_64 random(12);
  double right = 0;
  const int trials = 4;
  for (int trial = 0; trial < trials; ++trial) {
    const test::PlanPicture plan = test::office_plan(random);
    test::SketchHabits habits;
    habits.seen = 0.7;
    const test::PlanSketch part = test::sketch_of(plan, habits, random);
    const Segmentation a = truth_of(part.picture), b = truth_of(plan);
    right += judge(a, part.picture.rooms, b, plan.rooms, *match(a, b)).right / trials;
  }
  EXPECT_GT(right, 0.5);
}

TEST(Matcher, AnswersEveryTapAsMatchWould) {
  std::mt19937_64 random(13);
  const test::PlanPicture plan = test::office_plan(random);
  const Segmentation a = truth_of(test::sketch_of(plan, {}, random).picture), b = truth_of(plan);
  const auto matcher = Matcher::create(a, b);
  ASSERT_THAT(matcher, test::IsOk());
  std::vector<Pin> pins;
  for (int taps = 0; taps < 3; ++taps) {
    const auto fresh = match(a, b, pins), warm = matcher->solve(pins, {});
    ASSERT_EQ(warm->pairs.size(), fresh->pairs.size());
    for (size_t k = 0; k < warm->pairs.size(); ++k) {
      EXPECT_EQ(warm->pairs[k].label_a, fresh->pairs[k].label_a);
      EXPECT_EQ(warm->pairs[k].label_b, fresh->pairs[k].label_b);
      EXPECT_EQ(warm->pairs[k].confidence, fresh->pairs[k].confidence);
    }
    const auto region = static_cast<size_t>(taps + 1);
    pins.push_back({a.regions[region].anchor_px, b.regions[region].anchor_px});
  }
}

TEST(Matcher, NeverAsksForARoomThatIsTappedAlready) {
  std::mt19937_64 random(14);
  const Segmentation map = truth_of(test::hall_plan(random));
  const auto matcher = Matcher::create(map, map);
  std::vector<Pin> pins;
  std::set<int> asked;
  for (int taps = 0; taps < 4; ++taps) {
    const auto matching = matcher->solve(pins, {});
    if (!matching->next_pin_label_a) break;
    const int label = *matching->next_pin_label_a;
    EXPECT_TRUE(asked.insert(label).second);
    const Point2 p = map.regions[static_cast<size_t>(label - 1)].anchor_px;
    pins.push_back({p, p});
  }
  EXPECT_FALSE(asked.empty());
}

TEST(Matcher, RefusesWhatMatchRefuses) {
  std::mt19937_64 random(15);
  const Segmentation map = truth_of(test::office_plan(random));
  EXPECT_THAT(Matcher::create(Segmentation(), map), test::Fails(Errc::kDegenerate));
  MatchParams params;
  params.candidates = 0;
  EXPECT_THAT(Matcher::create(map, map, params), test::Fails(Errc::kInvalidArgument));
  const auto matcher = Matcher::create(map, map);
  EXPECT_THAT(matcher->solve({}, {{99, 1, 0, Verdict::kRejected}}), test::Fails(Errc::kConflict));
}

TEST(Match, TakesASingleRoom) {
  cv::Mat one(30, 40, CV_16UC1, cv::Scalar(0));
  one(cv::Rect(5, 5, 20, 12)).setTo(1);
  const auto map = segmentation_from_labels(one);
  const auto matching = match(*map, *map);
  ASSERT_THAT(matching, test::IsOk());
  EXPECT_EQ(matching->pairs.size(), 1u);
}

}  // namespace
}  // namespace smokemap
