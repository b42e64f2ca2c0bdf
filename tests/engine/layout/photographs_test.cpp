// Photographs of generated plans: blur, tilt and uneven light, dark surroundings, legends beside the drawing.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "core/random.hpp"
#include "layout/clutter.hpp"
#include "layout/edit.hpp"
#include "layout/gaps.hpp"
#include "layout/openings.hpp"
#include "layout/read_layout.hpp"
#include "layout/wall_graph.hpp"
#include "layout/wall_strokes.hpp"
#include "simulation/demo_scenario.hpp"
#include "tests/engine/layout/drawn_plan.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

/// A photograph and the true walls in its pixels.
struct Photographed {
  cv::Mat photo;
  std::vector<Segment2> walls, openings;
  double extent_px = 0;
};

Point2 photo_place(const cv::Mat& H_photo_sheet, const Point2& p) {
  const cv::Mat q = H_photo_sheet * (cv::Mat_<double>(3, 1) << p.x(), p.y(), 1);
  return {q.at<double>(0) / q.at<double>(2), q.at<double>(1) / q.at<double>(2)};
}

Result<Photographed> photograph_of_demo(std::uint64_t seed) {
  const auto demo = make_demo(seed);
  if (!demo) return demo.error();
  PlanPictureParams params;
  params.photo = true;
  auto random = random_stream(seed, 21);
  const auto picture = draw_plan(demo->plan.drawn, params, random);
  if (!picture) return picture.error();
  const auto truth = true_layout(demo->plan, *picture);
  auto H = picture->homography.H_layout_photo;
  const cv::Mat H_photo_sheet = cv::Mat(3, 3, CV_64F, H.data()).inv();
  Photographed out;
  out.photo = picture->photo;
  Point2 low = Point2::Constant(1e9), high = Point2::Constant(-1e9);
  for (const auto& s : testing::wall_segments(truth.layout)) {
    out.walls.push_back({photo_place(H_photo_sheet, s.a), photo_place(H_photo_sheet, s.b)});
    low = low.cwiseMin(out.walls.back().a), high = high.cwiseMax(out.walls.back().a);
  }
  for (const auto& o : truth.layout.openings)
    out.openings.push_back({photo_place(H_photo_sheet, o.gap_px.a), photo_place(H_photo_sheet, o.gap_px.b)});
  out.extent_px = (high - low).maxCoeff();
  return out;
}

// Regression: blurred words hung on to the drawing, the bar of the legend between them was taken for its outer wall,
// and all partitions for thin lines: 5 walls of 87, no room.
TEST(Photographs, OfTheDemosPlansAreRead) {
  for (const std::uint64_t seed : {kDemoSeed, std::uint64_t{5}}) {
    SCOPED_TRACE(seed);
    const auto truth = photograph_of_demo(seed);
    ASSERT_THAT(truth, test::IsOk());
    const auto reading = read_layout(truth->photo);
    ASSERT_THAT(reading, test::IsOk());
    const auto walls = testing::wall_segments(reading->layout);
    auto allowed = truth->walls;
    allowed.insert(allowed.end(), truth->openings.begin(), truth->openings.end());
    EXPECT_GT(testing::covered_by(truth->walls, walls, 0.006 * truth->extent_px), 0.85);
    EXPECT_GT(testing::covered_by(walls, allowed, 0.006 * truth->extent_px), 0.9);
    EXPECT_GE(reading->layout.rooms_px.size(), 14U);
    const auto windows = std::count_if(reading->layout.openings.begin(), reading->layout.openings.end(),
                                       [](const LayoutOpening& o) { return o.kind == OpeningKind::kWindow; });
    EXPECT_GE(windows, 12) << "windows are told from walls";
  }
}

// Regression: what is dark around the sheet of a gray photograph surrounds its title, which was not looked at then.
TEST(Photographs, WithoutColourKeepTheirTitleOutOfThePlan) {
  const auto truth = photograph_of_demo(2);
  ASSERT_THAT(truth, test::IsOk());
  cv::Mat gray;
  cv::cvtColor(truth->photo, gray, cv::COLOR_BGR2GRAY);
  const auto reading = read_layout(gray);
  ASSERT_THAT(reading, test::IsOk());
  EXPECT_GT(testing::covered_by(truth->walls, testing::wall_segments(reading->layout), 0.006 * truth->extent_px), 0.75);
}

TEST(Photographs, HaveHeadersWhoseLettersAreHardlyLighter) {
  cv::Mat bar = cv::Mat::zeros(400, 1600, CV_8UC1), blurred;
  cv::rectangle(bar, {300, 150, 500, 30}, cv::Scalar(230), cv::FILLED);
  cv::putText(bar, "Legend", {312, 171}, cv::FONT_HERSHEY_SIMPLEX, 0.55, cv::Scalar(0), 1, cv::LINE_AA);
  cv::GaussianBlur(bar, blurred, {5, 5}, 1.0);
  EXPECT_GT(cv::countNonZero(find_headers(blurred, LayoutParams{})({300, 150, 500, 30})), 0.9 * 500 * 30);
  cv::rectangle(blurred, {0, 0, 1599, 399}, cv::Scalar(240), 20);  // the dark beyond the sheet
  EXPECT_GT(cv::countNonZero(find_headers(blurred, LayoutParams{})({300, 150, 500, 30})), 0.9 * 500 * 30);
}

// A thick outer wall with windows is a bar with light spots too.
TEST(Photographs, HaveNoHeadersWhereAWallHasWindows) {
  cv::Mat wall = cv::Mat::zeros(400, 1600, CV_8UC1);
  cv::rectangle(wall, {200, 150, 1000, 24}, cv::Scalar(230), cv::FILLED);
  for (int x = 260; x < 1150; x += 150) cv::rectangle(wall, {x, 155, 80, 14}, cv::Scalar(0), cv::FILLED);
  EXPECT_EQ(cv::countNonZero(find_headers(wall, LayoutParams{})), 0);
}

TEST(Photographs, HaveWordsWhoseLettersHangTogether) {
  cv::Mat ink = cv::Mat::zeros(400, 1600, CV_8UC1);
  cv::putText(ink, "rescue", {100, 100}, cv::FONT_HERSHEY_SIMPLEX, 0.6, cv::Scalar(255), 2);
  cv::line(ink, {103, 94}, {165, 94}, cv::Scalar(255), 1);
  cv::rectangle(ink, {600, 80, 90, 12}, cv::Scalar(255), cv::FILLED);  // a pier
  cv::rectangle(ink, {800, 80, 60, 12}, cv::Scalar(255), 2);           // the frame of a window
  const cv::Mat text = find_text(ink);
  EXPECT_GT(cv::countNonZero(text({90, 70, 200, 45})), 0.9 * cv::countNonZero(ink({90, 70, 200, 45})));
  EXPECT_EQ(cv::countNonZero(text({550, 60, 400, 60})), 0);
}

InkStroke drawn(double x1, double y1, double x2, double y2, double thickness) {
  InkStroke s;
  s.axis = {{x1, y1}, {x2, y2}};
  s.thickness_px = thickness, s.coverage = 1, s.darkness = 1;
  return s;
}

/// Rooms in two rows along a corridor, with door leaves. @param across  thickness of partitions that run across
std::vector<InkStroke> rows_of_rooms(double outer, double upright, double across) {
  std::vector<InkStroke> strokes{drawn(100, 140, 1100, 140, outer), drawn(100, 660, 1100, 660, outer),
                                 drawn(100, 140, 100, 660, outer), drawn(1100, 140, 1100, 660, outer)};
  for (const double y : {340.0, 460.0}) {
    for (double x = 100; x < 1100; x += 200) strokes.push_back(drawn(x, y, x + 140, y, across));
    for (double x = 300; x < 1100; x += 200) {
      strokes.push_back(drawn(x, y < 400 ? 140 : 460, x, y < 400 ? 340 : 660, upright));
      strokes.push_back(drawn(x - 60, y, x - 60, y + (y < 400 ? -55 : 55), 1.8));  // a leaf
    }
  }
  return strokes;
}

TEST(Photographs, MayMakeWallsThatRunAcrossLookThinner) {
  // outer walls 11 and 8, partitions 5.8 and 4: the deepest valley lies between the partitions
  auto strokes = rows_of_rooms(8, 5.8, 4);
  strokes[2].thickness_px = strokes[3].thickness_px = 11.6;
  const auto chosen = select_walls(strokes, {1500, 900}, LayoutParams{});
  EXPECT_GE(chosen.walls.size(), 4U + 10 + 8) << "no partition is a thin line";
  EXPECT_LT(chosen.thin_limit_px, 4.6);
  EXPECT_GT(chosen.thin_limit_px, 1.8);
}

TEST(Photographs, ThicknessIsNotMeasuredOnABarThatStandsAlone) {
  auto strokes = rows_of_rooms(8, 4, 4);
  // a wing to the right below, so that the bar lies within the bounds of the drawing
  strokes.push_back(drawn(1100, 660, 1400, 660, 8)), strokes.push_back(drawn(1400, 660, 1400, 850, 8));
  strokes.push_back(drawn(1100, 850, 1400, 850, 8)), strokes.push_back(drawn(1100, 660, 1100, 850, 8));
  const auto plain = select_walls(strokes, {1600, 1000}, LayoutParams{});
  strokes.push_back(drawn(1180, 300, 1480, 300, 26));
  const auto chosen = select_walls(strokes, {1600, 1000}, LayoutParams{});
  EXPECT_NEAR(chosen.thin_limit_px, plain.thin_limit_px, 0.3);
  EXPECT_GE(chosen.walls.size(), plain.walls.size());
}

TEST(Windows, AreWallsThatAreOpenToTheEye) {
  // a front in two pieces, a window of two lines between them
  auto map = build_wall_graph({drawn(0, 0, 250, 0, 8), drawn(330, 0, 600, 0, 8), drawn(0, 0, 0, 300, 8),
                               drawn(600, 0, 600, 300, 8), drawn(0, 300, 600, 300, 8)},
                              8, LayoutParams{});
  close_gaps(map, {drawn(250, -3, 330, -3, 1), drawn(250, 3, 330, 3, 1)}, cv::Mat::zeros(400, 700, CV_8UC1), 8,
             LayoutParams{});
  ASSERT_EQ(map.openings.size(), 1U);
  EXPECT_EQ(map.openings[0].kind, OpeningKind::kWindow);
  ASSERT_EQ(map.walls.size(), 4U) << "the front is one wall again";
  EXPECT_EQ(map.corners.size(), 4U);
  EXPECT_TRUE(loose_ends(map).empty());
  EXPECT_GT(testing::covered_by({{{0, 0}, {600, 0}}}, testing::wall_segments(map), 1), 0.99);
}

TEST(Windows, OfOneLineFromWallToWallAreNoWalls) {
  auto map = build_wall_graph({drawn(0, 0, 150, 0, 8), drawn(310, 0, 600, 0, 8), drawn(0, 0, 0, 300, 8),
                               drawn(600, 0, 600, 300, 8), drawn(0, 300, 600, 300, 8)},
                              8, LayoutParams{});
  const auto before = map.walls.size();
  close_gaps(map, {drawn(150, 0, 310, 0, 1)}, cv::Mat::zeros(400, 700, CV_8UC1), 8, LayoutParams{});
  ASSERT_EQ(map.openings.size(), 1U) << "a railing, or a sliding door";
  EXPECT_EQ(map.walls.size(), before);
}

TEST(StraightCorners, GoWhereNothingElseMeets) {
  LayoutMap map;
  for (const Point2& p : {Point2(0, 0), Point2(50, 0.2), Point2(100, 0), Point2(100, 80), Point2(200, 0)}) {
    LayoutCorner corner;
    corner.p_px = p;
    map.corners.push_back(corner);
  }
  map.walls = {{0, 1, 8, 0.9, false}, {2, 1, 8, 0.7, false}, {2, 3, 8, 0.9, false}, {2, 4, 8, 0.9, false}};
  const auto straight = without_straight_corners(with_degrees(map));
  ASSERT_EQ(straight.walls.size(), 3U);
  ASSERT_EQ(straight.corners.size(), 4U) << "where a third wall meets, the corner stays";
  EXPECT_NEAR(straight.walls[0].confidence, 0.8, 0.01) << "by length";
  int tees = 0;
  for (const auto& c : straight.corners) tees += c.degree == 3;
  EXPECT_EQ(tees, 1);
}

TEST(StraightCorners, StayWhereOneHalfIsDoubtful) {
  LayoutMap map;
  for (const double x : {0.0, 50.0, 100.0}) {
    LayoutCorner corner;
    corner.p_px = {x, 0};
    map.corners.push_back(corner);
  }
  map.walls = {{0, 1, 8, 0.95, false}, {1, 2, 8, 0.5, false}};
  EXPECT_EQ(without_straight_corners(with_degrees(map)).walls.size(), 2U);
  EXPECT_TRUE(without_straight_corners(LayoutMap{}).walls.empty());
}

TEST(InkStrokes, OfAFrontEndAtItsWindows) {
  cv::Mat darkness = cv::Mat::zeros(400, 900, CV_8UC1);
  cv::rectangle(darkness, {50, 200, 800, 14}, cv::Scalar(255), cv::FILLED);
  for (const int x : {200, 450, 650}) {
    cv::rectangle(darkness, {x, 202, 90, 10}, cv::Scalar(0), cv::FILLED);
    cv::line(darkness, {x, 207}, {x + 90, 207}, cv::Scalar(255), 2);
  }
  int pieces = 0, line = -1;
  for (const auto& s : trace_strokes(darkness, LayoutParams{})) {
    if (s.thickness_px < 10) continue;
    EXPECT_LT(s.length(), 200) << "walls end where the window begins";
    EXPECT_GT(s.coverage, 0.8);
    pieces += 1;
    if (line < 0) line = s.line;
    EXPECT_EQ(s.line, line) << "all are pieces of one line";
  }
  EXPECT_EQ(pieces, 4);
}

}  // namespace
}  // namespace smokemap
