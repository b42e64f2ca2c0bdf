// Idea: what was meant to be joined is joined, what was meant as a door is opened, and every opening counts as shut
// while the outside is flooded, so that a room with a door is still a room.
#include "sketch/clean_sketch.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "sketch/doors.hpp"
#include "sketch/gaps.hpp"
#include "sketch/hatching.hpp"
#include "sketch/outside.hpp"

namespace smokemap {
namespace {

constexpr int kWidestPen_px = 60;

cv::Point pixel(const Point2& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

void draw_line(cv::Mat& mask, const Segment2& s, int width, int value) {
  cv::line(mask, pixel(s.a), pixel(s.b), cv::Scalar(value), width);
}

/// Strokes of a kind, in an order that does not depend on when they were drawn.
std::vector<Stroke> strokes_of(const SketchMap& sketch, StrokeKind kind) {
  std::vector<Stroke> strokes;
  for (const auto& s : sketch.strokes)
    if (s.kind == kind && !s.points_px.empty()) strokes.push_back(s);
  const auto before = [](const Stroke& one, const Stroke& two) {
    return std::lexicographical_compare(
        one.points_px.begin(), one.points_px.end(), two.points_px.begin(), two.points_px.end(),
        [](const Point2& a, const Point2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  };
  std::stable_sort(strokes.begin(), strokes.end(), before);
  return strokes;
}

double extent_of(const std::vector<Stroke>& strokes) {
  Point2 low = strokes.front().points_px.front(), high = low;
  for (const auto& s : strokes)
    for (const auto& p : s.points_px) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

double extent_of_sheet(const SketchMap& sketch) {
  const auto walls = strokes_of(sketch, StrokeKind::kWall);
  return walls.empty() ? 0 : extent_of(walls);
}

/// Opens the walls at a door stroke: along it where it lies on a wall, for its own length where it crosses one.
SketchGap open_door(cv::Mat& walls, const Stroke& door, const std::vector<Stroke>& wall_strokes, int pen_px) {
  const Segment2 drawn{door.points_px.front(), door.points_px.back()};
  SketchGap gap{drawn, false};
  for (const auto& wall : wall_strokes)
    for (std::size_t i = 0; i + 1 < wall.points_px.size(); ++i) {
      const Segment2 piece{wall.points_px[i], wall.points_px[i + 1]};
      const auto crossing = intersection(drawn, piece);
      if (!crossing || line_angle_between(drawn.heading(), piece.heading()) < radians(40)) continue;
      const Point2 half = 0.5 * std::max(drawn.length(), 3.0 * pen_px) * piece.direction();
      gap.gap_px = {*crossing - half, *crossing + half};
    }
  for (std::size_t i = 0; i + 1 < door.points_px.size(); ++i)
    draw_line(walls, {door.points_px[i], door.points_px[i + 1]}, 2 * pen_px + 1, 0);
  draw_line(walls, gap.gap_px, 2 * pen_px + 1, 0);
  return gap;
}

/// Between lines that were drawn twice there is no room.
void fill_slivers(cv::Mat& free, double least_area) {
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(free, labels, stats, centroids, 4);
  for (int y = 0; y < free.rows; ++y)
    for (int x = 0; x < free.cols; ++x)
      if (const int label = labels.at<int>(y, x);
          label > 0 && label < count && stats.at<int>(label, cv::CC_STAT_AREA) < least_area)
        free.at<uchar>(y, x) = 0;
}

/// Hatched areas are filled, and so is what hatching covers mostly: nobody draws up to the very edge.
void fill_hatched(const std::vector<Hatching>& areas, cv::Mat& free) {
  if (areas.empty()) return;
  cv::Mat hatched = cv::Mat::zeros(free.size(), CV_8UC1), labels;
  for (const Hatching& area : areas) {
    std::vector<cv::Point> ring;
    for (const Point2& p : area.outline_px) ring.push_back(pixel(p));
    cv::fillConvexPoly(hatched, ring, cv::Scalar(255));
  }
  const int count = cv::connectedComponents(free, labels, 4);
  std::vector<int> all(static_cast<std::size_t>(count), 0), covered = all;
  for (int y = 0; y < free.rows; ++y)
    for (int x = 0; x < free.cols; ++x) {
      const auto label = static_cast<std::size_t>(labels.at<int>(y, x));
      ++all[label];
      covered[label] += hatched.at<uchar>(y, x) != 0;
    }
  for (int y = 0; y < free.rows; ++y)
    for (int x = 0; x < free.cols; ++x) {
      const auto label = static_cast<std::size_t>(labels.at<int>(y, x));
      if (hatched.at<uchar>(y, x) || 2 * covered[label] > all[label]) free.at<uchar>(y, x) = 0;
    }
}

Result<Ok> check_sheet(const SketchMap& sketch, const SketchParams& params) {
  if (sketch.width_px < 1 || sketch.height_px < 1)
    return fail(Errc::kInvalidArgument, "the sheet of the sketch has no size");
  if (1e-6 * sketch.width_px * static_cast<double>(sketch.height_px) > params.max_sheet_megapixels)
    return fail(Errc::kTooLarge, "the sheet of the sketch is too large");
  for (const auto& s : sketch.strokes)
    for (const auto& p : s.points_px)
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > 1e6)
        return fail(Errc::kInvalidArgument, "a point of a stroke is not a number");
  return Ok{};
}

/// The walls as drawn, and the same with all openings shut.
struct Drawing {
  cv::Mat open, shut;
  int pen_px = 1;
};

Drawing draw_walls(const SketchMap& sketch, const std::vector<Stroke>& walls, const SketchParams& params) {
  Drawing drawing;
  drawing.open = cv::Mat::zeros(sketch.height_px, sketch.width_px, CV_8UC1);
  drawing.pen_px = params.min_wall_px;
  for (const auto& s : walls) {
    const int width = std::clamp(static_cast<int>(std::lround(s.width_px)), params.min_wall_px, kWidestPen_px);
    drawing.pen_px = std::max(drawing.pen_px, width);
    for (std::size_t i = 0; i + 1 < s.points_px.size(); ++i)
      draw_line(drawing.open, {s.points_px[i], s.points_px[i + 1]}, width, 255);
  }
  return drawing;
}

/// Opens doors and closes slips of the pen; what is open and what is shut is told apart.
void open_and_close(const SketchMap& sketch, const std::vector<Stroke>& walls, const std::vector<Segment2>& drawn_doors,
                    const SketchParams& params, Drawing& drawing, std::vector<SketchGap>& gaps) {
  for (const auto& g : gaps)
    if (g.closed_by_us) draw_line(drawing.open, g.gap_px, params.min_wall_px, 255);
  drawing.shut = drawing.open.clone();
  std::vector<SketchGap> doors;
  for (const auto& door : strokes_of(sketch, StrokeKind::kDoor))
    doors.push_back(open_door(drawing.open, door, walls, drawing.pen_px));
  for (const auto& opening : drawn_doors) {
    const Point2 margin = std::min(0.2 * opening.length(), 1.5 * drawing.pen_px) * opening.direction();
    draw_line(drawing.open, {opening.a + margin, opening.b - margin}, 2 * drawing.pen_px + 1, 0);
    doors.push_back({opening, false});
  }
  for (const auto& door : doors) {
    std::erase_if(gaps, [&](const SketchGap& g) {
      return (g.gap_px.midpoint() - door.gap_px.midpoint()).norm() < 0.5 * door.gap_px.length() + drawing.pen_px;
    });
    gaps.push_back(door);
  }
  for (const auto& g : gaps) draw_line(drawing.shut, g.gap_px, params.min_wall_px, 255);
}

}  // namespace

Result<CleanSketch> clean_sketch(const SketchMap& sketch, const SketchParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (const auto sheet = check_sheet(sketch, params); !sheet) return sheet.error();
  const HatchedStrokes hatching = find_hatched_strokes(sketch.strokes, extent_of_sheet(sketch));
  SketchMap drawn = sketch;
  for (std::size_t i = 0; i < drawn.strokes.size(); ++i)
    if (hatching.is_hatching[i]) drawn.strokes[i].kind = StrokeKind::kNote;
  const auto strokes = strokes_of(drawn, StrokeKind::kWall);
  if (strokes.empty()) return fail(Errc::kDegenerate, "no wall is drawn yet");
  const double extent = extent_of(strokes);

  CleanSketch clean;
  DrawnDoors doors = find_drawn_doors(strokes, extent);
  clean.gaps = find_gaps(doors.walls, extent, params);
  clean.marks = std::move(doors.marks);
  Drawing drawing = draw_walls(sketch, doors.walls, params);
  open_and_close(sketch, doors.walls, doors.openings_px, params, drawing, clean.gaps);

  const Outline outline = find_outline(drawing.shut, extent, params);
  for (const auto& opening : outline.openings_px) clean.gaps.push_back({opening, false});
  if (!outline.openings_px.empty()) clean.warnings.push_back("The outline has wide gaps; where it ends is a guess.");
  const double least = std::max(9.0, 0.002 * extent * extent);
  if (cv::countNonZero((drawing.shut == 0) & (outline.outside == 0)) < least)
    return fail(Errc::kDegenerate, "no closed room: walls do not meet anywhere");
  // Openings are free on the inside, and where they lie between two rooms.
  clean.free_space = (drawing.open == 0) & (outline.outside == 0);
  fill_hatched(hatching.areas, clean.free_space);
  fill_slivers(clean.free_space, 0.5 * least);
  const auto open =
      std::count_if(clean.gaps.begin(), clean.gaps.end(), [](const SketchGap& g) { return !g.closed_by_us; });
  if (open > 0)
    clean.warnings.push_back(std::to_string(open) + (open == 1 ? " gap is left open: a door, or close it."
                                                               : " gaps are left open: doors, or close them."));
  return clean;
}

}  // namespace smokemap
