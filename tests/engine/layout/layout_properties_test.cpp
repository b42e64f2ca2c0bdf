// What must hold for every plan and every heap of strokes, not for one picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/random.hpp"
#include "layout/edit.hpp"
#include "layout/gaps.hpp"
#include "layout/layout_raster.hpp"
#include "layout/openings.hpp"
#include "layout/read_layout.hpp"
#include "layout/rooms.hpp"
#include "layout/wall_graph.hpp"
#include "layout/wall_strokes.hpp"
#include "simulation/plan_picture.hpp"
#include "simulation/random_building.hpp"
#include "tests/engine/layout/drawn_plan.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

constexpr double kPx = 8;  // thickness of the walls below

InkStroke random_stroke(std::mt19937_64& random, double extent) {
  InkStroke s;
  const Point2 a(uniform(random, 0, extent), uniform(random, 0, extent));
  // mostly along the axes, as in buildings, some oblique
  const double heading =
      uniform01(random) < 0.8 ? kPi / 2 * static_cast<double>(uniform_index(random, 4)) : uniform(random, -kPi, kPi);
  s.axis = {a, a + uniform(random, 15, 0.6 * extent) * Point2(std::cos(heading), std::sin(heading))};
  s.thickness_px = kPx * uniform(random, 0.7, 1.4);
  s.coverage = uniform(random, 0.6, 1), s.darkness = uniform(random, 0.6, 1);
  return s;
}

std::vector<InkStroke> random_strokes(std::uint64_t seed, std::size_t count) {
  auto random = random_stream(seed, 7);
  std::vector<InkStroke> strokes;
  for (std::size_t i = 0; i < count; ++i) strokes.push_back(random_stroke(random, 600));
  return strokes;
}

void expect_sound(const LayoutMap& map) {
  std::vector<int> degrees(map.corners.size(), 0);
  std::set<std::pair<int, int>> seen;
  for (const auto& w : map.walls) {
    ASSERT_GE(std::min(w.corner_a, w.corner_b), 0);
    ASSERT_LT(static_cast<std::size_t>(std::max(w.corner_a, w.corner_b)), map.corners.size());
    EXPECT_NE(w.corner_a, w.corner_b);
    EXPECT_TRUE(seen.insert(std::minmax(w.corner_a, w.corner_b)).second) << "the same wall twice";
    EXPECT_GE(w.confidence, 0);
    EXPECT_LE(w.confidence, 1);
    ++degrees[static_cast<std::size_t>(w.corner_a)], ++degrees[static_cast<std::size_t>(w.corner_b)];
  }
  for (std::size_t c = 0; c < map.corners.size(); ++c) {
    EXPECT_EQ(map.corners[c].degree, degrees[c]) << "corner " << c;
    EXPECT_TRUE(map.corners[c].p_px.allFinite());
  }
}

TEST(WallGraphProperty, AnyHeapOfStrokesMakesASoundGraphNearThem) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const auto strokes = random_strokes(seed, 4 + seed);
    const LayoutMap map = build_wall_graph(strokes, kPx, LayoutParams{});
    expect_sound(map);
    std::vector<Segment2> axes;
    for (const auto& s : strokes) axes.push_back(s.axis);
    const auto walls = testing::wall_segments(map);
    EXPECT_GT(testing::covered_by(axes, walls, 2.5 * kPx), 0.85) << "ink was lost";
    EXPECT_GT(testing::covered_by(walls, axes, 2.5 * kPx), 0.85) << "walls were made up";
  }
}

TEST(WallGraphProperty, DoesNotDependOnWhereThePlanStands) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    auto strokes = random_strokes(seed, 14);
    const LayoutMap here = build_wall_graph(strokes, kPx, LayoutParams{});
    const Point2 shift(1024, 512);
    for (auto& s : strokes) s.axis = {s.axis.a + shift, s.axis.b + shift};
    const LayoutMap there = build_wall_graph(strokes, kPx, LayoutParams{});
    auto carried = testing::wall_segments(there);
    for (auto& wall : carried) wall = {wall.a - shift, wall.b - shift};
    const auto walls = testing::wall_segments(here);
    EXPECT_GT(testing::covered_by(walls, carried, 1), 0.99);
    EXPECT_GT(testing::covered_by(carried, walls, 1), 0.99);
  }
}

TEST(WallGraphProperty, OfNoStrokesIsEmpty) { EXPECT_TRUE(build_wall_graph({}, kPx, LayoutParams{}).walls.empty()); }

TEST(OpeningsProperty, LieBetweenWallsAndNeverOnThem) {
  const cv::Mat bare = cv::Mat::zeros(1300, 1300, CV_8UC1);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    LayoutMap map = build_wall_graph(random_strokes(seed, 16), kPx, LayoutParams{});
    auto thin = random_strokes(seed + 100, 30);
    for (auto& s : thin) s.thickness_px = 1.5;
    close_gaps(map, thin, bare, kPx, LayoutParams{});
    expect_sound(map);
    const auto walls = testing::wall_segments(map);
    for (const auto& o : map.openings) {
      EXPECT_GT(o.gap_px.length(), 0);
      EXPECT_GT(o.confidence, 0);
      EXPECT_LE(o.confidence, 1);
      for (const Point2& end : {o.gap_px.a, o.gap_px.b}) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& w : walls) nearest = std::min(nearest, distance(w, end));
        EXPECT_LT(nearest, kPx) << "an opening that hangs in the air";
      }
    }
  }
}

TEST(RepairProperty, BelowOneGreatSignTheGraphStaysSound) {
  const cv::Mat bare = cv::Mat::zeros(1300, 1300, CV_8UC1), all = cv::Mat(1300, 1300, CV_8UC1, cv::Scalar(255));
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const LayoutMap before = build_wall_graph(random_strokes(seed, 12), kPx, LayoutParams{});
    LayoutMap uncovered = before, covered = before;
    repair_hidden(uncovered, bare, kPx, 60);
    EXPECT_LE(uncovered.walls.size(), before.walls.size() + loose_ends(before).size()) << "only short slips are joined";
    repair_hidden(covered, all, kPx, 60);
    expect_sound(covered);
    EXPECT_GE(covered.walls.size(), before.walls.size());
    EXPECT_LE(loose_ends(covered).size(), loose_ends(before).size());
  }
}

/// Rooms by flooding a picture of the walls, the slow and plain way.
int rooms_by_flood(const LayoutMap& map, cv::Size size) {
  cv::Mat ink = cv::Mat::zeros(size, CV_8UC1), labels, stats, centroids;
  const auto px = testing::detail::px;
  for (const auto& s : testing::wall_segments(map)) cv::line(ink, px(s.a), px(s.b), cv::Scalar(255), 3);
  for (const auto& o : map.openings) cv::line(ink, px(o.gap_px.a), px(o.gap_px.b), cv::Scalar(255), 3);
  const int count = cv::connectedComponentsWithStats(ink == 0, labels, stats, centroids, 4);
  const int outside = labels.at<int>(0, 0);
  int rooms = 0;
  for (int label = 1; label < count; ++label)
    rooms += label != outside && stats.at<int>(label, cv::CC_STAT_AREA) > 0.002 * size.area();
  return rooms;
}

TEST(RoomsProperty, AreThoseThatFloodingFinds) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    auto random = random_stream(seed, 3);
    LayoutMap map;  // a grid of rooms, some walls of which are left out
    const int columns = 3 + static_cast<int>(uniform_index(random, 3)),
              rows = 2 + static_cast<int>(uniform_index(random, 3));
    const auto at = [&](int x, int y) { return y * (columns + 1) + x; };
    for (int y = 0; y <= rows; ++y)
      for (int x = 0; x <= columns; ++x) {
        LayoutCorner corner;
        corner.p_px = Point2(100 + 140 * x, 100 + 120 * y);
        map.corners.push_back(corner);
      }
    for (int y = 0; y <= rows; ++y)
      for (int x = 0; x <= columns; ++x) {
        const bool rim_x = y == 0 || y == rows, rim_y = x == 0 || x == columns;
        if (x < columns && (rim_x || uniform01(random) < 0.7))
          map.walls.push_back({at(x, y), at(x + 1, y), kPx, 1, false});
        if (y < rows && (rim_y || uniform01(random) < 0.7))
          map.walls.push_back({at(x, y), at(x, y + 1), kPx, 1, false});
      }
    map = with_degrees(std::move(map));
    const auto rooms = find_rooms(map);
    EXPECT_EQ(static_cast<int>(rooms.size()), rooms_by_flood(map, {1000, 800}));
    double sum = 0;
    for (const auto& room : rooms) sum += std::abs(signed_area(room));
    EXPECT_NEAR(sum, 140.0 * columns * 120 * rows, 0.03 * 140 * columns * 120 * rows) << "together they fill the plan";
  }
}

/// A generated building as a sheet.
struct DrawnSheet {
  cv::Mat sheet;
  std::vector<Segment2> walls, openings;
};

DrawnSheet drawn_sheet(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto building = random_building({}, random);
  const auto plan = building ? distort(*building, {}, random) : Result<DistortedPlan>(building.error());
  PlanPictureParams params;
  params.width_px = 1600;
  const auto picture = plan ? draw_plan(plan->drawn, params, random) : Result<PlanPicture>(plan.error());
  if (!picture) return {};
  const auto truth = true_layout(*plan, *picture).layout;
  DrawnSheet drawn{picture->sheet, testing::wall_segments(truth), {}};
  for (const auto& opening : truth.openings) drawn.openings.push_back(opening.gap_px);
  return drawn;
}

/// One sheet and what is read of it, for all that compare with it.
struct ReadSheet {
  cv::Mat sheet = drawn_sheet(3).sheet;
  Result<LayoutReading> reading = read_layout(sheet);
};
const ReadSheet& read_sheet() {
  static const ReadSheet read;
  return read;
}

/// Share of walls that both readings have, the second carried back by `back`.
double agreement(const LayoutMap& one, const LayoutMap& two, const std::function<Point2(const Point2&)>& back) {
  std::vector<Segment2> carried;
  for (const auto& s : testing::wall_segments(two)) carried.push_back({back(s.a), back(s.b)});
  const auto first = testing::wall_segments(one);
  return std::min(testing::covered_by(first, carried, 5), testing::covered_by(carried, first, 5));
}

TEST(ReadLayoutProperty, AMirroredSheetHasTheMirroredWalls) {
  const auto& [sheet, one] = read_sheet();
  ASSERT_FALSE(sheet.empty());
  cv::Mat mirrored;
  cv::flip(sheet, mirrored, 1);
  const auto two = read_layout(mirrored);
  ASSERT_THAT(one, test::IsOk());
  ASSERT_THAT(two, test::IsOk());
  EXPECT_GT(agreement(one->layout, two->layout, [&](const Point2& p) { return Point2(sheet.cols - 1 - p.x(), p.y()); }),
            0.93);
}

TEST(ReadLayoutProperty, DarkerPaperAndPalerInkChangeLittle) {
  const auto& [sheet, one] = read_sheet();
  ASSERT_FALSE(sheet.empty());
  cv::Mat pale;
  sheet.convertTo(pale, -1, 0.6, 60);  // black becomes 60, white 213
  const auto two = read_layout(pale);
  ASSERT_THAT(one, test::IsOk());
  ASSERT_THAT(two, test::IsOk());
  EXPECT_GT(agreement(one->layout, two->layout, [](const Point2& p) { return p; }), 0.93);
}

TEST(ReadLayoutProperty, ThePlaceOnThePaperDoesNotMatter) {
  const auto& [sheet, one] = read_sheet();
  ASSERT_FALSE(sheet.empty());
  cv::Mat moved;
  cv::copyMakeBorder(sheet, moved, 70, 40, 90, 20, cv::BORDER_CONSTANT, cv::Scalar(255, 255, 255));
  const auto two = read_layout(moved);
  ASSERT_THAT(one, test::IsOk());
  ASSERT_THAT(two, test::IsOk());
  EXPECT_GT(agreement(one->layout, two->layout, [](const Point2& p) { return Point2(p - Point2(90, 70)); }), 0.93);
}

// The generated sheets whose title, frame or many partitions misled the reader: more than half of it was wrong.
TEST(ReadLayoutProperty, GrayCopiesOfGeneratedSheetsAreReadAsTheyWereDrawn) {
  for (const std::uint64_t seed : {6U, 8U}) {
    SCOPED_TRACE(seed);
    const auto drawn = drawn_sheet(seed);
    ASSERT_FALSE(drawn.sheet.empty());
    cv::Mat gray;
    cv::cvtColor(drawn.sheet, gray, cv::COLOR_BGR2GRAY);
    const auto reading = read_layout(gray);
    ASSERT_THAT(reading, test::IsOk());
    const auto walls = testing::wall_segments(reading->layout);
    EXPECT_GT(testing::covered_by(drawn.walls, walls, 5), 0.85);
    auto allowed = drawn.walls;
    allowed.insert(allowed.end(), drawn.openings.begin(), drawn.openings.end());
    EXPECT_GT(testing::covered_by(walls, allowed, 5), 0.85);
  }
}

TEST(ReadLayoutProperty, EverythingLiesInThePicture) {
  const auto& [sheet, reading] = read_sheet();
  ASSERT_THAT(reading, test::IsOk());
  const auto& map = reading->layout;
  const auto inside = [&](const Point2& p) {
    return p.x() > -2 && p.y() > -2 && p.x() < sheet.cols + 2 && p.y() < sheet.rows + 2;
  };
  expect_sound(map);
  for (const auto& c : map.corners) EXPECT_TRUE(inside(c.p_px));
  for (const auto& o : map.openings) EXPECT_TRUE(inside(o.gap_px.a) && inside(o.gap_px.b));
  for (const auto& room : map.rooms_px)
    for (const auto& p : room) EXPECT_TRUE(inside(p));
  for (const auto& s : map.signs) EXPECT_TRUE(inside(s.p_px) && s.confidence >= 0 && s.confidence <= 1);
  const auto free = layout_free_space(map);
  ASSERT_THAT(free, test::IsOk());
  EXPECT_EQ(free->size(), sheet.size());
}

TEST(LayoutParams, RefuseWhatMakesNoSense) {
  EXPECT_TRUE(LayoutParams{}.validate());
  const auto refuses = [](double LayoutParams::*field, double value) {
    LayoutParams params;
    params.*field = value;
    return !params.validate();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double LayoutParams::*field :
       {&LayoutParams::max_megapixels, &LayoutParams::work_long_side_px, &LayoutParams::min_long_side_px,
        &LayoutParams::background_share, &LayoutParams::ink_low, &LayoutParams::ink_high, &LayoutParams::solid_share,
        &LayoutParams::colour_chroma, &LayoutParams::min_wall_share, &LayoutParams::max_wall_share,
        &LayoutParams::thin_ratio, &LayoutParams::merge_angle_deg, &LayoutParams::snap_walls,
        &LayoutParams::max_opening_share, &LayoutParams::door_width_m, &LayoutParams::door_width_sigma}) {
    EXPECT_TRUE(refuses(field, -1));
    EXPECT_TRUE(refuses(field, nan));
    EXPECT_TRUE(refuses(field, 1e9));
  }
  EXPECT_TRUE(refuses(&LayoutParams::ink_high, 0.1)) << "lower than ink_low";
}

}  // namespace
}  // namespace smokemap
