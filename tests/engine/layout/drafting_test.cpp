// What draughtsmen draw for something else than walls: hatching, dimensions, ruled paper. Whole pages first, because
// there the wrong walls were said to be sure; then each rule by itself.
#include "layout/drafting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "layout/read_layout.hpp"
#include "simulation/plan_picture.hpp"
#include "simulation/random_building.hpp"
#include "tests/engine/layout/drawn_plan.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

struct DraftedReading {
  int sure = 0, wrong = 0;  ///< walls said >= 0.9, and those of them that lie on no wall
  double found = 0;         ///< of the walls' length
};

/// A generated building drawn with these habits and read.
DraftedReading read_drafted(PlanPictureParams params, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto building = random_building({}, random);
  const auto plan = building ? distort(*building, {}, random) : Result<DistortedPlan>(building.error());
  params.width_px = 1600;
  const auto picture = plan ? draw_plan(plan->drawn, params, random) : Result<PlanPicture>(plan.error());
  const auto reading = picture ? read_layout(picture->sheet) : Result<LayoutReading>(picture.error());
  EXPECT_THAT(reading, test::IsOk());
  if (!reading) return {};
  const LayoutMap truth = true_layout(*plan, *picture).layout, &read = reading->layout;
  auto walls = testing::wall_segments(truth);
  DraftedReading out;
  out.found = testing::covered_by(walls, testing::wall_segments(read), 6);
  for (const auto& opening : truth.openings) walls.push_back(opening.gap_px);
  for (std::size_t w = 0; w < read.walls.size(); ++w) {
    if (read.walls[w].confidence < 0.9) continue;
    out.sure += 1;
    out.wrong += testing::covered_by({read.wall_px(static_cast<int>(w))}, walls, 6) < 0.5;
  }
  return out;
}

PlanPictureParams hatched(double spacing) {
  PlanPictureParams params;
  params.wall_fill = WallFill::kHatched;
  params.hatch_spacing = spacing;
  return params;
}

// Regression: faces and lines of the hatching were a wall each; of those said to be sure a third was wrong.
TEST(DraftedPages, HatchedWallsAreOneWallEach) {
  for (const double spacing : {0.8, 0.35}) {
    SCOPED_TRACE(spacing);
    const auto read = read_drafted(hatched(spacing), 2);
    EXPECT_GT(read.found, 0.95);
    EXPECT_GT(read.sure, 60);
    EXPECT_LE(read.wrong, 0.03 * read.sure);
  }
}

/// Walls as single lines no thicker than dimensions and squares may be.
PlanPictureParams single_lines() {
  PlanPictureParams params;
  params.outer_wall_px = params.inner_wall_px = 5;
  params.doors = false;
  return params;
}

const DraftedReading& plain_reading() {
  static const DraftedReading reading = read_drafted(single_lines(), 1);
  return reading;
}

// Regression: dimension lines of plans whose walls are single lines were sure walls, and closed rooms outside.
TEST(DraftedPages, DimensionsAddHardlyASureWall) {
  auto params = single_lines();
  params.dimensions = true;
  const auto measured = read_drafted(params, 1);
  EXPECT_GT(measured.found, plain_reading().found - 0.03);
  EXPECT_LE(measured.wrong, plain_reading().wrong + 0.05 * measured.sure);
}

// Regression: of walls read on squared paper 98 of 100 were its squares.
TEST(DraftedPages, RuledPaperAddsHardlyASureWall) {
  auto params = single_lines();
  params.ruling = PaperRuling::kSquares;
  const auto squared = read_drafted(params, 1);
  EXPECT_GT(squared.found, plain_reading().found - 0.03);
  EXPECT_LE(squared.wrong, plain_reading().wrong + 0.05 * squared.sure);
}

InkStroke line_of(const Point2& a, const Point2& b, double thickness = 2) {
  InkStroke s;
  s.axis = {a, b};
  s.thickness_px = thickness;
  s.coverage = s.darkness = 1;
  return s;
}

/// Two faces from x = 0 to 900, 24 apart, with so many lines between, which lean by so much.
std::vector<InkStroke> faces_with_lines(int lines, double lean_px, double from_px = 30) {
  std::vector<InkStroke> strokes{line_of({0, 0}, {900, 0}), line_of({0, 24}, {900, 24})};
  for (int i = 0; i < lines; ++i) strokes.push_back(line_of({from_px + 28 * i, 23}, {from_px + 28 * i + lean_px, 1}));
  return strokes;
}

TEST(Hatching, IsABandBetweenItsFaces) {
  const auto bands = find_hatching(faces_with_lines(28, 22), 60);
  ASSERT_EQ(bands.size(), 1U);
  EXPECT_NEAR(bands[0].axis.a.y(), 12, 0.5);
  EXPECT_NEAR(bands[0].thickness_px, 26, 0.5);
  EXPECT_LT(bands[0].axis.a.x(), 30);
  EXPECT_GT(bands[0].axis.b.x(), 28 * 27);
  EXPECT_EQ(bands[0].lines, 28);
  EXPECT_NEAR(bands[0].cell_px, 28 / std::sqrt(2.0) - 2, 0.7);
}

TEST(Hatching, IsNeitherTreadsNorALoneBraceNorFurniture) {
  EXPECT_TRUE(find_hatching(faces_with_lines(28, 0), 60).empty()) << "treads run square to their stringers";
  EXPECT_TRUE(find_hatching(faces_with_lines(1, 22), 60).empty());
  EXPECT_TRUE(find_hatching(faces_with_lines(8, 22), 60).empty()) << "too little for a plan's walls";
  EXPECT_TRUE(find_hatching(faces_with_lines(28, 22), 20).empty()) << "wider than walls are";
  EXPECT_TRUE(find_hatching({}, 60).empty());
}

TEST(Hatching, OfOneLineMakesAPierWhereThePlanIsHatchedSo) {
  auto strokes = faces_with_lines(28, 22);
  for (const auto& s : {line_of({1200, 0}, {1240, 0}), line_of({1200, 24}, {1240, 24}), line_of({1208, 23}, {1230, 1})})
    strokes.push_back(s);
  const auto bands = find_hatching(strokes, 60);
  ASSERT_EQ(bands.size(), 2U);
  strokes.back() = line_of({1230, 23}, {1208, 1});
  EXPECT_EQ(find_hatching(strokes, 60).size(), 1U) << "it leans the other way";
}

TEST(Hatching, OfTwoWallsMeetsInTheirCorner) {
  auto strokes = faces_with_lines(31, 22);
  for (auto s : faces_with_lines(31, 22)) {  // the same turned upright, with its end 12 px beside the first one's
    s.axis = {{924 - s.axis.a.y(), 24 + s.axis.a.x()}, {924 - s.axis.b.y(), 24 + s.axis.b.x()}};
    strokes.push_back(s);
  }
  const auto bands = find_hatching(strokes, 60);
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_TRUE(intersection(bands[0].axis, bands[1].axis)) << "no square is left between them";
}

TEST(Hatching, FilledIsAsDarkAsTheDrawing) {
  cv::Mat darkness = cv::Mat::zeros(100, 950, CV_8UC1);
  for (const auto& s : faces_with_lines(28, 22))
    cv::line(darkness, testing::detail::px(s.axis.a + Point2(20, 40)), testing::detail::px(s.axis.b + Point2(20, 40)),
             cv::Scalar(200), 2);
  HatchedBand band{{{20, 52}, {800, 52}}, 26, 18, 28};
  const cv::Mat filled = with_bands_filled(darkness, {band});
  for (int x = 30; x < 780; x += 7) EXPECT_EQ(filled.at<uchar>(52, x), 200);
  EXPECT_EQ(filled.at<uchar>(20, 400), 0);
  EXPECT_EQ(cv::countNonZero(with_bands_filled(darkness, {}) != darkness), 0);
}

// Regression: of a photograph only the middle wall was found to be the plan, and nearly all of it was said to be sure.
TEST(Hatching, SaysHowMuchOfItWasReadAsWalls) {
  const std::vector<HatchedBand> bands{{{Point2(0, 0), Point2(300, 0)}, 20, 8, 30},
                                       {{Point2(0, 0), Point2(0, 100)}, 20, 8, 9}};
  InkStroke long_wall, thin_wall, elsewhere;
  long_wall.axis = {Point2(-5, 4), Point2(310, -3)};
  thin_wall.axis = {Point2(6, -10), Point2(6, 120)};
  elsewhere.axis = {Point2(0, 200), Point2(300, 200)};
  EXPECT_EQ(share_read(bands, {elsewhere}), 0);
  EXPECT_EQ(share_read(bands, {elsewhere, long_wall}), 0.75);
  EXPECT_EQ(share_read(bands, {thin_wall}), 0.25);
  EXPECT_EQ(share_read(bands, {thin_wall, long_wall}), 1);
  EXPECT_EQ(share_read({}, {elsewhere}), 1) << "nothing is hatched, nothing was missed";
}

TEST(Cells, AreFilledWhereLinesAreDenseAndNowhereElse) {
  cv::Mat darkness = cv::Mat::zeros(1000, 2200, CV_8UC1);
  for (int i = 0; i < 160; ++i)
    cv::line(darkness, {100 + 6 * i, 108}, {108 + 6 * i, 100}, cv::Scalar(255), 1, cv::LINE_4);
  cv::rectangle(darkness, cv::Rect(100, 100, 1010, 9), cv::Scalar(255), 1);
  cv::rectangle(darkness, cv::Rect(200, 300, 11, 11), cv::Scalar(255), 1);
  const cv::Mat filled = with_cells_filled(darkness, darkness > 0);
  EXPECT_GT(cv::mean(filled(cv::Rect(140, 101, 900, 5)))[0], 250);
  EXPECT_EQ(filled.at<uchar>(305, 205), 0) << "one small box is none";
  cv::Mat noise(1000, 1400, CV_8UC1);
  cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::blur(noise, noise, {3, 3});
  EXPECT_EQ(cv::countNonZero(with_cells_filled(noise, noise > 110) != noise), 0) << "drawn out every way";
}

/// A line with ticks at its ends between two walls, and what leads to a third place; drawn at `unit` = 1.
cv::Mat measured_room(double tick_px, bool ticks = true) {
  cv::Mat darkness = cv::Mat::zeros(900, 1400, CV_8UC1);
  const auto draw = [&](const Point2& a, const Point2& b, int width) {
    cv::line(darkness, testing::detail::px(a), testing::detail::px(b), cv::Scalar(230), width, cv::LINE_AA);
  };
  draw({300, 200}, {300, 700}, 3), draw({1000, 200}, {1000, 700}, 3);  // walls
  draw({292, 400}, {1008, 400}, 2);                                    // across the room
  draw({292, 800}, {1008, 800}, 2);                                    // outside
  draw({300, 720}, {300, 808}, 2), draw({1000, 720}, {1000, 808}, 2);
  if (ticks)
    for (const Point2& p : {Point2(300, 400), Point2(1000, 400), Point2(300, 800), Point2(1000, 800)})
      draw(p + Point2(-tick_px, tick_px), p + Point2(tick_px, -tick_px), 2);
  return darkness;
}

double left_of(const std::vector<InkStroke>& strokes, const Segment2& line) {
  std::vector<Segment2> axes;
  for (const auto& s : strokes) axes.push_back(s.axis);
  return testing::covered_by({line}, axes, 3);
}

TEST(Dimensions, GoWithTheirTicksAndLeadsAndLeaveTheWalls) {
  for (const double tick : {6.0, 9.0}) {
    SCOPED_TRACE(tick);
    const cv::Mat darkness = measured_room(tick);
    const auto kept = without_dimensions(trace_strokes(darkness, {}), ink_mask(darkness, {}));
    EXPECT_LT(left_of(kept, {{310, 400}, {990, 400}}), 0.05);
    EXPECT_LT(left_of(kept, {{310, 800}, {990, 800}}), 0.05);
    EXPECT_LT(left_of(kept, {{300, 725}, {300, 795}}), 0.05);
    EXPECT_GT(left_of(kept, {{300, 205}, {300, 695}}), 0.95) << "a wall that dimensions end at runs on beyond them";
    EXPECT_GT(left_of(kept, {{1000, 205}, {1000, 695}}), 0.95);
  }
}

// Regression: an arrow of the escape route over a dimension line made a wall of it.
TEST(Dimensions, GoWhereAnArrowHidesAPartOfThem) {
  cv::Mat darkness = measured_room(9), hidden = cv::Mat::zeros(darkness.size(), CV_8UC1);
  const cv::Rect arrow(600, 370, 40, 60);
  darkness(arrow).setTo(0), hidden(arrow).setTo(255);
  const auto strokes = trace_strokes(darkness, {});
  const cv::Mat ink = ink_mask(darkness, {});
  EXPECT_LT(left_of(without_dimensions(strokes, ink, hidden), {{310, 400}, {590, 400}}), 0.05);
  EXPECT_GT(left_of(without_dimensions(strokes, ink), {{310, 400}, {590, 400}}), 0.95) << "a gap that nothing hides";
}

TEST(Dimensions, WithoutTicksAreLines) {
  const cv::Mat darkness = measured_room(6, false);
  const auto all = trace_strokes(darkness, {});
  EXPECT_EQ(without_dimensions(all, ink_mask(darkness, {})).size(), all.size());
  EXPECT_TRUE(without_dimensions({}, ink_mask(darkness, {})).empty());
}

std::vector<InkStroke> ruled(int lines, double from_x, double to_x, double fan = 0) {
  std::vector<InkStroke> strokes;
  for (int i = 0; i < lines; ++i) {
    const double y = 50 + 60 * i;
    strokes.push_back(line_of({from_x, y}, {0.45 * (from_x + to_x), y + 0.45 * fan * i}));
    strokes.push_back(line_of({0.5 * (from_x + to_x), y + 0.5 * fan * i}, {to_x, y + fan * i}));
  }
  return strokes;
}

TEST(Ruling, GoesAndWhatIsDrawnOnItStays) {
  auto strokes = ruled(14, 5, 1195);
  const std::size_t paper = strokes.size();
  strokes.push_back(line_of({200, 110}, {700, 110}, 6));  // on a line of the paper
  strokes.push_back(line_of({200, 130}, {700, 130}));
  strokes.push_back(line_of({200, 110}, {200, 600}));
  const auto kept = without_ruling(strokes, {1200, 900});
  ASSERT_EQ(kept.size(), strokes.size() - paper);
  EXPECT_EQ(kept[0].thickness_px, 6);
}

TEST(Ruling, MayBeSeenAskew) { EXPECT_TRUE(without_ruling(ruled(14, 5, 1195, 3), {1200, 900}).empty()); }

// Regression: the walls of a row of like rooms were taken for ruled paper.
TEST(Ruling, IsNotABuildingWithEvenRooms) {
  auto rooms = ruled(9, 100, 1100);
  rooms.push_back(line_of({100, 50}, {100, 530}, 4));
  rooms.push_back(line_of({1100, 50}, {1100, 530}, 4));
  EXPECT_EQ(without_ruling(rooms, {1200, 900}).size(), rooms.size());
}

TEST(Ruling, NeedsManyEvenLongLines) {
  EXPECT_EQ(without_ruling(ruled(5, 5, 1195), {1200, 900}).size(), 10U);
  EXPECT_EQ(without_ruling(ruled(14, 400, 900), {1200, 900}).size(), 28U);
  std::vector<InkStroke> uneven;
  for (const double y : {50.0, 90.0, 200.0, 230.0, 400.0, 460.0, 700.0, 720.0, 860.0})
    uneven.push_back(line_of({5, y}, {1195, y}));
  EXPECT_EQ(without_ruling(uneven, {1200, 900}).size(), uneven.size());
}

}  // namespace
}  // namespace smokemap
