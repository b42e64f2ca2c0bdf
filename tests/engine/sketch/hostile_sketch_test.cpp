#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/random.hpp"
#include "sketch/clean_sketch.hpp"
#include "sketch/doors.hpp"
#include "sketch/figures.hpp"
#include "sketch/gaps.hpp"
#include "sketch/hatching.hpp"
#include "sketch/outside.hpp"
#include "sketch/pen.hpp"
#include "sketch/read_sketch_photo.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

Stroke stroke_through(std::vector<Point2> points) {
  Stroke stroke;
  stroke.points_px = std::move(points);
  return stroke;
}

SketchMap closed_house() {
  return {800,
          600,
          {stroke_through({Point2(100, 100), Point2(700, 100), Point2(700, 500), Point2(100, 500), Point2(100, 100)}),
           stroke_through({Point2(400, 100), Point2(400, 500)})}};
}

TEST(HostileSketch, StrokesWithoutLengthChangeNothing) {
  SketchMap sketch = closed_house();
  const auto before = clean_sketch(sketch);
  sketch.strokes.push_back(stroke_through({}));
  sketch.strokes.push_back(stroke_through({Point2(250, 300)}));
  sketch.strokes.push_back(stroke_through(std::vector<Point2>(40, Point2(550, 300))));
  const auto after = clean_sketch(sketch);
  ASSERT_THAT(before, test::IsOk());
  ASSERT_THAT(after, test::IsOk());
  EXPECT_LT(cv::countNonZero(before->free_space != after->free_space), 60);
  EXPECT_EQ(after->gaps.size(), before->gaps.size());
}

TEST(HostileSketch, PointsThatAreNoPlacesGetOneClearError) {
  for (const double bad : {kNotANumber, std::numeric_limits<double>::infinity(), -1e300, 1.1e6})
    for (const StrokeKind kind : {StrokeKind::kWall, StrokeKind::kDoor, StrokeKind::kNote}) {
      SketchMap sketch = closed_house();
      sketch.strokes.push_back(stroke_through({Point2(200, 200), Point2(bad, 300), Point2(300, bad)}));
      sketch.strokes.back().kind = kind;
      EXPECT_THAT(clean_sketch(sketch), test::Fails(Errc::kInvalidArgument)) << bad;
    }
}

TEST(HostileSketch, PointsFarOffTheSheetAreAnsweredAtOnce) {
  SketchMap sketch = closed_house();
  sketch.strokes.push_back(stroke_through({Point2(-9e5, -9e5), Point2(9e5, 9e5), Point2(9e5, -9e5)}));
  const auto clean = clean_sketch(sketch);
  if (clean.ok()) {
    EXPECT_EQ(clean->free_space.size(), cv::Size(800, 600));
  }
}

TEST(HostileSketch, OfNoStrokesHasNoGapsDoorsOrHatching) {
  const std::vector<Stroke> points{stroke_through({}), stroke_through({Point2(5, 5)}),
                                   stroke_through({Point2(5, 5), Point2(5, 5)})};
  for (const auto& strokes : {std::vector<Stroke>{}, points}) {
    EXPECT_TRUE(find_drawn_doors(strokes, 100).openings_px.empty());
    const HatchedStrokes hatched = find_hatched_strokes(strokes, 100);
    EXPECT_TRUE(hatched.areas.empty());
    EXPECT_EQ(hatched.is_hatching, std::vector<bool>(strokes.size(), false));
  }
  EXPECT_TRUE(find_gaps({}, 100, {}).empty());
}

TEST(HostileSketch, ClosedWallsPartInsideFromOutsideExactly) {
  auto random = random_stream(31, 0);
  for (int trial = 0; trial < 12; ++trial) {
    const auto at = [&](double low, double high) { return static_cast<int>(uniform(random, low, high)); };
    const cv::Rect house(at(20, 60), at(20, 50), at(200, 320), at(150, 230));
    cv::Mat shut = cv::Mat::zeros(300, 400, CV_8UC1);
    cv::rectangle(shut, house, cv::Scalar(255), 3);
    const int wall_x = house.x + at(50, house.width - 50), wall_y = house.y + at(40, house.height - 40);
    cv::line(shut, {wall_x, house.y}, {wall_x, house.y + house.height - 1}, cv::Scalar(255), 3);
    cv::line(shut, {house.x, wall_y}, {wall_x, wall_y}, cv::Scalar(255), 3);
    const Outline outline = find_outline(shut, std::max(house.width, house.height), {});
    EXPECT_TRUE(outline.openings_px.empty()) << trial;
    cv::Mat flooded = shut.clone();
    cv::floodFill(flooded, {0, 0}, cv::Scalar(100));
    EXPECT_EQ(cv::countNonZero((flooded == 100) & (outline.outside == 0)), 0) << trial;
    EXPECT_EQ(cv::countNonZero((flooded == 0) & (outline.outside != 0)), 0) << trial;
  }
}

TEST(HostileSketch, FiguresGoWholeOrStayWholeAndTheDrawingStays) {
  auto random = random_stream(32, 0);
  for (int trial = 0; trial < 20; ++trial) {
    cv::Mat mask = cv::Mat::zeros(300, 400, CV_8UC1);
    cv::rectangle(mask, cv::Rect(60, 60, 280, 180), cv::Scalar(255), 2);
    for (int i = 0; i < 25; ++i)
      mask(cv::Rect(static_cast<int>(uniform(random, 0, 360)), static_cast<int>(uniform(random, 0, 260)),
                    static_cast<int>(uniform(random, 1, 38)), static_cast<int>(uniform(random, 1, 38))))
          .setTo(255);
    cv::Mat labels;
    const int count = cv::connectedComponents(mask, labels, 8);
    const int drawing = labels.at<int>(60, 200);
    const auto check = [&](const std::function<void(cv::Mat&)>& drop) {
      cv::Mat left = mask.clone();
      drop(left);
      for (int label = 1; label < count; ++label) {
        const cv::Mat figure = labels == label;
        const int stays = cv::countNonZero(left & figure);
        EXPECT_TRUE(stays == 0 || stays == cv::countNonZero(figure)) << trial;
        EXPECT_TRUE(stays > 0 || label != drawing) << trial;
      }
      EXPECT_EQ(cv::countNonZero(left & (mask == 0)), 0);
    };
    check([](cv::Mat& m) { drop_small_figures(m, 8, 20); });
    check([](cv::Mat& m) { drop_rows_of_letters(m); });
    cv::Mat once = mask.clone(), mirrored;
    drop_rows_of_letters(once);
    cv::flip(mask, mirrored, -1);
    drop_rows_of_letters(mirrored);
    cv::flip(mirrored, mirrored, -1);
    EXPECT_EQ(cv::countNonZero(once != mirrored), 0) << trial;  // turned by half, rows are the same rows
  }
}

TEST(HostileSketch, APenIsNotSeenOnBlankPaperAndAFaintLineOnlyBesideAStrongOne) {
  cv::Mat paper(300, 400, CV_8UC3, cv::Scalar(240, 240, 240));
  EXPECT_EQ(cv::countNonZero(find_pen(divide_light(paper, 0.03)).mask), 0);
  cv::line(paper, {40, 60}, {200, 60}, cv::Scalar(20, 20, 20), 3);
  cv::line(paper, {200, 60}, {360, 60}, cv::Scalar(165, 165, 165), 3);  // the pen runs dry
  cv::line(paper, {40, 220}, {360, 220}, cv::Scalar(165, 165, 165), 3);
  const PenInk pen = find_pen(divide_light(paper, 0.03));
  EXPECT_EQ(pen.mask.at<uchar>(60, 100), 255);
  EXPECT_EQ(pen.mask.at<uchar>(60, 300), 255);
  EXPECT_EQ(pen.mask.at<uchar>(220, 200), 0);
}

TEST(SketchParams, RefuseWhatIsOutOfRangeOrOrderOrNoNumber) {
  const std::vector<std::function<void(SketchParams&)>> wrongs{
      [](auto& p) { p.close_gap_share = -0.01; },  [](auto& p) { p.report_gap_share = 0.5 * p.close_gap_share; },
      [](auto& p) { p.widest_gap_share = 0.1; },   [](auto& p) { p.join_share = kNotANumber; },
      [](auto& p) { p.max_sheet_megapixels = 0; }, [](auto& p) { p.min_wall_px = 0; }};
  EXPECT_THAT(SketchParams{}.validate(), test::IsOk());
  for (std::size_t i = 0; i < wrongs.size(); ++i) {
    SketchParams params;
    wrongs[i](params);
    EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument)) << i;
    EXPECT_THAT(clean_sketch(closed_house(), params), test::Fails(Errc::kInvalidArgument)) << i;
  }
}

TEST(SketchPhotoParams, RefuseWhatIsOutOfRange) {
  const std::vector<std::function<void(SketchPhotoParams&)>> wrongs{
      [](auto& p) { p.work_long_side_px = 10; }, [](auto& p) { p.background_share = 0; },
      [](auto& p) { p.min_stroke_share = -1; },  [](auto& p) { p.hair_share = kNotANumber; },
      [](auto& p) { p.text_share = 0.6; },       [](auto& p) { p.ruled_turn_deg = 0; },
      [](auto& p) { p.simplify_pens = 0; },      [](auto& p) { p.max_megapixels = 0; }};
  EXPECT_THAT(SketchPhotoParams{}.validate(), test::IsOk());
  for (std::size_t i = 0; i < wrongs.size(); ++i) {
    SketchPhotoParams params;
    wrongs[i](params);
    EXPECT_THAT(params.validate(), test::Fails(Errc::kInvalidArgument)) << i;
    EXPECT_THAT(read_sketch_photo(cv::Mat(50, 50, CV_8UC1, cv::Scalar(255)), params),
                test::Fails(Errc::kInvalidArgument))
        << i;
  }
}

}  // namespace
}  // namespace smokemap
