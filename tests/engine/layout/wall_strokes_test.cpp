#include "layout/wall_strokes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/random.hpp"
#include "layout/openings.hpp"
#include "layout/rooms.hpp"
#include "layout/wall_graph.hpp"

namespace smokemap {
namespace {

InkStroke stroke(double x1, double y1, double x2, double y2, double thickness) {
  InkStroke s;
  s.axis = {Point2(x1, y1), Point2(x2, y2)};
  s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
  return s;
}

TEST(TraceStrokes, MeasuresOneObliqueLineToSubPixels) {
  auto random = random_stream(5, 0);
  for (int trial = 0; trial < 12; ++trial) {
    const double angle = uniform(random, 0, kPi), width = 2 + static_cast<double>(uniform_index(random, 14));
    const Point2 middle(400, 400), half = 250 * Point2(std::cos(angle), std::sin(angle));
    cv::Mat dark = cv::Mat::zeros(800, 800, CV_8UC1);
    const auto fixed = [](const Point2& p) {
      return cv::Point(static_cast<int>(std::lround(p.x() * 16)), static_cast<int>(std::lround(p.y() * 16)));
    };
    cv::line(dark, fixed(middle - half), fixed(middle + half), cv::Scalar(255), static_cast<int>(width), cv::LINE_8, 4);
    cv::GaussianBlur(dark, dark, {5, 5}, 0.9);
    const auto strokes = trace_strokes(dark, LayoutParams{});
    ASSERT_FALSE(strokes.empty()) << "angle " << angle << " width " << width;
    const auto& s = strokes.front();
    EXPECT_LT(line_angle_between(s.axis.heading(), angle), radians(1));
    EXPECT_LT(std::abs(signed_line_distance(s.axis, middle)), 1.2);
    EXPECT_NEAR(s.thickness_px, width, 0.35 * width + 1) << "angle " << angle;
    EXPECT_NEAR(s.length(), 500, width + 12);
  }
}

TEST(PairHollow, MakesOneWallOfTwoLines) {
  const auto pairs = pair_hollow({stroke(0, 0, 200, 0, 1.5), stroke(10, 9, 190, 9, 1.5)}, 30);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_NEAR(pairs[0].axis.a.y(), 4.5, 1e-9);
  EXPECT_NEAR(pairs[0].length(), 180, 1e-9);
  EXPECT_NEAR(pairs[0].thickness_px, 10.5, 1e-9);
}

TEST(PairHollow, LeavesStairsAlone) {
  std::vector<InkStroke> treads;
  for (int i = 0; i < 9; ++i) treads.push_back(stroke(0, 10 * i, 100, 10 * i, 1.5));
  EXPECT_TRUE(pair_hollow(treads, 30).empty());
}

TEST(PairHollow, LeavesLinesApartThatCrossOrAreFar) {
  EXPECT_TRUE(pair_hollow({stroke(0, 0, 200, 0, 1.5), stroke(0, 80, 200, 80, 1.5)}, 30).empty());
  EXPECT_TRUE(pair_hollow({stroke(0, 0, 200, 0, 1.5), stroke(100, -50, 100, 50, 1.5)}, 30).empty());
}

TEST(MergeCollinear, JoinsPiecesOfOneLineOnly) {
  const auto merged =
      merge_collinear({stroke(0, 0, 50, 0, 4), stroke(51, 0.5, 120, 0.5, 4), stroke(0, 20, 100, 20, 4)}, 3, 2);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_NEAR(std::max(merged[0].length(), merged[1].length()), 120, 1.0);
}

TEST(SelectWalls, LeavesThinLinesOut) {
  std::vector<InkStroke> strokes{stroke(100, 100, 900, 100, 10), stroke(100, 700, 900, 700, 10),
                                 stroke(100, 100, 100, 700, 10), stroke(900, 100, 900, 700, 10),
                                 stroke(500, 100, 500, 700, 5),  stroke(100, 400, 500, 400, 5),
                                 stroke(500, 300, 900, 300, 5)};
  for (int i = 0; i < 10; ++i) strokes.push_back(stroke(120, 120 + 10 * i, 220, 120 + 10 * i, 1.2));
  const auto chosen = select_walls(strokes, {1000, 800}, LayoutParams{});
  EXPECT_EQ(chosen.walls.size(), 7U);
  EXPECT_FALSE(chosen.hollow);
  EXPECT_GT(chosen.thin_limit_px, 1.2);
  EXPECT_LT(chosen.thin_limit_px, 5);
}

/// Rooms in a row with walls 7 px thick and leaves of 2.4 px, in an outer wall of 15 px that its windows part.
std::vector<InkStroke> office_with_windows() {
  std::vector<InkStroke> strokes;
  for (const double y : {100.0, 700.0})
    for (double x = 100; x < 1300; x += 200) strokes.push_back(stroke(x, y, x + 120, y, 15));
  for (const double x : {100.0, 1300.0})
    for (double y = 100; y < 700; y += 200) strokes.push_back(stroke(x, y, x, y + 120, 15));
  for (const double y : {340.0, 460.0}) {
    for (double x = 140; x < 1300; x += 200) strokes.push_back(stroke(x, y, std::min(x + 160, 1270.0), y, 7));
    for (double x = 300; x < 1300; x += 200) {
      strokes.push_back(stroke(x, y < 400 ? 140 : 460, x, y < 400 ? 340 : 660, 7));
      strokes.push_back(stroke(x - 4, y, x - 4, y + (y < 400 ? -38 : 38), 2.4));  // a leaf
    }
  }
  return strokes;
}

// Regression: where partitions are more than the outer walls, door leaves were thick enough to be walls.
TEST(SelectWalls, MeasuresThinLinesByTheOuterWallsWhateverTheirNumber) {
  const auto chosen = select_walls(office_with_windows(), {1500, 900}, LayoutParams{});
  EXPECT_GT(chosen.thin_limit_px, 2.4);
  EXPECT_LT(chosen.thin_limit_px, 7);
  for (const auto& wall : chosen.walls) EXPECT_GE(wall.thickness_px, 7);
}

// Regression: the frame of the sheet hung together best, and its thickness was taken for that of the walls.
TEST(SelectWalls, MeasuresThicknessWithinTheDrawingNotOnItsFrame) {
  auto strokes = office_with_windows();
  for (const double inset : {0.0, 8.0}) {
    strokes.push_back(stroke(10 + inset, 10 + inset, 1490 - inset, 10 + inset, 2));
    strokes.push_back(stroke(10 + inset, 890 - inset, 1490 - inset, 890 - inset, 2));
    strokes.push_back(stroke(10 + inset, 10 + inset, 10 + inset, 890 - inset, 2));
    strokes.push_back(stroke(1490 - inset, 10 + inset, 1490 - inset, 890 - inset, 2));
  }
  const auto chosen = select_walls(strokes, {1500, 900}, LayoutParams{});
  EXPECT_FALSE(chosen.hollow);
  EXPECT_GT(chosen.thin_limit_px, 2.4);
  EXPECT_GE(chosen.walls.size(), 30U);
}

/// A house of 3 x 2 rooms of 400.
std::vector<InkStroke> house(double thickness) {
  std::vector<InkStroke> walls;
  for (int i = 0; i <= 3; ++i) walls.push_back(stroke(100 + 400 * i, 100, 100 + 400 * i, 900, thickness));
  for (int i = 0; i <= 2; ++i) walls.push_back(stroke(100, 100 + 400 * i, 1300, 100 + 400 * i, thickness));
  return walls;
}

bool has_wall(const WallStrokes& chosen, const Segment2& line) {
  return std::any_of(chosen.walls.begin(), chosen.walls.end(), [&](const InkStroke& s) {
    return distance(s.axis, line.midpoint()) < 3 && line_angle_between(s.axis.heading(), line.heading()) < radians(5);
  });
}

// Regression: the fronts of cupboards, a third as thick as all walls, parted off rooms.
TEST(SelectWalls, AFewLinesMuchThinnerThanAllOthersAreFronts) {
  auto strokes = house(14);
  strokes.push_back(stroke(107, 160, 493, 160, 4.3));
  const auto chosen = select_walls(strokes, {1400, 1000}, LayoutParams{});
  EXPECT_FALSE(has_wall(chosen, strokes.back().axis));
  EXPECT_TRUE(has_wall(chosen, strokes.front().axis));
  const auto front = std::find_if(chosen.thin.begin(), chosen.thin.end(),
                                  [&](const InkStroke& s) { return distance(s.axis, Point2(300, 160)) < 1; });
  EXPECT_NE(front, chosen.thin.end()) << "it may still be a window or the leaf of a door";
}

// Regression: the hobs of a stove were walls, from which openings led to the real ones.
TEST(SelectWalls, DiscsAreNoWallsAndAnglesAre) {
  auto strokes = house(14);
  for (const double x : {230.0, 280.0}) {
    strokes.push_back(stroke(x - 18, 300, x + 18, 304, 15));
    strokes.push_back(stroke(x - 14, 318, x + 14, 286, 15));
  }
  const Segment2 one{Point2(560, 300), Point2(630, 300)}, two{Point2(630, 300), Point2(630, 360)};
  strokes.push_back(stroke(560, 300, 630, 300, 14));
  strokes.push_back(stroke(630, 300, 630, 360, 14));
  const auto chosen = select_walls(strokes, {1400, 1000}, LayoutParams{});
  EXPECT_FALSE(has_wall(chosen, {Point2(212, 300), Point2(248, 304)}));
  EXPECT_TRUE(has_wall(chosen, one) && has_wall(chosen, two)) << "a stub around a corner of a hall";
}

// Regression: a wall's stroke ran on along the rough parapet of the window beside it, covered little and was dropped.
TEST(TraceStrokes, AWallEndsWhereAThinnerPieceCarriesItOn) {
  auto random = random_stream(6, 0);
  for (int trial = 0; trial < 6; ++trial) {
    const int wall = 24 + static_cast<int>(uniform_index(random, 8)), end = 230 + 10 * trial;
    cv::Mat dark = cv::Mat::zeros(700, 1600, CV_8UC1);
    cv::rectangle(dark, {300, 100, wall, end - 100}, cv::Scalar(230), cv::FILLED);
    const int low = 300 + wall / 4, thin = wall / 2 - 5;
    cv::rectangle(dark, {low, end, thin, 300}, cv::Scalar(230), cv::FILLED);
    for (int y = end + 8; y < end + 300; y += 9)  // in places half as thick as the wall
      cv::circle(dark, {low + thin, y}, static_cast<int>(2 + uniform_index(random, 3)), {230}, cv::FILLED);
    const auto strokes = trace_strokes(dark, LayoutParams{});
    const auto own = std::find_if(strokes.begin(), strokes.end(), [&](const InkStroke& s) {
      return s.thickness_px > 0.8 * wall && std::abs(std::sin(s.axis.heading())) > 0.95;
    });
    ASSERT_NE(own, strokes.end()) << "wall of " << wall << " px, " << end - 100 << " long";
    EXPECT_GT(own->coverage, 0.6);
    EXPECT_NEAR(std::max(own->axis.a.y(), own->axis.b.y()), end, 12);
  }
}

TEST(SelectWalls, HasNothingToSayAboutNothing) {
  EXPECT_TRUE(select_walls({}, {1000, 800}, LayoutParams{}).walls.empty());
}

TEST(WallGraph, EndsMeetTheCentreLinesOfWhatTheyReach) {
  // a partition that ends at the faces of two outer walls, as ink does
  const auto map = build_wall_graph({stroke(0, 0, 200, 0, 12), stroke(0, 100, 200, 100, 12), stroke(80, 6, 80, 94, 6)},
                                    12, LayoutParams{});
  EXPECT_EQ(map.walls.size(), 5U);
  int tees = 0;
  for (const auto& c : map.corners) tees += c.degree == 3;
  EXPECT_EQ(tees, 2);
}

TEST(WallGraph, CornersOfARectangleCloseWhateverTheOrder) {
  std::vector<InkStroke> strokes{stroke(6, 0, 194, 0, 12), stroke(200, 6, 200, 94, 12), stroke(194, 100, 6, 100, 12),
                                 stroke(0, 94, 0, 6, 12)};
  std::mt19937_64 random(3);
  for (int round = 0; round < 6; ++round) {
    std::shuffle(strokes.begin(), strokes.end(), random);
    const auto map = build_wall_graph(strokes, 12, LayoutParams{});
    ASSERT_EQ(map.corners.size(), 4U);
    for (const auto& c : map.corners) EXPECT_EQ(c.degree, 2);
  }
}

TEST(WallGraph, CrossingWallsCutEachOther) {
  const auto map = build_wall_graph({stroke(0, 50, 100, 50, 4), stroke(50, 0, 50, 100, 4)}, 4, LayoutParams{});
  EXPECT_EQ(map.walls.size(), 4U);
  EXPECT_EQ(map.corners.size(), 5U);
}

LayoutMap wall_with_gap(double from, double to) {
  return build_wall_graph({stroke(0, 0, from, 0, 8), stroke(to, 0, 600, 0, 8), stroke(0, 0, 0, 300, 8),
                           stroke(600, 0, 600, 300, 8), stroke(0, 300, 600, 300, 8)},
                          8, LayoutParams{});
}

TEST(Openings, AGapBetweenFacingEndsIsAnOpening) {
  const cv::Mat nothing = cv::Mat::zeros(400, 700, CV_8UC1);
  auto map = wall_with_gap(280, 320);
  close_gaps(map, {}, nothing, 8, LayoutParams{});
  ASSERT_EQ(map.openings.size(), 1U);
  EXPECT_EQ(map.openings[0].kind, OpeningKind::kPassage);
  EXPECT_EQ(find_rooms(map).size(), 1U);
}

TEST(Openings, ALeafMakesADoorAndALineAlongMakesAWindow) {
  const cv::Mat nothing = cv::Mat::zeros(400, 700, CV_8UC1);
  auto door = wall_with_gap(280, 320);
  close_gaps(door, {stroke(280, 0, 280, 40, 1)}, nothing, 8, LayoutParams{});
  ASSERT_EQ(door.openings.size(), 1U);
  EXPECT_EQ(door.openings[0].kind, OpeningKind::kDoor);
  auto window = wall_with_gap(280, 320);
  close_gaps(window, {stroke(278, 2, 322, 2, 1)}, nothing, 8, LayoutParams{});
  ASSERT_EQ(window.openings.size(), 1U);
  EXPECT_EQ(window.openings[0].kind, OpeningKind::kWindow);
}

TEST(Openings, WhatASignHidesIsADoubtfulWall) {
  cv::Mat covered = cv::Mat::zeros(400, 700, CV_8UC1);
  covered(cv::Rect(275, 0, 50, 20)).setTo(255);
  auto map = wall_with_gap(280, 320);
  const auto before = map.walls.size();
  close_gaps(map, {}, covered, 8, LayoutParams{});
  EXPECT_TRUE(map.openings.empty());
  ASSERT_EQ(map.walls.size(), before + 1);
  EXPECT_LT(map.walls.back().confidence, 0.6);
}

TEST(Openings, AWideGapStaysAGap) {
  const cv::Mat nothing = cv::Mat::zeros(400, 700, CV_8UC1);
  auto map = wall_with_gap(150, 450);
  close_gaps(map, {}, nothing, 8, LayoutParams{});
  EXPECT_TRUE(map.openings.empty());
}

}  // namespace
}  // namespace smokemap
