#include "segmentation/furniture.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

/// Two rooms, a corridor, and chairs and tables in them.
cv::Mat furnished(std::uint64_t seed, int pieces, int side) {
  std::mt19937_64 random(seed);
  cv::Mat map(260, 400, CV_8UC1, cv::Scalar(0));
  map(cv::Rect(10, 10, 180, 180)).setTo(255);
  map(cv::Rect(200, 10, 180, 180)).setTo(255);
  map(cv::Rect(10, 200, 370, 40)).setTo(255);
  for (int i = 0; i < pieces; ++i) {
    const int x = static_cast<int>(uniform(random, 14, 150)), y = static_cast<int>(uniform(random, 14, 180));
    map(cv::Rect(x, y, side, side)).setTo(0);
  }
  return map;
}

TEST(StructureOf, PaintsChairsOverAndLeavesWalls) {
  const cv::Mat empty = furnished(1, 0, 0);
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Structure structure = structure_of(furnished(seed, 40, 4), 0.7);
    EXPECT_EQ(cv::countNonZero(structure.free_space != empty), 0) << seed;
  }
}

TEST(StructureOf, LeavesWhatIsAsLargeAsARoomIsWide) {
  cv::Mat map = furnished(1, 0, 0);
  map(cv::Rect(60, 60, 60, 60)).setTo(0);
  EXPECT_EQ(cv::countNonZero(structure_of(map, 0.7).free_space != map), 0);
}

TEST(StructureOf, MeasuresTheThicknessWithoutTheFurniture) {
  const double alone = structure_of(furnished(1, 0, 0), 0.7).thickness_px;
  EXPECT_NEAR(structure_of(furnished(3, 20, 3), 0.7).thickness_px, alone, 3);
}

TEST(StructureOf, NothingIsFurnitureAtARatioOfZero) {
  const cv::Mat map = furnished(2, 20, 4);
  EXPECT_EQ(cv::countNonZero(structure_of(map, 0).free_space != map), 0);
  EXPECT_EQ(structure_of(cv::Mat(5, 5, CV_8UC1, cv::Scalar(0)), 0.7).thickness_px, 0);
}

}  // namespace
}  // namespace smokemap
