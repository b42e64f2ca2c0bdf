#include "layout/doubts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "layout/edit.hpp"
#include "layout/read_layout.hpp"
#include "layout/rooms.hpp"
#include "tests/engine/layout/drawn_plan.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// Rooms of 200 x 200 in a row, all walls sure.
LayoutMap row_of_rooms(int count) {
  LayoutMap map;
  const auto corner = [&](double x, double y) {
    map.corners.push_back({});
    map.corners.back().p_px = {x, y};
    return static_cast<int>(map.corners.size()) - 1;
  };
  for (int i = 0; i <= count; ++i) {
    const int top = corner(200.0 * i, 0), bottom = corner(200.0 * i, 200);
    map.walls.push_back({top, bottom, 8, 0.97, false});
    for (const int c : {top, bottom})
      if (i > 0) map.walls.push_back({c - 2, c, 8, 0.97, false});
  }
  map = with_degrees(std::move(map));
  map.rooms_px = find_rooms(map);
  return map;
}

InkStroke traced_line(const Point2& a, const Point2& b, double thickness = 3) {
  InkStroke s;
  s.axis = {a, b};
  s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
  return s;
}

double surest(const LayoutMap& map) {
  double most = 0;
  for (const auto& wall : map.walls) most = std::max(most, wall.confidence);
  return most;
}

bool warns(const LayoutMap& map, const std::string& words) {
  return std::any_of(map.warnings.begin(), map.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

TEST(Completeness, IsWholeWhereAllWallsBoundRoomsAndNothingElseIsDrawn) {
  const auto map = row_of_rooms(4);
  ASSERT_EQ(map.rooms_px.size(), 4U);
  const auto all = completeness_of(map, {});
  EXPECT_DOUBLE_EQ(all.bordering, 1);
  EXPECT_DOUBLE_EQ(all.unread, 0);
}

TEST(Completeness, CountsWallsThatBoundNoRoom) {
  auto map = row_of_rooms(4);  // 9 + 4 walls of 200
  map.rooms_px.resize(1);      // one room is left: its four walls of 13
  EXPECT_NEAR(completeness_of(map, {}).bordering, 4.0 / 13, 0.02);
}

TEST(Completeness, CountsLongLinesOutsideThatHangTogetherWithTheWalls) {
  const auto map = row_of_rooms(4);  // 2600 of walls
  const std::vector<InkStroke> garage{traced_line({800, 0}, {1100, 0}), traced_line({1100, 0}, {1100, 200}),
                                      traced_line({800, 200}, {1100, 200})};
  EXPECT_NEAR(completeness_of(map, garage).unread, 800.0 / 2600, 0.03);
}

TEST(Completeness, DoesNotCountWhatIsReadOrLiesInARoomOrStandsAlone) {
  auto map = row_of_rooms(4);
  EXPECT_DOUBLE_EQ(completeness_of(map, {traced_line({10, 2}, {390, 2})}).unread, 0) << "the face of a wall";
  EXPECT_DOUBLE_EQ(completeness_of(map, {traced_line({200, 100}, {300, 100})}).unread, 0) << "furniture";
  EXPECT_DOUBLE_EQ(completeness_of(map, {traced_line({-400, 500}, {1400, 500})}).unread, 0) << "the frame of the sheet";
  EXPECT_DOUBLE_EQ(completeness_of(map, {traced_line({800, 100}, {825, 100})}).unread, 0) << "a word at a wall";
  EXPECT_DOUBLE_EQ(
      completeness_of(map, {traced_line({-400, 300}, {1400, 300}), traced_line({400, 200}, {400, 300})}).unread,
      completeness_of(map, {traced_line({400, 200}, {400, 300})}).unread)
      << "the frame, though something leads to it";
  map.openings.push_back({{{800, 0}, {1000, 0}}, OpeningKind::kWindow, 0.8});
  EXPECT_DOUBLE_EQ(completeness_of(map, {traced_line({800, 4}, {1000, 4})}).unread, 0) << "a window";
}

TEST(Completeness, OfNoWallsIsNotANumberOutOfRange) {
  const auto none = completeness_of({}, {traced_line({0, 0}, {100, 0})});
  EXPECT_GE(none.bordering, 0);
  EXPECT_EQ(none.unread, 0);
}

TEST(Tangle, IsNoneOfRoomsAndMostOfRandomLines) {
  EXPECT_EQ(tangle_of(row_of_rooms(12)), 0);
  LayoutMap star;  // 20 crossings of lines at all angles
  for (int i = 0; i < 20; ++i)
    for (int k = -1; k < 4; ++k) {
      star.corners.push_back({});
      const double angle = 0.15 * i + k * kPi / 2;
      star.corners.back().p_px =
          Point2(300.0 * i, 0) + (k < 0 ? Point2(0, 0) : 100 * Point2(std::cos(angle), std::sin(angle)));
      if (k >= 0) star.walls.push_back({5 * i, 5 * i + k + 1, 5, 0.95, false});
    }
  EXPECT_GT(tangle_of(star), 0.6);
}

TEST(Doubts, LeaveAWholePlanAsItIs) {
  auto map = row_of_rooms(4);
  const auto doubts = doubt_reading(map, {}, false);
  EXPECT_FALSE(doubts.no_rooms || doubts.part_read || doubts.tangled || doubts.crowded);
  EXPECT_DOUBLE_EQ(surest(map), 0.97);
  add_warnings(map, doubts, false);
  EXPECT_FALSE(warns(map, "Only a part") || warns(map, "cross one another") || warns(map, "Much of"));
}

// Regression: a reading without the left half of the plan said that all of its walls were sure, and no word.
TEST(Doubts, OfAPartOfAPlanNoWallIsSureAndItIsSaid) {
  auto map = row_of_rooms(4);
  std::vector<InkStroke> wing;
  for (int i = 0; i < 4; ++i) {
    wing.push_back(traced_line({800.0 + 200 * i, 0}, {1000.0 + 200 * i, 0}));
    wing.push_back(traced_line({800.0 + 200 * i, 200}, {1000.0 + 200 * i, 200}));
  }
  const auto doubts = doubt_reading(map, wing, false);
  EXPECT_TRUE(doubts.part_read);
  EXPECT_LT(surest(map), 0.9);
  add_warnings(map, doubts, false);
  EXPECT_TRUE(warns(map, "Only a part of the drawing was understood"));
  EXPECT_FALSE(warns(map, "Much of")) << "one reason is enough";
}

TEST(Doubts, NeverTouchWhatAPersonDrew) {
  auto map = row_of_rooms(2);
  map.walls[0].by_person = true, map.walls[0].confidence = 1;
  doubt_reading(map, {}, true);
  EXPECT_DOUBLE_EQ(map.walls[0].confidence, 1);
  EXPECT_LT(map.walls[1].confidence, 0.6);
}

cv::Mat random_lines(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  cv::Mat picture(800, 1100, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int i = 0; i < count; ++i) {
    const Point2 a(1100 * unit(random), 800 * unit(random));
    const double angle = kPi * unit(random), length = 50 + 300 * unit(random);
    cv::line(picture, testing::detail::px(a),
             testing::detail::px(a + length * Point2(std::cos(angle), std::sin(angle))), cv::Scalar(20, 20, 20), 4,
             cv::LINE_AA);
  }
  return picture;
}

// Regression: of 400 random strokes over one another nine in ten were sure walls.
TEST(Doubts, RandomLinesAreNoSureWalls) {
  const auto reading = read_layout(random_lines(90, 3));
  ASSERT_THAT(reading, test::IsOk());
  EXPECT_LT(surest(reading->layout), 0.9);
  EXPECT_TRUE(warns(reading->layout, "The lines cross one another as in no building"));
}

}  // namespace
}  // namespace smokemap
