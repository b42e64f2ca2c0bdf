#include "layout/read_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stop_token>

#include "tests/engine/layout/drawn_plan.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using testing::covered_by;
using testing::draw_office;
using testing::wall_segments;

/// The plain office, read once for all tests that only look at it.
const Result<LayoutReading>& office_reading() {
  static const Result<LayoutReading> reading = read_layout(draw_office().picture);
  return reading;
}

int count_kind(const LayoutMap& map, OpeningKind kind) {
  return static_cast<int>(
      std::count_if(map.openings.begin(), map.openings.end(), [&](const LayoutOpening& o) { return o.kind == kind; }));
}

TEST(ReadLayout, FindsEveryWallOfACleanDrawingAndNothingElse) {
  const auto plan = draw_office();
  const auto& reading = office_reading();
  ASSERT_TRUE(reading.ok());
  const auto found = wall_segments(reading->layout);
  EXPECT_GT(covered_by(plan.walls, found, 6), 0.97);
  EXPECT_GT(covered_by(found, plan.walls, 6), 0.95);
}

TEST(ReadLayout, ClosesRoomsAtTheirDoors) {
  const auto plan = draw_office();
  const auto& reading = office_reading();
  ASSERT_TRUE(reading.ok());
  EXPECT_EQ(static_cast<int>(reading->layout.rooms_px.size()), plan.rooms);
  EXPECT_EQ(reading->layout.openings.size(), plan.doors.size());
  EXPECT_GE(count_kind(reading->layout, OpeningKind::kDoor), 4);
}

TEST(ReadLayout, KeepsTheGrayFrontOfBlackRooms) {
  cv::Mat picture(1000, 1300, CV_8UC3, cv::Scalar::all(245));
  const cv::Rect front(140, 140, 1020, 720);
  for (int column = 1; column < 6; ++column)
    cv::line(picture, {140 + 170 * column, 140}, {140 + 170 * column, 860}, cv::Scalar::all(15), 8);
  for (int row = 1; row < 4; ++row)
    cv::line(picture, {140, 140 + 180 * row}, {1160, 140 + 180 * row}, cv::Scalar::all(15), 8);
  cv::rectangle(picture, front, cv::Scalar::all(140), 16);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading.ok());
  const std::vector<Segment2> fronts{
      {{140, 140}, {1160, 140}}, {{1160, 140}, {1160, 860}}, {{1160, 860}, {140, 860}}, {{140, 860}, {140, 140}}};
  EXPECT_GT(covered_by(fronts, wall_segments(reading->layout), 6), 0.95);
  EXPECT_EQ(reading->layout.rooms_px.size(), 24U);
}

// Regression: of a flat with outer walls as thick as a 35th of the picture only the thinner half was read.
TEST(ReadLayout, FindsOuterWallsThickerThanUsual) {
  cv::Mat picture(1100, 1600, CV_8UC3, cv::Scalar(255, 255, 255));
  const std::vector<cv::Rect> solid = {{200, 200, 1200, 34}, {200, 200, 34, 600}, {1366, 200, 34, 600},
                                       {200, 756, 1200, 44}, {700, 200, 20, 600}, {1000, 200, 20, 600}};
  for (const auto& box : solid) cv::rectangle(picture, box, cv::Scalar(10, 10, 10), cv::FILLED);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading) << reading.error().message;
  const Segment2 thickest{Point2(230, 778), Point2(1370, 778)};
  EXPECT_GT(testing::covered_by({thickest}, testing::wall_segments(reading->layout), 6), 0.95);
  EXPECT_EQ(reading->layout.rooms_px.size(), 3U);
}

TEST(ReadLayout, IsSureOfNoWallWhereNoRoomCloses) {
  cv::Mat picture(900, 1200, CV_8UC3, cv::Scalar::all(245));
  for (const int y : {150, 400, 700})
    cv::line(picture, {120, y}, {1050, y}, cv::Scalar::all(20), 12);  // edges of sheets
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading.ok());
  ASSERT_FALSE(reading->layout.walls.empty());
  for (const LayoutWall& wall : reading->layout.walls) EXPECT_LT(wall.confidence, 0.5);
  for (const LayoutWall& wall : office_reading()->layout.walls) EXPECT_GT(wall.confidence, 0.5);
}

TEST(ReadLayout, GuessesTheScaleFromDoorsAndSaysSo) {
  const auto& reading = office_reading();
  ASSERT_TRUE(reading.ok());
  ASSERT_TRUE(reading->layout.scale.has_value());
  EXPECT_NEAR(reading->layout.scale->metres_per_pixel, 0.9 / 70, 0.25 * 0.9 / 70);
  EXPECT_FALSE(reading->layout.scale->by_person);
  EXPECT_GE(reading->layout.scale->relative_sigma, 0.1);
}

TEST(ReadLayout, TakesAGivenScaleForGranted) {
  LayoutOptions options;
  options.metres_per_pixel = 0.02;
  const auto reading = read_layout(draw_office(0.7).picture, options);
  ASSERT_TRUE(reading.ok());
  EXPECT_DOUBLE_EQ(reading->layout.scale->metres_per_pixel, 0.02);
  EXPECT_TRUE(reading->layout.scale->by_person);
}

TEST(ReadLayout, SeesTheSignInItsColour) {
  const auto& reading = office_reading();
  ASSERT_TRUE(reading.ok());
  ASSERT_EQ(reading->layout.signs.size(), 1U);
  EXPECT_EQ(reading->layout.signs.front().colour, "green");
  EXPECT_LT((reading->layout.signs.front().p_px - Point2(868, 518)).norm(), 3);
}

TEST(ReadLayout, TurnsItsAnswerWithThePicture) {
  const auto plan = draw_office();
  cv::Mat turned;
  cv::rotate(plan.picture, turned, cv::ROTATE_90_CLOCKWISE);
  const auto reading = read_layout(turned);
  ASSERT_TRUE(reading.ok());
  std::vector<Segment2> truth;
  const double height = plan.picture.rows - 1;
  for (const auto& w : plan.walls)
    truth.push_back({Point2(height - w.a.y(), w.a.x()), Point2(height - w.b.y(), w.b.x())});
  const auto found = wall_segments(reading->layout);
  EXPECT_GT(covered_by(truth, found, 6), 0.97);
  EXPECT_GT(covered_by(found, truth, 6), 0.95);
}

TEST(ReadLayout, KeepsObliqueWallsOblique) {
  const auto plan = draw_office();
  const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(800, 550), 17, 0.8);
  cv::Mat turned;
  cv::warpAffine(plan.picture, turned, turn, plan.picture.size(), cv::INTER_AREA, cv::BORDER_CONSTANT,
                 cv::Scalar(255, 255, 255));
  const auto reading = read_layout(turned);
  ASSERT_TRUE(reading.ok());
  std::vector<Segment2> truth;
  const auto map = [&](const Point2& p) {
    return Point2(turn.at<double>(0, 0) * p.x() + turn.at<double>(0, 1) * p.y() + turn.at<double>(0, 2),
                  turn.at<double>(1, 0) * p.x() + turn.at<double>(1, 1) * p.y() + turn.at<double>(1, 2));
  };
  for (const auto& w : plan.walls) truth.push_back({map(w.a), map(w.b)});
  EXPECT_GT(covered_by(truth, wall_segments(reading->layout), 6), 0.95);
}

TEST(ReadLayout, ReadsTheSamePlanAtHalfAndDoubleSize) {
  for (const double unit : {0.6, 1.4}) {
    const auto plan = draw_office(unit);
    const auto reading = read_layout(plan.picture);
    ASSERT_TRUE(reading.ok()) << unit;
    EXPECT_GT(covered_by(plan.walls, wall_segments(reading->layout), 6 * unit), 0.95) << unit;
    EXPECT_NEAR(static_cast<int>(reading->layout.rooms_px.size()), plan.rooms, 1) << unit;
  }
}

TEST(ReadLayout, ReadsHollowWallsAsOneWallEach) {
  // every wall as two thin lines: the drawing's outline with the walls' inside left white
  const auto plan = draw_office(1.0, false);
  cv::Mat gray, ink, core;
  cv::cvtColor(plan.picture, gray, cv::COLOR_BGR2GRAY);
  ink = gray < 128;
  cv::erode(ink, core, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  cv::Mat hollow(plan.picture.size(), CV_8UC3, cv::Scalar(255, 255, 255));
  hollow.setTo(cv::Scalar(0, 0, 0), ink & ~core);
  const auto reading = read_layout(hollow);
  ASSERT_TRUE(reading.ok());
  const auto found = wall_segments(reading->layout);
  EXPECT_GT(covered_by(plan.walls, found, 6), 0.9);
  double drawn = 0, read = 0;
  for (const auto& w : plan.walls) drawn += w.length();
  for (const auto& w : found) read += w.length();
  EXPECT_LT(read, 1.2 * drawn) << "both outlines of a wall were taken for walls";
}

TEST(ReadLayout, SeesThroughShadowsAndNoise) {
  auto plan = draw_office();
  cv::RNG noise(7);
  cv::Mat grain(plan.picture.size(), CV_16SC3);
  noise.fill(grain, cv::RNG::NORMAL, 0, 6);
  for (int y = 0; y < plan.picture.rows; ++y)
    for (int x = 0; x < plan.picture.cols; ++x)
      for (int c = 0; c < 3; ++c) {
        const double light = 0.45 + 0.5 * x / plan.picture.cols;
        auto& value = plan.picture.at<cv::Vec3b>(y, x)[c];
        value = cv::saturate_cast<uchar>(light * value + grain.at<cv::Vec3s>(y, x)[c]);
      }
  cv::GaussianBlur(plan.picture, plan.picture, {5, 5}, 1.0);
  const auto reading = read_layout(plan.picture);
  ASSERT_TRUE(reading.ok());
  const auto found = wall_segments(reading->layout);
  EXPECT_GT(covered_by(plan.walls, found, 6), 0.93);
  EXPECT_GT(covered_by(found, plan.walls, 6), 0.90);
}

/// Share of the ring's length on which some wall of like direction lies.
double share_of_ring_read(const LayoutMap& map, const Point2& centre, double radius) {
  int hit = 0;
  const int samples = 360;
  for (int i = 0; i < samples; ++i) {
    const double a = 2 * kPi * i / samples;
    const Point2 p = centre + radius * Point2(std::cos(a), std::sin(a));
    for (const auto& wall : wall_segments(map))
      if (distance(wall, p) < 6 && line_angle_between(wall.heading(), a + kPi / 2) < radians(16)) {
        ++hit;
        break;
      }
  }
  return static_cast<double>(hit) / samples;
}

TEST(ReadLayout, ReadsMostOfACurvedWallAsAChainOfShortOnes) {
  cv::Mat picture(1100, 1600, CV_8UC3, cv::Scalar(255, 255, 255));
  const cv::Scalar ink(20, 20, 20);
  cv::circle(picture, {800, 550}, 400, ink, 12, cv::LINE_AA);
  cv::line(picture, {400, 550}, {1200, 550}, ink, 8);
  cv::line(picture, {800, 150}, {800, 550}, ink, 8);
  const auto reading = read_layout(picture);
  ASSERT_TRUE(reading.ok());
  EXPECT_GT(share_of_ring_read(reading->layout, {800, 550}, 400), 0.65);
  EXPECT_GE(reading->layout.rooms_px.size(), 1U);
}

TEST(ReadLayout, TakesTheScaleFromABarBesideThePlan) {
  auto plan = draw_office(1.0);
  const int division = static_cast<int>(1 / (0.9 / 70));  // a metre, if doors have 0.9
  for (int i = 0; i < 4; ++i)
    cv::rectangle(plan.picture, cv::Rect(200 + i * division, 1000, division, 10), cv::Scalar(0, 0, 0),
                  i % 2 ? 1 : cv::FILLED);
  const auto reading = read_layout(plan.picture);
  ASSERT_TRUE(reading.ok() && reading->layout.scale.has_value());
  EXPECT_NEAR(reading->layout.scale->metres_per_pixel, 0.9 / 70, 0.03 * 0.9 / 70);
  EXPECT_LT(reading->layout.scale->relative_sigma, 0.2);
}

TEST(ReadLayout, SaysNoToPicturesWithoutWalls) {
  EXPECT_EQ(read_layout(cv::Mat()).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(read_layout(cv::Mat(1, 1, CV_8UC3, cv::Scalar(0, 0, 0))).error().code, Errc::kDegenerate);
  EXPECT_EQ(read_layout(cv::Mat(600, 800, CV_8UC3, cv::Scalar(255, 255, 255))).error().code, Errc::kDegenerate);
  EXPECT_EQ(read_layout(cv::Mat(600, 800, CV_8UC3, cv::Scalar(0, 0, 0))).error().code, Errc::kDegenerate);
  EXPECT_EQ(read_layout(cv::Mat(10, 10, CV_32FC1, cv::Scalar(0))).error().code, Errc::kInvalidArgument);
}

TEST(ReadLayout, NoiseGivesAnErrorOrWallsOfWhichItWarns) {
  cv::Mat picture(400, 500, CV_8UC3);
  cv::RNG(3).fill(picture, cv::RNG::UNIFORM, 0, 256);
  const auto reading = read_layout(picture);
  if (reading.ok()) {
    EXPECT_FALSE(reading->layout.warnings.empty());
  } else {
    EXPECT_EQ(reading.error().code, Errc::kDegenerate);
  }
}

// Regression: "much is doubtful, check every wall" stood beside 88 walls that were said to be sure, most of them lines
// of the ruled paper.
TEST(ReadLayout, IsSureOfNoWallWhereItSaysThatMuchIsDoubtful) {
  std::mt19937_64 random(5);
  cv::Mat crowded = testing::draw_office(0.75).picture;
  for (int i = 0; i < 120; ++i) {
    const cv::Point from(static_cast<int>(uniform(random, 0, crowded.cols)),
                         static_cast<int>(uniform(random, 0, crowded.rows)));
    const double heading = uniform(random, 0, kPi), length = uniform(random, 30, 80);
    cv::line(
        crowded, from,
        from + cv::Point(static_cast<int>(length * std::cos(heading)), static_cast<int>(length * std::sin(heading))),
        cv::Scalar(20, 20, 20), 6);
  }
  const auto reading = read_layout(crowded);
  ASSERT_THAT(reading, test::IsOk());
  const auto& said = reading->layout.warnings;
  ASSERT_TRUE(std::any_of(said.begin(), said.end(), [](const auto& w) { return w.starts_with("Much of what was"); }));
  for (const LayoutWall& wall : reading->layout.walls) EXPECT_LT(wall.confidence, 0.9);
}

TEST(ReadLayout, RefusesPicturesOverTheLimit) {
  LayoutParams params;
  params.max_megapixels = 0.5;
  EXPECT_EQ(read_layout(draw_office().picture, {}, params).error().code, Errc::kTooLarge);
}

TEST(ReadLayout, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  Progress progress;
  progress.stop = source.get_token();
  EXPECT_EQ(read_layout(draw_office().picture, {}, {}, progress).error().code, Errc::kCancelled);
}

TEST(ReadLayout, GivesTheSameBytesAtAnyThreadCount) {
  const auto plan = draw_office(0.8);
  cv::setNumThreads(1);
  const auto one = read_layout(plan.picture);
  cv::setNumThreads(4);
  const auto four = read_layout(plan.picture);
  ASSERT_TRUE(one.ok() && four.ok());
  ASSERT_EQ(one->layout.corners.size(), four->layout.corners.size());
  for (std::size_t i = 0; i < one->layout.corners.size(); ++i)
    EXPECT_EQ(one->layout.corners[i].p_px, four->layout.corners[i].p_px);
  ASSERT_EQ(one->layout.walls.size(), four->layout.walls.size());
  for (std::size_t i = 0; i < one->layout.walls.size(); ++i)
    EXPECT_EQ(one->layout.walls[i].confidence, four->layout.walls[i].confidence);
}

TEST(ReadLayout, ConfidencesAndDegreesAreWhatTheyClaim) {
  const auto& reading = office_reading();
  ASSERT_TRUE(reading.ok());
  std::vector<int> degree(reading->layout.corners.size(), 0);
  for (const auto& w : reading->layout.walls) {
    EXPECT_GE(w.confidence, 0);
    EXPECT_LE(w.confidence, 1);
    EXPECT_NE(w.corner_a, w.corner_b);
    ++degree[static_cast<std::size_t>(w.corner_a)], ++degree[static_cast<std::size_t>(w.corner_b)];
  }
  for (std::size_t i = 0; i < degree.size(); ++i) EXPECT_EQ(degree[i], reading->layout.corners[i].degree);
}

TEST(ReadLayout, GrayAndTransparentPicturesReadLikeTheirColours) {
  const auto plan = draw_office(0.8);
  cv::Mat gray, alpha;
  cv::cvtColor(plan.picture, gray, cv::COLOR_BGR2GRAY);
  cv::cvtColor(plan.picture, alpha, cv::COLOR_BGR2BGRA);
  for (const auto& picture : {gray, alpha}) {
    const auto reading = read_layout(picture);
    ASSERT_TRUE(reading.ok());
    EXPECT_GT(covered_by(plan.walls, wall_segments(reading->layout), 6), 0.95);
  }
}

}  // namespace
}  // namespace smokemap
