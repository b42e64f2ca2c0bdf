// Idea: people lift the pen too early, overshoot, and leave doors open. Every loose end of a wall stroke looks for what
// it was meant to meet. What is near is joined; what is a little further is an opening: it stays open, but counts as
// shut while the outside is flooded, so that a room with a door is still a room.
#include "sketch/clean_sketch.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace smokemap {
namespace {

cv::Point pixel(const Point2& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

void draw_line(cv::Mat& mask, const Segment2& s, int width, int value) {
  cv::line(mask, pixel(s.a), pixel(s.b), cv::Scalar(value), width);
}

/// Wall strokes of two points or more, in an order that does not depend on when they were drawn.
std::vector<const Stroke*> strokes_of(const SketchMap& sketch, StrokeKind kind) {
  std::vector<const Stroke*> strokes;
  for (const auto& s : sketch.strokes)
    if (s.kind == kind && !s.points_px.empty()) strokes.push_back(&s);
  const auto before = [](const Stroke* one, const Stroke* two) {
    return std::lexicographical_compare(
        one->points_px.begin(), one->points_px.end(), two->points_px.begin(), two->points_px.end(),
        [](const Point2& a, const Point2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  };
  std::stable_sort(strokes.begin(), strokes.end(), before);
  return strokes;
}

double extent_of(const std::vector<const Stroke*>& strokes) {
  Point2 low = strokes.front()->points_px.front(), high = low;
  for (const auto* s : strokes)
    for (const auto& p : s->points_px) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

struct End {
  std::size_t stroke = 0;
  bool last = false;
  Point2 p = Point2::Zero();
  Point2 outward = Point2::Zero();
};

/// Direction in which the pen was moving when it left: over the last few pens' width, so that a hook does not mislead.
Point2 tangent_at(const Stroke& stroke, bool last, double reach_px) {
  const auto& points = stroke.points_px;
  const Point2 end = last ? points.back() : points.front();
  const std::size_t n = points.size();
  for (std::size_t i = 1; i < n; ++i) {
    const Point2 d = end - points[last ? n - 1 - i : i];
    if (d.norm() >= reach_px || i + 1 == n) return d.norm() > 0 ? Point2(d.normalized()) : Point2(Point2::Zero());
  }
  return Point2::Zero();
}

struct Meeting {
  Point2 p = Point2::Zero();
  double gap = 0;
};

class GapFinder {
 public:
  GapFinder(std::vector<const Stroke*> walls, const SketchParams& params)
      : walls_(std::move(walls)), extent_(extent_of(walls_)), params_(params) {
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      if (walls_[i]->points_px.size() < 2) continue;
      for (const bool last : {false, true})
        ends_.push_back({i, last, last ? walls_[i]->points_px.back() : walls_[i]->points_px.front(),
                         tangent_at(*walls_[i], last, params.join_share * extent_)});
    }
  }
  double extent() const { return extent_; }

  std::vector<SketchGap> find() const {
    std::vector<SketchGap> gaps;
    for (const auto& end : ends_) {
      const auto near = nearest(end, params_.close_gap_share * extent_, -1.0);
      if (near && near->gap <= 1.5 * walls_[end.stroke]->width_px) continue;  // touches already
      if (near) {
        add(gaps, {{end.p, near->p}, true});
        continue;
      }
      if (const auto far = nearest(end, params_.report_gap_share * extent_, 0.5)) add(gaps, {{end.p, far->p}, false});
    }
    return gaps;
  }

 private:
  /// Nearest place of another stroke (or of its own, far along it) within reach, and within the cone ahead.
  std::optional<Meeting> nearest(const End& end, double reach, double min_cosine) const {
    std::optional<Meeting> best;
    const auto consider = [&](const Point2& p, double handicap) {
      const Point2 d = p - end.p;
      const double gap = d.norm();
      if (gap > reach || (gap > 1e-9 && d.dot(end.outward) < min_cosine * gap)) return;
      if (!best || gap * handicap < best->gap) best = Meeting{p, gap * handicap};
    };
    for (std::size_t j = 0; j < walls_.size(); ++j) {
      const auto& points = walls_[j]->points_px;
      double walked = 0;  // along its own stroke, from this end
      const std::size_t n = points.size();
      for (std::size_t k = 0; k + 1 < n; ++k) {
        const std::size_t i = end.last ? n - 2 - k : k;
        const Segment2 piece{points[i], points[i + 1]};
        walked += piece.length();
        if (j == end.stroke && walked < 3 * (piece.midpoint() - end.p).norm()) continue;  // still its own tail
        if (j == end.stroke && walked - piece.length() < 0.5 * reach) continue;
        consider(closest_point(piece, end.p), 1.0);
      }
      if (n == 1) consider(points.front(), 1.0);
    }
    for (const auto& other : ends_)
      if (other.stroke != end.stroke || other.last != end.last) {
        if (other.stroke == end.stroke && walls_[end.stroke]->points_px.size() < 4) continue;
        consider(other.p, 0.85);  // an end that faces an end is meant to meet it
      }
    if (best) best->gap = (best->p - end.p).norm();
    return best;
  }
  /// The same opening seen from both sides counts once.
  void add(std::vector<SketchGap>& gaps, const SketchGap& gap) const {
    const double same = 0.5 * gap.gap_px.length() + params_.join_share * extent_ * 0.5;
    const bool there = std::any_of(gaps.begin(), gaps.end(), [&](const SketchGap& g) {
      return (g.gap_px.midpoint() - gap.gap_px.midpoint()).norm() < 0.5 * same && g.closed_by_us == gap.closed_by_us;
    });
    if (!there) gaps.push_back(gap);
  }

  std::vector<const Stroke*> walls_;
  double extent_;
  const SketchParams& params_;
  std::vector<End> ends_;
};

/// Opens the walls at a door stroke: along it where it lies on a wall, for its own length where it crosses one.
SketchGap open_door(cv::Mat& walls, const Stroke& door, const std::vector<const Stroke*>& wall_strokes, int pen_px) {
  const Segment2 drawn{door.points_px.front(), door.points_px.back()};
  SketchGap gap{drawn, false};
  for (const auto* wall : wall_strokes)
    for (std::size_t i = 0; i + 1 < wall->points_px.size(); ++i) {
      const Segment2 piece{wall->points_px[i], wall->points_px[i + 1]};
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

/// Everything the border of the sheet reaches through openings wider than 2 * radius.
cv::Mat outside_of(const cv::Mat& shut, double radius) {
  cv::Mat padded, distance, open, reached;
  cv::copyMakeBorder(shut, padded, 2, 2, 2, 2, cv::BORDER_CONSTANT, cv::Scalar(0));
  const int margin = static_cast<int>(radius) + 2;  // a drawing that touches the sheet's edge still has an outside
  cv::copyMakeBorder(padded, padded, margin, margin, margin, margin, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(padded == 0, distance, cv::DIST_L2, cv::DIST_MASK_5);
  open = distance > radius;
  cv::floodFill(open, {0, 0}, cv::Scalar(128));
  cv::distanceTransform(open != 128, reached, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat outside = (reached <= radius) & (padded == 0);
  return cv::Mat(outside(cv::Rect(margin + 2, margin + 2, shut.cols, shut.rows))).clone();
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

}  // namespace

Result<CleanSketch> clean_sketch(const SketchMap& sketch, const SketchParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (const auto sheet = check_sheet(sketch, params); !sheet) return sheet.error();
  const auto walls = strokes_of(sketch, StrokeKind::kWall);
  if (walls.empty()) return fail(Errc::kDegenerate, "no wall is drawn yet");
  const GapFinder finder(walls, params);

  cv::Mat drawn = cv::Mat::zeros(sketch.height_px, sketch.width_px, CV_8UC1);
  int pen_px = params.min_wall_px;
  for (const auto* s : walls) {
    const int width = std::clamp(static_cast<int>(std::lround(s->width_px)), params.min_wall_px, 60);
    pen_px = std::max(pen_px, width);
    for (std::size_t i = 0; i + 1 < s->points_px.size(); ++i)
      draw_line(drawn, {s->points_px[i], s->points_px[i + 1]}, width, 255);
  }
  CleanSketch clean;
  clean.gaps = finder.find();
  for (const auto& g : clean.gaps)
    if (g.closed_by_us) draw_line(drawn, g.gap_px, params.min_wall_px, 255);
  cv::Mat shut = drawn.clone();  // before doors are opened
  for (const auto* door : strokes_of(sketch, StrokeKind::kDoor)) {
    const SketchGap opened = open_door(drawn, *door, walls, pen_px);
    std::erase_if(clean.gaps, [&](const SketchGap& g) {
      return (g.gap_px.midpoint() - opened.gap_px.midpoint()).norm() < 0.5 * opened.gap_px.length() + pen_px;
    });
    clean.gaps.push_back(opened);
  }
  for (const auto& g : clean.gaps) draw_line(shut, g.gap_px, params.min_wall_px, 255);

  const double least = std::max(9.0, 0.002 * finder.extent() * finder.extent());
  double radius = 0.5 * params.close_gap_share * finder.extent();
  const cv::Mat inside = (shut == 0) & (outside_of(shut, radius) == 0);
  const double wide = 0.5 * params.report_gap_share * finder.extent();
  const cv::Mat inside_wide = (shut == 0) & (outside_of(shut, wide) == 0);
  if (cv::countNonZero(inside_wide) < least)
    return fail(Errc::kDegenerate, "no closed room: walls do not meet anywhere");
  if (cv::countNonZero(inside_wide) >
      1.5 * cv::countNonZero(inside)) {  // most of the building would run out through one gap
    radius = wide;
    clean.warnings.push_back("The outline has wide gaps; where it ends is a guess.");
  }
  // Openings are free on the inside, and where they lie between two rooms.
  clean.free_space = (drawn == 0) & (outside_of(shut, radius) == 0);
  fill_slivers(clean.free_space, 0.5 * least);
  const auto open =
      std::count_if(clean.gaps.begin(), clean.gaps.end(), [](const SketchGap& g) { return !g.closed_by_us; });
  if (open > 0)
    clean.warnings.push_back(std::to_string(open) + (open == 1 ? " gap is left open: a door, or close it."
                                                               : " gaps are left open: doors, or close them."));
  return clean;
}

}  // namespace smokemap
