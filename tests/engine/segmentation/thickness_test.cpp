#include "segmentation/thickness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

cv::Mat random_rooms(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  cv::Mat map(50, 60, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < 6; ++i) {
    const int x = static_cast<int>(uniform(random, 0, 45)), y = static_cast<int>(uniform(random, 0, 35));
    map(cv::Rect(x, y, static_cast<int>(uniform(random, 3, 15)), static_cast<int>(uniform(random, 3, 15)))).setTo(255);
  }
  return map;
}

/// The definition, disc by disc.
cv::Mat slow_thickness(const cv::Mat& clearance) {
  cv::Mat slow = clearance.clone();
  for (int y = 0; y < clearance.rows; ++y)
    for (int x = 0; x < clearance.cols; ++x)
      for (int v = 0; v < clearance.rows; ++v)
        for (int u = 0; u < clearance.cols; ++u)
          if (clearance.at<float>(y, x) > 0 && std::hypot(u - x, v - y) < clearance.at<float>(v, u))
            slow.at<float>(y, x) = std::max(slow.at<float>(y, x), clearance.at<float>(v, u));
  return slow;
}

TEST(ClearanceImage, IsTheDistanceToTheNearestWallOrEdge) {
  const cv::Mat map = random_rooms(1);
  const cv::Mat fast = clearance_image(map);
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x) {
      double nearest = std::min({x + 1, y + 1, map.cols - x, map.rows - y});
      for (int v = 0; v < map.rows; ++v)
        for (int u = 0; u < map.cols; ++u)
          if (map.at<unsigned char>(v, u) == 0) nearest = std::min(nearest, std::hypot(u - x, v - y));
      EXPECT_NEAR(fast.at<float>(y, x), nearest, 1e-3);
    }
}

TEST(LocalThickness, AgreesWithItsDefinition) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const cv::Mat clearance = clearance_image(random_rooms(seed));
    const cv::Mat fast = local_thickness(clearance), slow = slow_thickness(clearance);
    double worst = 0, sum = 0, count = 0;
    for (int y = 0; y < fast.rows; ++y)
      for (int x = 0; x < fast.cols; ++x) {
        EXPECT_EQ(fast.at<float>(y, x) > 0, slow.at<float>(y, x) > 0);
        const double miss = std::abs(fast.at<float>(y, x) - slow.at<float>(y, x));
        worst = std::max(worst, miss), sum += miss, count += fast.at<float>(y, x) > 0;
      }
    EXPECT_LT(sum / count, 0.35);  // discs are painted half a pixel larger
    EXPECT_LT(worst, 5);
  }
}

TEST(LocalThickness, IsHalfTheWidthAllAlongACorridor) {
  cv::Mat map(41, 200, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 180, 21)).setTo(255);
  const cv::Mat thickness = local_thickness(clearance_image(map));
  for (int x = 30; x < 170; ++x)
    for (int y = 10; y < 31; ++y) EXPECT_NEAR(thickness.at<float>(y, x), 11, 0.5);
}

/// One hall whose walls are rough, as robots see them: its ridge has thousands of pixels.
cv::Mat rough_hall(int side_px) {
  std::mt19937_64 random(5);
  cv::Mat map(side_px, side_px, CV_8UC1, cv::Scalar(255));
  const auto deep = [&] { return 1 + static_cast<int>(uniform_index(random, 12)); };
  for (int i = 0; i < side_px; ++i) {
    map(cv::Range(0, deep()), cv::Range(i, i + 1)).setTo(0);
    map(cv::Range(side_px - deep(), side_px), cv::Range(i, i + 1)).setTo(0);
    map(cv::Range(i, i + 1), cv::Range(0, deep())).setTo(0);
    map(cv::Range(i, i + 1), cv::Range(side_px - deep(), side_px)).setTo(0);
  }
  return map;
}

TEST(LocalThickness, DoesNotPaintALargeHallOverAndOver) {
  const cv::Mat hall = rough_hall(1200);
  const auto cpu_of = [](const auto& work) {
    std::clock_t least = 1000 * CLOCKS_PER_SEC;
    for (int trial = 0; trial < 3; ++trial) {
      const std::clock_t begin = std::clock();
      work();
      least = std::min(least, std::clock() - begin);
    }
    return static_cast<double>(least);
  };
  cv::Mat clearance;
  const double of_distances = cpu_of([&] { clearance = clearance_image(hall); });
  EXPECT_LT(cpu_of([&] { local_thickness(clearance); }), 9 * of_distances);  // 3 times; painting every disc whole, 17
}

TEST(FuzzyOpening, IsTheLargestDiscOverEachPixel) {
  for (std::uint64_t seed = 10; seed < 13; ++seed) {
    const cv::Mat clearance = clearance_image(random_rooms(seed)), fast = fuzzy_opening(clearance);
    for (int y = 0; y < fast.rows; ++y)
      for (int x = 0; x < fast.cols; ++x) {
        float best = 0;
        for (int v = 0; v < fast.rows; ++v)
          for (int u = 0; u < fast.cols; ++u) {
            const float radius = std::floor(clearance.at<float>(v, u));
            if (radius >= 1 && std::hypot(u - x, v - y) <= radius - 1) best = std::max(best, radius);
          }
        ASSERT_EQ(fast.at<float>(y, x), best) << x << ' ' << y;
      }
  }
}

TEST(TypicalThickness, IsThatOfTheNarrowPartAndNotOfTheHall) {
  cv::Mat map(300, 300, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 280, 21)).setTo(255);
  map(cv::Rect(10, 40, 280, 21)).setTo(255);
  const double narrow = typical_thickness(local_thickness(clearance_image(map)));
  map(cv::Rect(100, 100, 150, 150)).setTo(255);
  EXPECT_NEAR(narrow, 11, 0.5);
  EXPECT_NEAR(typical_thickness(local_thickness(clearance_image(map))), narrow, 0.5);
  EXPECT_EQ(typical_thickness(cv::Mat(4, 4, CV_32FC1, cv::Scalar(0))), 0);
}

TEST(WithoutIslands, PaintsOverSmallThingsAndLeavesWalls) {
  cv::Mat map(60, 60, CV_8UC1, cv::Scalar(255));
  map(cv::Rect(20, 20, 4, 4)).setTo(0);
  map(cv::Rect(30, 10, 2, 40)).setTo(0);
  map(cv::Rect(0, 30, 4, 4)).setTo(0);  // touches the edge: part of the building
  const cv::Mat cleared = without_islands(map, 6);
  EXPECT_EQ(cleared.at<unsigned char>(21, 21), 255);
  EXPECT_EQ(cleared.at<unsigned char>(31, 30), 0);
  EXPECT_EQ(cleared.at<unsigned char>(31, 1), 0);
}

}  // namespace
}  // namespace smokemap
