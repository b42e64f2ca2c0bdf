#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "segmentation/constriction.hpp"
#include "segmentation/cut_selection.hpp"
#include "segmentation/maoris.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/segment.hpp"
#include "segmentation/straighten.hpp"
#include "segmentation/wall_rings.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// Overlapping boxes of free space, clear of the rim.
cv::Mat free_boxes(std::uint64_t seed) {
  auto random = random_stream(seed, 7);
  cv::Mat map(70, 90, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < 9; ++i) {
    const int width = static_cast<int>(uniform(random, 4, 30)), height = static_cast<int>(uniform(random, 4, 25));
    map(cv::Rect(static_cast<int>(uniform(random, 2, 88 - width)), static_cast<int>(uniform(random, 2, 68 - height)),
                 width, height))
        .setTo(255);
  }
  return map;
}

/// Free space parted among places anywhere: borders as ragged as they come.
cv::Mat parted(const cv::Mat& free_space, std::uint64_t seed) {
  auto random = random_stream(seed, 8);
  std::vector<cv::Point> places;
  for (int i = 0; i < 5; ++i)
    places.emplace_back(static_cast<int>(uniform_index(random, 90)), static_cast<int>(uniform_index(random, 70)));
  cv::Mat labels(free_space.size(), CV_32SC1, cv::Scalar(0));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      if (free_space.at<uchar>(y, x) != 255) continue;
      double nearest = 1e9;
      for (std::size_t i = 0; i < places.size(); ++i)
        if (const double away = cv::norm(places[i] - cv::Point(x, y)) + uniform(random, 0, 3); away < nearest)
          nearest = away, labels.at<int>(y, x) = static_cast<int>(i) + 1;
    }
  return connected_regions(labels);
}

TEST(StraightenBorders, LosesNoFreePixelAndMakesNoNewLabelHoweverRaggedTheBordersAre) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const cv::Mat map = free_boxes(seed), labels = parted(map, seed), straight = straighten_borders(labels, map);
    double before = 0, after = 0;
    cv::minMaxLoc(labels, nullptr, &before), cv::minMaxLoc(straight, nullptr, &after);
    EXPECT_EQ(cv::countNonZero((straight > 0) != (map == 255)), 0) << seed;
    EXPECT_LE(after, before) << seed;
    EXPECT_EQ(cv::countNonZero(straighten_borders(labels, map) != straight), 0) << seed;
  }
}

TEST(GrowLabels, GivesEachPixelALabelThatIsNoFartherThanAnyOther) {
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    const cv::Mat map = free_boxes(seed);
    auto random = random_stream(seed, 9);
    cv::Mat labels(map.size(), CV_32SC1, cv::Scalar(0));
    for (int i = 1; i <= 4; ++i) {
      const cv::Point p(static_cast<int>(uniform_index(random, 90)), static_cast<int>(uniform_index(random, 70)));
      if (map.at<uchar>(p) == 255) labels.at<int>(p) = i;
    }
    // Steps to each label through free space, by relaxing until nothing changes.
    std::vector<cv::Mat> steps;
    for (int i = 0; i < 5; ++i) {
      cv::Mat way(map.size(), CV_32SC1, cv::Scalar(100000));
      way.setTo(0, labels == i + 1);
      for (bool changed = true; changed;) {
        changed = false;
        for (int y = 1; y + 1 < map.rows; ++y)
          for (int x = 1; x + 1 < map.cols; ++x) {
            if (map.at<uchar>(y, x) != 255) continue;
            const int best = 1 + std::min({way.at<int>(y - 1, x), way.at<int>(y + 1, x), way.at<int>(y, x - 1),
                                           way.at<int>(y, x + 1)});
            if (best < way.at<int>(y, x)) way.at<int>(y, x) = best, changed = true;
          }
      }
      steps.push_back(way);
    }
    grow_labels(map, labels);
    for (int y = 0; y < map.rows; ++y)
      for (int x = 0; x < map.cols; ++x) {
        int least = 100000;
        for (const cv::Mat& way : steps) least = std::min(least, way.at<int>(y, x));
        const int label = labels.at<int>(y, x);
        const bool reached = map.at<uchar>(y, x) == 255 && least < 100000;
        ASSERT_EQ(label != 0, reached) << seed;
        if (reached) {
          EXPECT_EQ(steps[static_cast<std::size_t>(label - 1)].at<int>(y, x), least) << seed;
        }
      }
  }
}

TEST(DrawCut, PartsTheTwoSidesOfAnyLine) {
  auto random = random_stream(40, 0);
  for (int trial = 0; trial < 60; ++trial) {
    cv::Mat map(60, 60, CV_8UC1, cv::Scalar(0));
    map(cv::Rect(5, 5, 50, 50)).setTo(255);
    Cut cut;
    cut.a = {5, static_cast<int>(uniform(random, 10, 50))}, cut.b = {54, static_cast<int>(uniform(random, 10, 50))};
    if (trial % 2 == 1) std::swap(cut.a, cut.b);
    if (trial % 3 == 0) cut.a = {cut.a.y, cut.a.x}, cut.b = {cut.b.y, cut.b.x};
    draw_cut(cut, map);
    cv::Mat pieces;
    EXPECT_EQ(cv::connectedComponents(map, pieces, 4) - 1, 2) << cut.a << cut.b;
    EXPECT_LE(50 * 50 - cv::countNonZero(map), 2 * 50) << "a cut is thin";
  }
}

TEST(TraceWallRings, StayWithinTheirToleranceOfTheBoundary) {
  for (std::uint64_t seed = 50; seed < 56; ++seed) {
    const cv::Mat map = free_boxes(seed);
    std::vector<std::vector<cv::Point>> boundaries;
    cv::findContours(map, boundaries, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
    cv::Mat lines = cv::Mat::zeros(map.size(), CV_8UC1), away;
    for (const WallRing& ring : trace_wall_rings(map, 2)) {
      double along = 0;
      for (std::size_t i = 0; i < ring.corners.size(); ++i) {
        const WallCorner &corner = ring.corners[i], &next = ring.corners[(i + 1) % ring.corners.size()];
        EXPECT_EQ(map.at<uchar>(corner.p), 255);
        EXPECT_NEAR(corner.along_px, along, 1e-9);
        along += cv::norm(next.p - corner.p);
        cv::line(lines, corner.p, next.p, cv::Scalar(255));
      }
      EXPECT_NEAR(ring.length_px, along, 1e-9);
    }
    cv::distanceTransform(lines == 0, away, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    for (const auto& boundary : boundaries)
      for (const cv::Point& p : boundary) EXPECT_LE(away.at<float>(p), 3.1F) << seed;  // 2, and the raster of the lines
  }
}

template <class Params>
void expect_refused(const std::vector<std::function<void(Params&)>>& wrongs) {
  EXPECT_THAT(Params{}.validate(), test::IsOk());
  for (std::size_t i = 0; i < wrongs.size(); ++i) {
    Params params;
    wrongs[i](params);
    EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument)) << i;
  }
}

TEST(SegmentationMethods, RefuseParametersOutOfRangeOrNoNumber) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  expect_refused<ConstrictionParams>({[](auto& p) { p.pinch_ratio = 1; }, [](auto& p) { p.step_ratio = kNone; },
                                      [](auto& p) { p.niche_depth = -1; }, [](auto& p) { p.open_ratio = 0; },
                                      [](auto& p) { p.clutter_ratio = 11; }});
  expect_refused<MaorisParams>({[](auto& p) { p.threshold = 1.1; }, [](auto& p) { p.margin = kNone; },
                                [](auto& p) { p.least_zone_px = -1; }, [](auto& p) { p.least_room_px = 2000000; }});
  expect_refused<SegmentationParams>({[](auto& p) { p.door_ratio = 1; }, [](auto& p) { p.with_doors.mouth_ratio = 3; },
                                      [](auto& p) { p.without_doors.min_room_ratio = kNone; },
                                      [](auto& p) { p.longest_cut_ratio = 0; }});
  EXPECT_THAT(matching_segmentation_params().validate(), test::IsOk());
  for (const MapKind kind : {MapKind::kSketch, MapKind::kRobot, MapKind::kLayout})
    EXPECT_THAT(maoris_params(kind).validate(), test::IsOk());
}

}  // namespace
}  // namespace smokemap
