#include "sketch/skeleton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <random>
#include <utility>

#include "core/random.hpp"

namespace smokemap {
namespace {

/// Thick lines and rings crossing each other anyhow, clear of the rim.
cv::Mat tangle(std::uint64_t seed) {
  auto random = random_stream(seed, 1);
  const auto place = [&] {
    return cv::Point(static_cast<int>(uniform(random, 10, 190)), static_cast<int>(uniform(random, 10, 140)));
  };
  cv::Mat mask = cv::Mat::zeros(150, 200, CV_8UC1);
  for (int i = 0; i < 7; ++i)
    cv::line(mask, place(), place(), cv::Scalar(255), static_cast<int>(uniform(random, 1, 7)));
  for (int i = 0; i < 2; ++i)
    cv::circle(mask, {static_cast<int>(uniform(random, 40, 160)), static_cast<int>(uniform(random, 40, 110))},
               static_cast<int>(uniform(random, 8, 30)), cv::Scalar(255), 3);
  return mask;
}

TEST(Skeleton, BranchesAreUnbrokenLinesOnTheInk) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const cv::Mat mask = tangle(seed);
    for (const SkeletonBranch& branch : trace_skeleton(mask, 0)) {
      ASSERT_GE(branch.points.size(), 2U);
      for (std::size_t i = 0; i < branch.points.size(); ++i) {
        EXPECT_EQ(mask.at<uchar>(branch.points[i]), 255);
        if (i == 0) continue;
        const cv::Point step = branch.points[i] - branch.points[i - 1];
        EXPECT_EQ(std::max(std::abs(step.x), std::abs(step.y)), 1) << seed;
      }
    }
  }
}

TEST(Skeleton, NoPixelIsWalkedTwiceAndFreeEndsEndInNothing) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto branches = trace_skeleton(tangle(seed), 0);
    std::map<std::pair<int, int>, int> within, ends;
    for (const SkeletonBranch& branch : branches) {
      for (std::size_t i = 1; i + 1 < branch.points.size(); ++i) ++within[{branch.points[i].x, branch.points[i].y}];
      ++ends[{branch.points.front().x, branch.points.front().y}];
      ++ends[{branch.points.back().x, branch.points.back().y}];
    }
    for (const auto& [pixel, times] : within) {
      EXPECT_EQ(times, 1) << seed;
      EXPECT_EQ(ends.count(pixel), 0U) << seed;
    }
    for (const SkeletonBranch& branch : branches) {
      const auto met = [&](const cv::Point& p) { return ends.at({p.x, p.y}); };
      EXPECT_EQ(branch.free_a, met(branch.points.front()) == 1) << seed;
      EXPECT_EQ(branch.free_b, met(branch.points.back()) == 1) << seed;
    }
  }
}

TEST(Skeleton, JoinsWhatTheInkJoinsAndNothingElse) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const cv::Mat mask = tangle(seed);
    cv::Mat walked = cv::Mat::zeros(mask.size(), CV_8UC1), labels;
    for (const SkeletonBranch& branch : trace_skeleton(mask, 0))
      for (const cv::Point& p : branch.points) walked.at<uchar>(p) = 255;
    EXPECT_EQ(cv::connectedComponents(walked, labels, 8), cv::connectedComponents(mask, labels, 8)) << seed;
    // Nothing that was drawn is far from its line: half the widest pen and the corners of crossings.
    cv::Mat away;
    cv::distanceTransform(walked == 0, away, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    double farthest = 0;
    cv::minMaxLoc(away, nullptr, &farthest, nullptr, nullptr, mask);
    EXPECT_LT(farthest, 14) << seed;
  }
}

TEST(Skeleton, LeavesHairsOutButNoLineThatStandsAlone) {
  cv::Mat mask = cv::Mat::zeros(120, 200, CV_8UC1);
  cv::line(mask, {20, 60}, {180, 60}, cv::Scalar(255), 1);
  cv::line(mask, {100, 60}, {100, 52}, cv::Scalar(255), 1);  // a slip of the pen
  cv::line(mask, {60, 60}, {60, 30}, cv::Scalar(255), 1);    // a wall
  cv::line(mask, {20, 100}, {27, 100}, cv::Scalar(255), 1);  // as short as the slip, but both its ends are free
  const auto reaches = [](const std::vector<SkeletonBranch>& branches, const cv::Point& p) {
    return std::any_of(branches.begin(), branches.end(), [&](const SkeletonBranch& b) {
      return std::any_of(b.points.begin(), b.points.end(), [&](const cv::Point& q) { return cv::norm(p - q) <= 2; });
    });
  };
  const auto all = trace_skeleton(mask, 0), clean = trace_skeleton(mask, 15);
  EXPECT_TRUE(reaches(all, {100, 53}));
  EXPECT_FALSE(reaches(clean, {100, 53}));
  EXPECT_TRUE(reaches(clean, {60, 32}));
  EXPECT_TRUE(reaches(clean, {24, 100}));
}

TEST(Skeleton, OfAnEmptyOrFullSheetOrOnePixelDoesNoHarm) {
  EXPECT_TRUE(trace_skeleton(cv::Mat::zeros(40, 40, CV_8UC1), 5).empty());
  EXPECT_TRUE(trace_skeleton(cv::Mat(1, 1, CV_8UC1, cv::Scalar(255)), 5).empty());
  const cv::Mat full(30, 40, CV_8UC1, cv::Scalar(255));
  for (const SkeletonBranch& branch : trace_skeleton(full, 5))
    for (const cv::Point& p : branch.points) EXPECT_TRUE(cv::Rect(0, 0, 40, 30).contains(p));
}

}  // namespace
}  // namespace smokemap
