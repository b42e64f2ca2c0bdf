#include "layout/rooms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/random.hpp"
#include "layout/edit.hpp"

namespace smokemap {
namespace {

/// Walls of a grid of rooms, cut at every crossing; `missing` walls are left out.
LayoutMap grid_of_rooms(int columns, int rows, double room_px, const std::vector<int>& missing = {}) {
  LayoutMap map;
  const auto corner = [&](int x, int y) { return y * (columns + 1) + x; };
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) {
      LayoutCorner c;
      c.p_px = room_px * Point2(x, y);
      map.corners.push_back(c);
    }
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) {
      if (x < columns) map.walls.push_back({corner(x, y), corner(x + 1, y), 6, 1, false});
      if (y < rows) map.walls.push_back({corner(x, y), corner(x, y + 1), 6, 1, false});
    }
  for (auto it = missing.rbegin(); it != missing.rend(); ++it) map.walls.erase(map.walls.begin() + *it);
  return with_degrees(map);
}

double area_of(const Polygon& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
    sum += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return std::abs(sum);
}

TEST(Rooms, AreTheSpacesThatWallsClose) {
  for (const double room_px : {40.0, 200.0, 900.0}) {  // the same for every size of picture
    const auto rooms = find_rooms(grid_of_rooms(4, 3, room_px));
    ASSERT_EQ(rooms.size(), 12U) << room_px;
    for (const auto& room : rooms) EXPECT_NEAR(area_of(room) / (room_px * room_px), 1, 0.05);
  }
}

TEST(Rooms, WithoutAWallBetweenThemAreOne) {
  // In a grid of 2 x 1 wall 3 stands between the rooms.
  const auto rooms = find_rooms(grid_of_rooms(2, 1, 200, {3}));
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_NEAR(area_of(rooms[0]), 2 * 200 * 200, 0.05 * 2 * 200 * 200);
}

// Regression: pillars and shafts were rooms.
TEST(Rooms, WhatIsMuchSmallerThanADoorIsNone) {
  for (const double door : {60.0, 100.0}) {
    LayoutMap map = grid_of_rooms(3, 3, 300);
    const int first = static_cast<int>(map.corners.size());
    for (const Point2& p : {Point2(40, 40), Point2(90, 40), Point2(90, 90), Point2(40, 90)}) {
      LayoutCorner c;
      c.p_px = p;
      map.corners.push_back(c);
    }
    for (int i = 0; i < 4; ++i) map.walls.push_back({first + i, first + (i + 1) % 4, 6, 1, false});
    for (int i = 0; i < 3; ++i)
      map.openings.push_back({{{100 + 300.0 * i, 300}, {100 + 300.0 * i + door, 300}}, OpeningKind::kDoor, 1});
    const std::size_t pillar = 50 * 50 > 0.5 * door * door ? 1 : 0;
    EXPECT_EQ(find_rooms(with_degrees(map)).size(), 9U + pillar) << door;
    map.openings.resize(2);
    EXPECT_EQ(find_rooms(with_degrees(map)).size(), 10U) << "two doors do not tell how wide doors are";
  }
}

TEST(Rooms, OpeningsCloseThem) {
  LayoutMap map = grid_of_rooms(2, 1, 200, {3});
  map.openings.push_back({{{200, 0}, {200, 200}}, OpeningKind::kDoor, 1});
  EXPECT_EQ(find_rooms(map).size(), 2U);
}

TEST(Rooms, ComeLargeFirst) {
  LayoutMap map = grid_of_rooms(3, 1, 200, {5});
  const auto rooms = find_rooms(map);
  ASSERT_EQ(rooms.size(), 2U);
  EXPECT_GT(area_of(rooms[0]), 1.5 * area_of(rooms[1]));
}

TEST(Rooms, OpenToTheOutsideAreNone) {
  EXPECT_TRUE(find_rooms(grid_of_rooms(1, 1, 200, {0})).empty());
  EXPECT_TRUE(find_rooms(LayoutMap{}).empty());
}

TEST(Rooms, SlipsAndShaftsDoNotCount) {
  LayoutMap map = grid_of_rooms(2, 2, 500);
  // A double wall: two walls 4 px apart make no room between them.
  const int first = static_cast<int>(map.corners.size());
  for (const Point2& p : {Point2(4, 0), Point2(4, 500)}) {
    LayoutCorner c;
    c.p_px = p;
    map.corners.push_back(c);
  }
  map.walls.push_back({first, first + 1, 3, 1, false});
  EXPECT_EQ(find_rooms(with_degrees(map)).size(), 4U);
}

TEST(Rooms, DoNotDependOnTheOrderOfWalls) {
  const LayoutMap map = grid_of_rooms(3, 3, 150);
  auto random = random_stream(8, 0);
  for (int trial = 0; trial < 3; ++trial) {
    LayoutMap shuffled = map;
    for (std::size_t i = shuffled.walls.size(); i > 1; --i)
      std::swap(shuffled.walls[i - 1], shuffled.walls[uniform_index(random, i)]);
    EXPECT_EQ(find_rooms(shuffled).size(), find_rooms(map).size());
  }
}

}  // namespace
}  // namespace smokemap
