#include "layout/openings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "layout/gaps.hpp"
#include "layout/read_layout.hpp"
#include "layout/rooms.hpp"
#include "layout/wall_graph.hpp"
#include "tests/engine/layout/drawn_plan.hpp"

namespace smokemap {
namespace {

InkStroke line_of(double x1, double y1, double x2, double y2, double thickness = 1.5) {
  InkStroke s;
  s.axis = {Point2(x1, y1), Point2(x2, y2)};
  s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
  return s;
}

constexpr double kWallPx = 10;

/// A room of 1000 x 600 whose upper wall is left out between `from` and `to`.
std::vector<InkStroke> room_open_above(double from, double to) {
  return {line_of(0, 0, from, 0, kWallPx), line_of(to, 0, 1000, 0, kWallPx), line_of(0, 0, 0, 600, kWallPx),
          line_of(1000, 0, 1000, 600, kWallPx), line_of(0, 600, 1000, 600, kWallPx)};
}

LayoutMap closed(const std::vector<InkStroke>& walls, const std::vector<InkStroke>& thin) {
  LayoutMap map = build_wall_graph(walls, kWallPx, LayoutParams{});
  close_gaps(map, thin, cv::Mat::zeros(700, 1100, CV_8UC1), kWallPx, LayoutParams{});
  return map;
}

int count_of(const LayoutMap& map, OpeningKind kind) {
  return static_cast<int>(
      std::count_if(map.openings.begin(), map.openings.end(), [&](const LayoutOpening& o) { return o.kind == kind; }));
}

// Regression: rooms with windows wider than doors stayed open.
TEST(Openings, AWideGapWithAFrameIsAWindow) {
  const auto walls = room_open_above(380, 640);
  EXPECT_TRUE(closed(walls, {}).openings.empty()) << "nothing is drawn there";
  const auto map = closed(walls, {line_of(380, -4, 640, -4), line_of(380, 4, 640, 4)});
  ASSERT_EQ(map.openings.size(), 1U);
  EXPECT_EQ(map.openings[0].kind, OpeningKind::kWindow);
  EXPECT_NEAR(map.openings[0].gap_px.length(), 260, 2);
  EXPECT_EQ(find_rooms(map).size(), 1U);
}

TEST(Openings, AFrameInPiecesCountsAsOne) {
  const auto walls = room_open_above(380, 640);
  EXPECT_EQ(closed(walls, {line_of(380, -4, 500, -4), line_of(512, 4, 640, 4)}).openings.size(), 1U);
  EXPECT_TRUE(closed(walls, {line_of(380, -4, 500, -4), line_of(390, 4, 500, 4)}).openings.empty())
      << "the same half twice is half of it";
}

TEST(Openings, NoFrameIsTooWideToBelieve) {
  EXPECT_TRUE(closed(room_open_above(200, 900), {line_of(200, -4, 900, -4)}).openings.empty());
}

// A glass front that carries on a wall which ends in a corner.
TEST(Openings, AFrameCarriesOnAWallThatEndsInACorner) {
  auto walls = room_open_above(500, 500);
  walls.push_back(line_of(300, 300, 600, 300, kWallPx));
  walls.push_back(line_of(600, 300, 600, 450, kWallPx));  // goes on to the lower wall as glass
  walls.push_back(line_of(300, 300, 300, 600, kWallPx));
  const auto open = find_rooms(closed(walls, {})).size();
  const auto map = closed(walls, {line_of(600, 450, 600, 600)});
  EXPECT_EQ(find_rooms(map).size(), open + 1);
}

TEST(JoinedEnds, AreCornersWhereNothingCarriesOn) {
  const auto map = build_wall_graph(
      {line_of(0, 0, 200, 0, kWallPx), line_of(200, 0, 200, 100, kWallPx), line_of(100, 0, 100, 80, kWallPx)}, kWallPx,
      LayoutParams{});
  const auto ends = joined_ends(map);
  // the corner looks right and up, the foot of the tee up; along the upper wall something carries on at the tee
  ASSERT_EQ(ends.size(), 3U);
  const auto looks = [&](const Point2& p, const Point2& outward) {
    return std::any_of(ends.begin(), ends.end(),
                       [&](const LooseEnd& e) { return (e.p - p).norm() < 1 && e.outward.dot(outward) > 0.99; });
  };
  EXPECT_TRUE(looks({200, 0}, {1, 0}));
  EXPECT_TRUE(looks({200, 0}, {0, -1}));
  EXPECT_TRUE(looks({100, 0}, {0, -1}));
}

// Regression: the stubs of a closet were carried on across the room, which its front never was.
TEST(Openings, AClosetIsShutAlongItsFront) {
  auto walls = room_open_above(500, 500);
  walls.push_back(line_of(400, 0, 400, 100, kWallPx));
  walls.push_back(line_of(480, 0, 480, 100, kWallPx));
  walls.push_back(line_of(380, 170, 500, 170, kWallPx));  // a wall across, within reach of both
  const auto map = closed(walls, {line_of(405, 98, 475, 98), line_of(405, 102, 475, 102)});
  const auto across = std::count_if(map.openings.begin(), map.openings.end(), [](const LayoutOpening& o) {
    return std::abs(o.gap_px.a.y() - o.gap_px.b.y()) < 5;
  });
  EXPECT_EQ(across, 1) << "both lines are one front";
  EXPECT_EQ(static_cast<int>(map.openings.size()), 1);
}

// Regression: beside a closet that was shut a shower stayed open: of two lines from one end only one was taken.
TEST(Openings, APartitionPartsTwoClosets) {
  auto walls = room_open_above(500, 500);
  for (const double x : {400.0, 500.0, 600.0}) walls.push_back(line_of(x, 0, x, 100, kWallPx));
  const auto map = closed(walls, {line_of(405, 99, 495, 99), line_of(505, 99, 595, 99)});
  EXPECT_EQ(find_rooms(map).size(), 3U);
}

// Regression: a stub that was joined askew to a thick wall looked for its partner across the room.
TEST(LooseEnds, OfStubsGoOnSquareToTheWallThatTheyWereJoinedTo) {
  const auto map =
      build_wall_graph({line_of(0, 0, 600, 0, kWallPx), line_of(300, 5, 306, 32, kWallPx)}, kWallPx, LayoutParams{});
  for (const auto& end : loose_ends(map)) {
    if (end.p.y() < 20) continue;
    EXPECT_NEAR(end.outward.x(), 0, 1e-6);
    EXPECT_NEAR(end.outward.y(), 1, 1e-6);
  }
  const auto slanting =
      build_wall_graph({line_of(0, 0, 600, 0, kWallPx), line_of(300, 5, 340, 105, kWallPx)}, kWallPx, LayoutParams{});
  for (const auto& end : loose_ends(slanting)) {
    if (end.p.y() > 20) {
      EXPECT_GT(end.outward.x(), 0.3) << "a wall as long as that knows its direction";
    }
  }
}

/// A room of 1000 x 600 with a hall of `width` below its upper wall, open to the right, drawn as ink; walls stand out
/// by `nib` on both sides of the mouth.
LayoutMap hall_with_nibs(double width, double nib_above, double nib_below) {
  const std::vector<InkStroke> walls{line_of(0, 0, 1000, 0, kWallPx),        line_of(0, 0, 0, 600, kWallPx),
                                     line_of(1000, 0, 1000, 600, kWallPx),   line_of(0, 600, 1000, 600, kWallPx),
                                     line_of(0, width, 500, width, kWallPx), line_of(500, width, 500, 600, kWallPx)};
  const Point2 shift(20, 20);
  cv::Mat ink = cv::Mat::zeros(700, 1100, CV_8UC1);
  auto shifted = walls;
  for (auto& s : shifted) {
    s.axis = {s.axis.a + shift, s.axis.b + shift};
    cv::line(ink, testing::detail::px(s.axis.a), testing::detail::px(s.axis.b), cv::Scalar(255),
             static_cast<int>(kWallPx));
  }
  const auto nib = [&](double y1, double y2) {
    cv::rectangle(ink, testing::detail::px(Point2(495, y1) + shift), testing::detail::px(Point2(505, y2) + shift),
                  cv::Scalar(255), cv::FILLED);
  };
  nib(0, 5 + nib_above), nib(width - 5 - nib_below, width);
  LayoutMap map = build_wall_graph(shifted, kWallPx, LayoutParams{});
  close_gaps(map, {}, cv::Mat::zeros(ink.size(), CV_8UC1), kWallPx, LayoutParams{}, ink);
  return map;
}

// Regression: a corridor was one with the room at its end, whose walls stand out on both sides of the mouth.
TEST(Openings, WallsThatStandOutOnBothSidesMakeAPassage) {
  const auto map = hall_with_nibs(60, 3, 3);
  ASSERT_EQ(map.openings.size(), 1U);
  EXPECT_EQ(map.openings[0].kind, OpeningKind::kPassage);
  EXPECT_LE(map.openings[0].confidence, 0.4);
  EXPECT_EQ(find_rooms(map).size(), 3U);
}

TEST(Openings, NibsMustStandOnBothSides) {
  EXPECT_TRUE(hall_with_nibs(60, 0, 0).openings.empty());
  EXPECT_TRUE(hall_with_nibs(60, 3, 0).openings.empty());
  EXPECT_TRUE(hall_with_nibs(60, 0, 3).openings.empty());
}

// Regression: a terrace behind a railing was a room.
TEST(Openings, OneLineAlongTheOuterFaceIsARailing) {
  const auto walls = room_open_above(380, 640);
  EXPECT_TRUE(closed(walls, {line_of(380, -4.5, 640, -4.5)}).openings.empty()) << "outside is above";
  EXPECT_EQ(closed(walls, {line_of(380, 4.5, 640, 4.5)}).openings.size(), 1U) << "along the inner face";
  EXPECT_EQ(closed(walls, {line_of(380, 0, 640, 0)}).openings.size(), 1U) << "glass";
}

/// A flat of 1000 x 600: a hall below, `from`..`to` open towards what lies above, where both sides of the opening end
/// in corners, so that no end is loose.
std::vector<InkStroke> flat_with_hall(double from, double to, double hall_width) {
  const double left = 0.5 * (from + to) - 0.5 * hall_width, right = left + hall_width;
  return {line_of(0, 0, 1000, 0, kWallPx),          line_of(1000, 0, 1000, 300, kWallPx),
          line_of(0, 0, 0, 300, kWallPx),           line_of(0, 300, from, 300, kWallPx),
          line_of(to, 300, 1000, 300, kWallPx),     line_of(from, 300, from, 260, kWallPx),
          line_of(to, 300, to, 260, kWallPx),       line_of(left, 300, left, 600, kWallPx),
          line_of(right, 300, right, 600, kWallPx), line_of(left, 600, right, 600, kWallPx)};
}

// Regression: an opening between two corners stayed open, and its two rooms were one.
TEST(Openings, AMouthBetweenTwoCornersIsADoubtfulPassage) {
  for (const double width : {50.0, 60.0, 70.0}) {
    const auto map = closed(flat_with_hall(500 - 0.5 * width, 500 + 0.5 * width, 400), {});
    ASSERT_EQ(map.openings.size(), 1U) << width;
    EXPECT_EQ(map.openings[0].kind, OpeningKind::kPassage);
    EXPECT_LE(map.openings[0].confidence, 0.4);
    EXPECT_NEAR(map.openings[0].gap_px.length(), width, 3);
    EXPECT_EQ(find_rooms(map).size(), 2U);
  }
}

TEST(Openings, ACorridorIsNotShutWhereItMeetsAnother) {
  for (const double width : {50.0, 60.0, 70.0}) {
    auto walls = flat_with_hall(500 - 0.5 * width, 500 + 0.5 * width, width);
    walls.erase(walls.begin() + 5, walls.begin() + 7);  // without the corners: as wide as what leads to it
    const auto map = closed(walls, {});
    EXPECT_TRUE(map.openings.empty()) << width;
    EXPECT_EQ(find_rooms(map).size(), 1U);
  }
}

// Regression: an entrance whose both sides end in corners left the flat open.
TEST(Openings, ALeafBetweenTwoCornersIsADoor) {
  std::vector<InkStroke> walls{line_of(0, 0, 1000, 0, kWallPx),       line_of(1000, 0, 1000, 600, kWallPx),
                               line_of(0, 0, 0, 600, kWallPx),        line_of(0, 600, 500, 600, kWallPx),
                               line_of(570, 600, 1000, 600, kWallPx), line_of(500, 600, 500, 300, kWallPx),
                               line_of(570, 600, 570, 300, kWallPx),  line_of(0, 300, 500, 300, kWallPx),
                               line_of(570, 300, 1000, 300, kWallPx)};
  const auto map = closed(walls, {line_of(502, 605, 502, 668)});
  const auto door = std::find_if(map.openings.begin(), map.openings.end(),
                                 [](const LayoutOpening& o) { return o.kind == OpeningKind::kDoor; });
  ASSERT_NE(door, map.openings.end());
  EXPECT_NEAR(door->gap_px.midpoint().y(), 600, 2);
  EXPECT_LT(door->confidence, 0.7);
}

// Regression: a gap ended beside the wall that it was to reach, and the room leaked there.
TEST(Gaps, EndOnTheWallThatTheyReach) {
  const auto map = build_wall_graph({line_of(0, 100, 100, 100, kWallPx), line_of(150, 103, 150, 300, kWallPx)}, kWallPx,
                                    LayoutParams{});
  const auto gaps = gaps_ahead(map, loose_ends(map), kWallPx, 80);
  const auto to_wall = std::find_if(gaps.begin(), gaps.end(), [](const Gap& g) { return g.wall_b >= 0; });
  ASSERT_NE(to_wall, gaps.end());
  EXPECT_LT(distance(map.wall_px(to_wall->wall_b), to_wall->segment.b), 1e-6);
}

TEST(Openings, TreadsOfAStairAreNoFronts) {
  auto walls = room_open_above(500, 500);
  walls.push_back(line_of(100, 0, 100, 150, kWallPx));
  std::vector<InkStroke> treads;
  for (int i = 0; i < 20; ++i) treads.push_back(line_of(5, 60.0 + 12 * i, 95, 60.0 + 12 * i));
  EXPECT_TRUE(closed(walls, treads).openings.empty());
}

// Regression: a glazed side left the room open.
TEST(Openings, TwoThinLinesFromWallToWallAreGlass) {
  auto walls = room_open_above(500, 500);
  const auto map = closed(walls, {line_of(296, 5, 296, 595), line_of(304, 5, 304, 595)});
  EXPECT_EQ(count_of(map, OpeningKind::kWindow), 1);
  EXPECT_EQ(find_rooms(map).size(), 2U);
  EXPECT_LT(map.openings.front().confidence, 0.8) << "it may be furniture";
  EXPECT_TRUE(closed(walls, {line_of(296, 5, 296, 400), line_of(304, 5, 304, 400)}).openings.empty())
      << "ends in the open";
  EXPECT_TRUE(closed(walls, {line_of(270, 5, 270, 595), line_of(330, 5, 330, 595)}).openings.empty())
      << "too far apart";
}

cv::Mat drawn(const std::vector<cv::Rect>& solid) {
  cv::Mat picture(1100, 1600, CV_8UC3, cv::Scalar(255, 255, 255));
  for (const auto& box : solid) cv::rectangle(picture, box, cv::Scalar(20, 20, 20), cv::FILLED);
  return picture;
}

/// Walls 16 px thick around 1200 x 600, without the upper one.
std::vector<cv::Rect> three_walls() { return {{200, 200, 16, 600}, {1384, 200, 16, 600}, {200, 784, 1200, 16}}; }

void draw_frame(cv::Mat& picture, int from, int to) {
  for (const int y : {201, 214}) cv::line(picture, {from, y}, {to, y}, cv::Scalar(60, 60, 60), 1, cv::LINE_AA);
}

// Regression: the short pieces of wall between windows were not read, since one edge runs along frames and walls.
TEST(ReadLayout, PiersBetweenWindowsAreWalls) {
  auto solid = three_walls();
  for (const int x : {200, 660, 1340}) solid.push_back({x, 200, 60, 16});
  cv::Mat picture = drawn(solid);
  draw_frame(picture, 260, 660), draw_frame(picture, 720, 1340);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading) << reading.error().message;
  const auto walls = testing::wall_segments(reading->layout);
  for (const int x : {200, 660, 1340}) {
    const Segment2 pier{Point2(x + 8, 208), Point2(x + 52, 208)};
    EXPECT_GT(testing::covered_by({pier}, walls, 5), 0.8) << "pier at " << x;
  }
  EXPECT_EQ(testing::covered_by({{Point2(300, 208), Point2(620, 208)}}, walls, 5), 0) << "glass is no wall";
}

TEST(ReadLayout, APostBetweenTwoWindowsClosesTheRoom) {
  auto solid = three_walls();
  solid.push_back({200, 200, 440, 16}), solid.push_back({960, 200, 440, 16}), solid.push_back({790, 200, 18, 16});
  cv::Mat picture = drawn(solid);
  draw_frame(picture, 640, 790), draw_frame(picture, 808, 960);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading) << reading.error().message;
  EXPECT_EQ(reading->layout.rooms_px.size(), 1U);
}

// Regression: a dot hardly wider than the walls, close to one, was read as slanting walls.
TEST(ReadLayout, ADotBesideAWallIsNoWall) {
  auto solid = three_walls();
  solid.push_back({200, 200, 1200, 16}), solid.push_back({792, 200, 16, 400});
  cv::Mat picture = drawn(solid);
  cv::circle(picture, {770, 640}, 14, cv::Scalar(20, 20, 20), cv::FILLED, cv::LINE_AA);
  cv::rectangle(picture, {792, 660, 16, 130}, cv::Scalar(20, 20, 20), cv::FILLED);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading) << reading.error().message;
  for (const auto& wall : testing::wall_segments(reading->layout)) {
    const double turn = std::min(line_angle_between(wall.heading(), 0), line_angle_between(wall.heading(), kPi / 2));
    EXPECT_LT(turn, radians(4)) << wall.a.transpose() << " to " << wall.b.transpose();
  }
  EXPECT_EQ(reading->layout.rooms_px.size(), 2U);
}

}  // namespace
}  // namespace smokemap
