#include "layout/drawings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "layout/read_layout.hpp"
#include "layout/wall_strokes.hpp"
#include "tests/engine/layout/drawn_plan.hpp"

namespace smokemap {
namespace {

InkStroke drawn_wall(double x1, double y1, double x2, double y2, double thickness = 8) {
  InkStroke s;
  s.axis = {Point2(x1, y1), Point2(x2, y2)};
  s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
  return s;
}

/// A block of rooms in a row, each 100 px wide.
std::vector<InkStroke> row_of_rooms(const Point2& at, int rooms, double height = 120) {
  std::vector<InkStroke> walls{drawn_wall(at.x(), at.y(), at.x() + 100 * rooms, at.y()),
                               drawn_wall(at.x(), at.y() + height, at.x() + 100 * rooms, at.y() + height)};
  for (int i = 0; i <= rooms; ++i)
    walls.push_back(drawn_wall(at.x() + 100 * i, at.y(), at.x() + 100 * i, at.y() + height));
  return walls;
}

std::vector<InkStroke> both(std::vector<InkStroke> one, const std::vector<InkStroke>& two) {
  one.insert(one.end(), two.begin(), two.end());
  return one;
}

TEST(Drawings, AreRankedByWhatTheyHaveOfAPlan) {
  const auto sheet = both(row_of_rooms({100, 700}, 3), row_of_rooms({150, 100}, 7));
  const auto drawings = rank_drawings(sheet, 8, 60, 1200);
  ASSERT_EQ(drawings.size(), 2U);
  EXPECT_EQ(drawings[0].walls.size(), 10U);
  EXPECT_EQ(drawings[1].walls.size(), 6U);
  EXPECT_GT(drawings[0].score, drawings[1].score);
  EXPECT_EQ(drawings[0].low, Point2(150, 100));
  EXPECT_EQ(drawings[0].high, Point2(850, 220));
}

TEST(Drawings, OfOneFloorAreOneThoughACorridorPartsThem) {
  const auto floor = both(row_of_rooms({100, 100}, 5), row_of_rooms({100, 260}, 5));
  EXPECT_EQ(rank_drawings(floor, 8, 60, 1000).size(), 1U);
}

// Regression: the lower half of a flat, parted from the upper by a terrace, was dropped.
TEST(Drawings, OfOneFloorAreOneWhenWallsLineUpInTwoDirections) {
  std::vector<InkStroke> floor = row_of_rooms({100, 100}, 5);
  floor.push_back(drawn_wall(600, 220, 600, 600)), floor.push_back(drawn_wall(540, 600, 600, 600));
  const auto kitchen = row_of_rooms({100, 400}, 2, 200);  // its sides go on in x = 100, its lower wall in y = 600
  EXPECT_EQ(rank_drawings(both(floor, kitchen), 8, 60, 1000).size(), 1U);
  const auto other_floor = row_of_rooms({100, 400}, 5, 170);  // below it, but nothing goes on sideways
  EXPECT_EQ(rank_drawings(both(row_of_rooms({100, 100}, 5), other_floor), 8, 60, 1000).size(), 2U);
}

TEST(Drawings, TheOneUnderTheFingerIsTheSmallestThereElseTheNearest) {
  std::vector<Drawing> drawings(3);
  drawings[0].low = {0, 0}, drawings[0].high = {1000, 1000};
  drawings[1].low = {100, 100}, drawings[1].high = {200, 200};
  drawings[2].low = {1200, 0}, drawings[2].high = {1500, 300};
  EXPECT_EQ(drawing_at(drawings, {500, 500}), 0U);
  EXPECT_EQ(drawing_at(drawings, {150, 150}), 1U);
  EXPECT_EQ(drawing_at(drawings, {1190, 20}), 2U);
}

TEST(ConnectedRegions, KeepApartWhatDoesNotTouch) {
  const auto regions = connected_regions(both(row_of_rooms({0, 0}, 2), row_of_rooms({600, 0}, 2)), 20, 800);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(regions[0].members.size() + regions[1].members.size(), 10U);
}

/// Two offices of the test drawing on one sheet, side by side, the left one smaller.
cv::Mat two_floors() {
  const auto large = testing::draw_office(0.9).picture, small = testing::draw_office(0.6).picture;
  cv::Mat sheet(large.rows, large.cols + small.cols, CV_8UC3, cv::Scalar(255, 255, 255));
  small.copyTo(sheet(cv::Rect(0, 0, small.cols, small.rows)));
  large.copyTo(sheet(cv::Rect(small.cols, 0, large.cols, large.rows)));
  return sheet;
}

TEST(ReadLayout, ShowsTheFloorsOfASheetAndReadsTheOneThatIsChosen) {
  const cv::Mat sheet = two_floors();
  const auto best = read_layout(sheet);
  ASSERT_TRUE(best.ok());
  ASSERT_GE(best->layout.drawings.size(), 2U);
  EXPECT_TRUE(best->layout.drawings[0].chosen);
  EXPECT_GT(best->layout.corners.front().p_px.x(), 960) << "the larger floor is on the right";
  LayoutOptions options;
  options.plan_at_px = Point2(480, 300);
  const auto left = read_layout(sheet, options);
  ASSERT_TRUE(left.ok());
  for (const auto& corner : left->layout.corners) EXPECT_LT(corner.p_px.x(), 960);
  EXPECT_EQ(std::count_if(left->layout.drawings.begin(), left->layout.drawings.end(),
                          [](const LayoutDrawing& d) { return d.chosen; }),
            1);
  options.plan_at_px = Point2(NAN, 0);
  EXPECT_EQ(read_layout(sheet, options).error().code, Errc::kInvalidArgument);
}

/// A thick line of dashes and dots around a hollow plan.
std::vector<InkStroke> dash_dot_line(double y, int periods) {
  std::vector<InkStroke> line;
  for (int i = 0; i < periods; ++i) {
    line.push_back(drawn_wall(200 * i, y, 200 * i + 120, y, 12));
    line.push_back(drawn_wall(200 * i + 147, y, 200 * i + 173, y, 12));
  }
  line.push_back(drawn_wall(200 * periods, y, 200 * periods + 120, y, 12));
  return line;
}

// Regression: the limit of the property, the thickest line on the sheet, was read as the only wall.
TEST(DashDotLines, AreNoWalls) {
  const auto kept = without_dash_dot_lines(both(dash_dot_line(0, 6), row_of_rooms({0, 100}, 5)));
  EXPECT_EQ(kept.size(), 8U);
}

TEST(DashDotLines, ArePiersBetweenWindowsNot) {
  std::vector<InkStroke> facade;
  for (int i = 0; i < 12; ++i) facade.push_back(drawn_wall(90 * i, 0, 90 * i + 40, 0, 12));
  EXPECT_EQ(without_dash_dot_lines(facade).size(), facade.size());
  EXPECT_EQ(without_dash_dot_lines(dash_dot_line(0, 2)).size(), 5U) << "two dots are a chance";
  EXPECT_TRUE(without_dash_dot_lines({}).empty());
}

}  // namespace
}  // namespace smokemap
