#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/random.hpp"
#include "layout/edit.hpp"
#include "layout/layout_raster.hpp"

namespace smokemap {
namespace {

LayoutMap square() {
  LayoutMap map;
  map.width_px = 200, map.height_px = 200;
  for (const auto& p : {Point2(20, 20), Point2(180, 20), Point2(180, 180), Point2(20, 180)})
    map.corners.push_back({p, 2, 1});
  for (int i = 0; i < 4; ++i) map.walls.push_back({i, (i + 1) % 4, 4, 1, false});
  return map;
}

TEST(LayoutEdit, ANewWallUsesCornersNearItsEnds) {
  const auto map = add_wall(square(), {Point2(22, 21), Point2(178, 182)}, 5, 4);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(map->corners.size(), 4U);
  EXPECT_EQ(map->walls.size(), 5U);
  EXPECT_TRUE(map->walls.back().by_person);
  EXPECT_EQ(map->corners[0].degree, 3);
}

TEST(LayoutEdit, ANewWallSplitsTheWallItEndsOn) {
  const auto map = add_wall(square(), {Point2(100, 22), Point2(100, 178)}, 5, 4);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(map->corners.size(), 6U);
  EXPECT_EQ(map->walls.size(), 7U);
  double top = 0;
  for (std::size_t w = 0; w < map->walls.size(); ++w) {
    const auto s = map->wall_px(static_cast<int>(w));
    if (std::abs(s.a.y() - 20) < 1 && std::abs(s.b.y() - 20) < 1) top += s.length();
  }
  EXPECT_NEAR(top, 160, 1e-9) << "the split wall keeps its length";
}

TEST(LayoutEdit, AWallIntoTheOpenGetsCornersOfItsOwn) {
  const auto map = add_wall(square(), {Point2(60, 60), Point2(90, 120)}, 5, 4);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(map->corners.size(), 6U);
  EXPECT_EQ(map->corners.back().degree, 1);
}

TEST(LayoutEdit, RefusesWallsThatAreNone) {
  EXPECT_EQ(add_wall(square(), {Point2(20, 20), Point2(21, 21)}, 5, 4).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(add_wall(square(), {Point2(20, 20), Point2(180, 20)}, 5, 4).error().code, Errc::kConflict);
  EXPECT_EQ(add_wall(square(), {Point2(NAN, 20), Point2(180, 20)}, 5, 4).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(add_wall(square(), {Point2(20, 20), Point2(180, 180)}, 5, 0).error().code, Errc::kInvalidArgument);
}

TEST(LayoutEdit, RemovingAWallTakesCornersThatNothingMeets) {
  auto map = add_wall(square(), {Point2(60, 60), Point2(90, 120)}, 5, 4);
  ASSERT_TRUE(map.ok());
  const auto removed = remove_wall(*map, 4);
  ASSERT_TRUE(removed.ok());
  EXPECT_EQ(removed->corners.size(), 4U);
  EXPECT_EQ(remove_wall(*map, 5).error().code, Errc::kNotFound);
  EXPECT_EQ(remove_wall(*map, -1).error().code, Errc::kNotFound);
}

TEST(LayoutEdit, RandomEditsKeepTheGraphSound) {
  auto random = random_stream(11, 0);
  LayoutMap map = square();
  for (int step = 0; step < 300; ++step) {
    const auto point = [&] { return Point2(uniform(random, 0, 200), uniform(random, 0, 200)); };
    if (uniform01(random) < 0.6 || map.walls.empty()) {
      if (auto more = add_wall(map, {point(), point()}, 6, 3)) map = *more;
    } else {
      map = *remove_wall(map, static_cast<int>(uniform_index(random, map.walls.size())));
    }
    const auto degrees = with_degrees(map);
    for (std::size_t c = 0; c < map.corners.size(); ++c) {
      EXPECT_EQ(map.corners[c].degree, degrees.corners[c].degree);
      EXPECT_GT(map.corners[c].degree, 0);
    }
    for (const auto& w : map.walls) {
      ASSERT_LT(static_cast<std::size_t>(std::max(w.corner_a, w.corner_b)), map.corners.size());
      ASSERT_NE(w.corner_a, w.corner_b);
    }
  }
}

TEST(LayoutEdit, ScaleIsTheLengthOverTheSpan) {
  const auto map = set_scale(square(), Point2(20, 20), Point2(180, 20), 8);
  ASSERT_TRUE(map.ok());
  EXPECT_DOUBLE_EQ(map->scale->metres_per_pixel, 0.05);
  EXPECT_TRUE(map->scale->by_person);
  const auto shorter = set_scale(square(), Point2(20, 20), Point2(40, 20), 1);
  EXPECT_GT(shorter->scale->relative_sigma, map->scale->relative_sigma) << "a short measure is less sure";
  EXPECT_EQ(set_scale(square(), Point2(20, 20), Point2(20, 20), 8).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(set_scale(square(), Point2(20, 20), Point2(80, 20), -1).error().code, Errc::kInvalidArgument);
}

TEST(LayoutFreeSpace, IsInsideTheWallsOnly) {
  const auto free = layout_free_space(square());
  ASSERT_TRUE(free.ok());
  EXPECT_EQ(free->at<uchar>(100, 100), 255);
  EXPECT_EQ(free->at<uchar>(5, 5), 0) << "outside";
  EXPECT_EQ(free->at<uchar>(20, 100), 0) << "wall";
  EXPECT_NEAR(cv::countNonZero(*free), 156 * 156, 700);
}

TEST(LayoutFreeSpace, DoorsStayOpenAndWindowsShut) {
  LayoutMap map = square();
  map.walls.erase(map.walls.begin());  // the top, now with a gap between 80 and 120
  map.corners.push_back({Point2(80, 20), 1, 1});
  map.corners.push_back({Point2(120, 20), 1, 1});
  map.walls.push_back({0, 4, 4, 1, false});
  map.walls.push_back({5, 1, 4, 1, false});
  map.openings.push_back({{Point2(80, 20), Point2(120, 20)}, OpeningKind::kDoor, 1});
  const auto door = layout_free_space(map);
  ASSERT_TRUE(door.ok());
  EXPECT_EQ(door->at<uchar>(100, 100), 255) << "a shut door keeps the outside out";
  EXPECT_EQ(door->at<uchar>(5, 100), 0);
  map.openings[0].kind = OpeningKind::kWindow;
  EXPECT_EQ(layout_free_space(map)->at<uchar>(20, 100), 0);
}

TEST(LayoutFreeSpace, ScalesWithItsFactor) {
  const auto whole = layout_free_space(square()), half = layout_free_space(square(), 0.5);
  ASSERT_TRUE(whole.ok() && half.ok());
  EXPECT_EQ(half->cols, 100);
  EXPECT_NEAR(4.0 * cv::countNonZero(*half), cv::countNonZero(*whole), 0.05 * cv::countNonZero(*whole));
}

TEST(LayoutFreeSpace, RefusesSizesThatAreNone) {
  EXPECT_EQ(layout_free_space(LayoutMap{}).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(layout_free_space(square(), 0).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(layout_free_space(square(), 1e6).error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace smokemap
