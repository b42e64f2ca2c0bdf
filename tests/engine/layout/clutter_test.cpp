#include "layout/clutter.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "layout/read_layout.hpp"
#include "tests/engine/layout/drawn_plan.hpp"

namespace smokemap {
namespace {

const cv::Scalar kInkOn(255);

cv::Mat empty_ink(int width = 1600, int height = 1100) { return cv::Mat::zeros(height, width, CV_8UC1); }

void write_on(cv::Mat& ink, const std::string& words, cv::Point at, double size, int pen = 2) {
  cv::putText(ink, words, at, cv::FONT_HERSHEY_SIMPLEX, size, kInkOn, pen);
}

double share_marked(const cv::Mat& mask, const cv::Mat& ink, const cv::Rect& where) {
  const int all = cv::countNonZero(ink(where));
  return all ? static_cast<double>(cv::countNonZero(mask(where) & ink(where))) / all : 0;
}

TEST(Text, IsFoundInSmallWordsAndInTitles) {
  cv::Mat ink = empty_ink();
  write_on(ink, "Extinguisher", {100, 100}, 0.7);
  write_on(ink, "EVACUATION", {400, 300}, 2.5, 7);
  const cv::Mat text = find_text(ink);
  EXPECT_GT(share_marked(text, ink, {90, 60, 300, 60}), 0.9);
  EXPECT_GT(share_marked(text, ink, {380, 200, 700, 130}), 0.9);
}

TEST(Text, IsFoundWhenItRunsUpwards) {
  cv::Mat ink = empty_ink();
  write_on(ink, "Storeroom", {100, 100}, 0.7);
  cv::Mat turned;
  cv::rotate(ink, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
  EXPECT_GT(share_marked(find_text(turned), turned, {0, 0, turned.cols, turned.rows}), 0.9);
}

TEST(Text, IsNotAWallInPiecesBetweenWindows) {
  cv::Mat ink = empty_ink();
  for (int x = 100; x < 1400; x += 90) cv::rectangle(ink, {x, 200, 60, 14}, kInkOn, cv::FILLED);
  EXPECT_EQ(cv::countNonZero(find_text(ink)), 0);
}

TEST(Text, IsNotARowOfRoomsWhoseWallsEndAtDoors) {
  cv::Mat ink = empty_ink();
  for (int x = 100; x < 1000; x += 90) {  // pieces like a T, close together, with door leaves beside them
    cv::rectangle(ink, {x, 200, 60, 8}, kInkOn, cv::FILLED);
    cv::rectangle(ink, {x + 26, 200, 8, 70}, kInkOn, cv::FILLED);
    cv::line(ink, {x + 72, 204}, {x + 72, 230}, kInkOn, 2);
    cv::line(ink, {x + 5, 290}, {x + 60, 290}, kInkOn, 8);
  }
  EXPECT_EQ(cv::countNonZero(find_text(ink)), 0);
}

TEST(Text, NeedsThreeLetters) {
  cv::Mat ink = empty_ink();
  write_on(ink, "WC", {100, 100}, 0.9);
  EXPECT_EQ(cv::countNonZero(find_text(ink)), 0);
}

TEST(Text, OfAnEmptyPictureIsNothing) { EXPECT_EQ(cv::countNonZero(find_text(empty_ink(40, 30))), 0); }

cv::Mat header_on(cv::Mat ink, const cv::Rect& bar, const std::string& words, double size) {
  cv::rectangle(ink, bar, kInkOn, cv::FILLED);
  cv::putText(ink, words, {bar.x + 10, bar.y + bar.height * 3 / 4}, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar(0), 2);
  return ink;
}

// Regression: on gray copies the title's bar was taken for the plan, and a legend's for its thickest wall.
TEST(Headers, AreDarkBarsWithLightWords) {
  const cv::Rect title(20, 20, 1500, 60), legend(1100, 300, 300, 24);
  cv::Mat ink = header_on(header_on(empty_ink(), title, "Evacuation plan", 1.4), legend, "In case of fire", 0.6);
  cv::rectangle(ink, {1100, 300, 300, 400}, kInkOn, 2);  // the box below it
  const cv::Mat headers = find_headers(ink, LayoutParams{});
  EXPECT_GT(share_marked(headers, ink, title), 0.95);
  EXPECT_GT(share_marked(headers, ink, legend), 0.95);
  EXPECT_LT(share_marked(headers, ink, {1090, 340, 320, 400}), 0.01) << "the box is left";
}

TEST(Headers, AreFoundAskew) {
  cv::Mat ink = header_on(empty_ink(), {200, 500, 1000, 50}, "Evacuation plan", 1.2), turned;
  cv::warpAffine(ink, turned, cv::getRotationMatrix2D({800, 550}, 4, 1), ink.size(), cv::INTER_NEAREST);
  EXPECT_GT(share_marked(find_headers(turned, LayoutParams{}), turned, {0, 0, turned.cols, turned.rows}), 0.95);
}

TEST(Headers, AreNoWallsWhateverIsDrawnAtTheirEnds) {
  cv::Mat ink = empty_ink();
  cv::rectangle(ink, {200, 200, 400, 20}, kInkOn, cv::FILLED);  // solid
  cv::rectangle(ink, {200, 400, 400, 20}, kInkOn, 4);           // hollow
  for (int y = 300; y < 320; y += 4) cv::line(ink, {610, y}, {640, y}, kInkOn, 1);
  cv::rectangle(ink, {640, 300, 400, 20}, kInkOn, cv::FILLED);                               // between dashed windows
  for (int x = 200; x < 1000; x += 200) cv::rectangle(ink, {x, 600, 200, 300}, kInkOn, 12);  // a row of rooms
  EXPECT_EQ(cv::countNonZero(find_headers(ink, LayoutParams{})), 0);
  EXPECT_EQ(cv::countNonZero(find_headers(empty_ink(1, 1), LayoutParams{})), 0);
}

TEST(Blocks, AreDotsThatStandAloneAndNoJunctionsOfWalls) {
  cv::Mat ink = empty_ink();
  cv::line(ink, {200, 500}, {1400, 500}, kInkOn, 16);
  cv::line(ink, {800, 100}, {800, 1000}, kInkOn, 16);
  cv::line(ink, {1100, 100}, {1400, 500}, kInkOn, 16);
  EXPECT_EQ(cv::countNonZero(find_blocks(ink, 14)), 0) << "walls a little thicker than they were measured";
  cv::circle(ink, {760, 540}, 13, kInkOn, cv::FILLED);
  const cv::Mat blocks = find_blocks(ink, 16);
  EXPECT_GT(blocks.at<std::uint8_t>(540, 760), 0);
  EXPECT_EQ(blocks.at<std::uint8_t>(500, 900), 0);
  EXPECT_EQ(blocks.at<std::uint8_t>(700, 800), 0);
}

TEST(Blocks, AreSolidSignsWithTheirPictograms) {
  cv::Mat ink = empty_ink();
  cv::rectangle(ink, {300, 300, 44, 44}, kInkOn, cv::FILLED);
  cv::rectangle(ink, {310, 318, 24, 8}, cv::Scalar(0), cv::FILLED);
  const cv::Mat blocks = find_blocks(ink, 8);
  EXPECT_EQ(blocks.at<uchar>(322, 322), 255) << "the white bar belongs to the sign";
  EXPECT_EQ(blocks.at<uchar>(302, 302), 255);
  EXPECT_EQ(blocks.at<uchar>(280, 322), 0);
}

TEST(Blocks, AreNeitherWallsNorTheirCrossings) {
  cv::Mat ink = empty_ink();
  cv::rectangle(ink, {100, 300, 1000, 12}, kInkOn, cv::FILLED);
  cv::rectangle(ink, {500, 100, 12, 600}, kInkOn, cv::FILLED);
  EXPECT_EQ(cv::countNonZero(find_blocks(ink, 12)), 0);
}

TEST(Blocks, OnAWallAreFoundWithoutTheWall) {
  cv::Mat ink = empty_ink();
  cv::rectangle(ink, {100, 300, 1000, 8}, kInkOn, cv::FILLED);
  cv::rectangle(ink, {400, 285, 40, 40}, kInkOn, cv::FILLED);
  const cv::Mat blocks = find_blocks(ink, 8);
  EXPECT_EQ(blocks.at<uchar>(304, 420), 255);
  EXPECT_EQ(blocks.at<uchar>(304, 300), 0);
  EXPECT_EQ(blocks.at<uchar>(304, 600), 0);
}

TEST(Blocks, AreNoHeaders) {
  cv::Mat ink = empty_ink();
  cv::rectangle(ink, {0, 0, 1600, 70}, kInkOn, cv::FILLED);
  EXPECT_EQ(cv::countNonZero(find_blocks(ink, 8)), 0);
}

// Regression: a title's letters, as thick as the walls and close above the plan, were read as walls.
TEST(ReadLayout, TitleLettersAreNoWalls) {
  auto plan = testing::draw_office();
  cv::putText(plan.picture, "ESCAPE ROUTES", {400, 150}, cv::FONT_HERSHEY_SIMPLEX, 2.6, cv::Scalar(10, 10, 10), 8);
  const auto reading = read_layout(plan.picture);
  ASSERT_TRUE(reading.ok());
  for (const auto& s : testing::wall_segments(reading->layout))
    EXPECT_GT(std::min(s.a.y(), s.b.y()), 190) << "a wall in the title";
}

// Regression: signs on a copy without colour left their outlines as walls, and hid the wall below.
TEST(ReadLayout, GrayCopiesOfSignsAreNoWalls) {
  auto plan = testing::draw_office();
  for (const cv::Point at : {cv::Point(450, 190), cv::Point(980, 640), cv::Point(300, 480)})
    cv::rectangle(plan.picture, {at.x, at.y, 40, 40}, cv::Scalar(60, 60, 60), cv::FILLED);
  const auto reading = read_layout(plan.picture);
  ASSERT_TRUE(reading.ok());
  const auto found = testing::wall_segments(reading->layout);
  auto allowed = plan.walls;
  allowed.insert(allowed.end(), plan.doors.begin(), plan.doors.end());
  EXPECT_GT(testing::covered_by(found, allowed, 7), 0.97);
  EXPECT_GT(testing::covered_by(plan.walls, found, 7), 0.95);
}

/// The office with every wall as two lines.
cv::Mat hollow_office(int thick, int line) {
  const auto plan = testing::draw_office(1.0, false);
  cv::Mat ink = cv::Mat::zeros(plan.picture.size(), CV_8UC1);
  for (const auto& w : plan.walls) cv::line(ink, testing::detail::px(w.a), testing::detail::px(w.b), kInkOn, thick);
  cv::Mat inner;
  cv::erode(ink, inner, cv::getStructuringElement(cv::MORPH_RECT, {2 * line + 1, 2 * line + 1}));
  cv::Mat picture(ink.size(), CV_8UC3, cv::Scalar(255, 255, 255));
  picture.setTo(cv::Scalar(20, 20, 20), ink & ~inner);
  for (const auto& d : plan.doors) {
    cv::line(picture, testing::detail::px(d.a), testing::detail::px(d.a + Point2(0, 70)), cv::Scalar(20, 20, 20), line);
    cv::ellipse(picture, testing::detail::px(d.a), {70, 70}, 0, 0, 90, cv::Scalar(20, 20, 20), line, cv::LINE_AA);
  }
  return picture;
}

// Regression: in plans that draw walls as two lines, door leaves and arcs as thick as those lines were read as walls.
TEST(ReadLayout, HollowWallsAreReadWithoutLeavesAndArcs) {
  const auto plan = testing::draw_office(1.0, false);
  const auto reading = read_layout(hollow_office(13, 2));
  ASSERT_TRUE(reading.ok());
  const auto found = testing::wall_segments(reading->layout);
  EXPECT_GT(testing::covered_by(plan.walls, found, 6), 0.93);
  auto allowed = plan.walls;
  allowed.insert(allowed.end(), plan.doors.begin(), plan.doors.end());
  EXPECT_GT(testing::covered_by(found, allowed, 6), 0.85);
}

// Regression: blur closes the two lines of a thin wall in a photograph; such walls were read as two, or not at all.
TEST(ReadLayout, HollowWallsSurviveBlur) {
  const auto plan = testing::draw_office(1.0, false);
  cv::Mat picture = hollow_office(9, 2);
  cv::GaussianBlur(picture, picture, {0, 0}, 1.2);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading.ok());
  EXPECT_GT(testing::covered_by(plan.walls, testing::wall_segments(reading->layout), 6), 0.9);
}

}  // namespace
}  // namespace smokemap
