#include "navigation/cost_map.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr int kOccupiedPercent = 60;
constexpr int kFreePercent = 40;
constexpr double kHalfGapM = 2.5;
constexpr int kSurePercent = 90;   // three echoes without a beam that went through
constexpr double kEchoesM = 0.15;  // echoes of one thing ...
constexpr int kEchoes = 3;         // ... are at least so many

/// Draws in cells: row = cell y.
class Canvas {
 public:
  explicit Canvas(const GridFrame& frame)
      : frame_(frame), mat_(frame.height_cells, frame.width_cells, CV_8UC1, cv::Scalar(0)) {}
  void line(const Segment2& segment, int value) {
    const Cell a = frame_.cell_of(segment.a), b = frame_.cell_of(segment.b);
    cv::line(mat_, {a.x, a.y}, {b.x, b.y}, cv::Scalar(value), 1, cv::LINE_8);
  }
  cv::Mat& mat() { return mat_; }
  bool at(Cell cell) const { return mat_.at<std::uint8_t>(cell.y, cell.x) != 0; }

 private:
  GridFrame frame_;
  cv::Mat mat_;
};

struct Bounds {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e18);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e18);
  void add(const Eigen::Vector2d& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  bool empty() const { return low.x() > high.x(); }
};

/// A solve that went wrong may leave walls without a place: they block nothing and bound nothing.
bool is_somewhere(const MergedWall& wall) { return wall.segment_map.a.allFinite() && wall.segment_map.b.allFinite(); }

Bounds bounds_of(const MergedMap& merged, const OccupancyGrid& sensed) {
  Bounds bounds;
  for (const MergedWall& wall : merged.walls)
    if (is_somewhere(wall)) bounds.add(wall.segment_map.a), bounds.add(wall.segment_map.b);
  const GridFrame& frame = sensed.frame();
  if (!sensed.empty()) {
    bounds.add(frame.origin);
    bounds.add(frame.origin + frame.resolution_m * Eigen::Vector2d(frame.width_cells, frame.height_cells));
  }
  return bounds;
}

std::vector<Segment2> openings_map(const MergedMap& merged, const LayoutMap& layout) {
  std::vector<Segment2> gaps;
  const PixelFrame frame = layout.frame();
  for (const LayoutOpening& opening : layout.openings)
    gaps.push_back({merged.layout_to_map(frame.to_metres(opening.gap_px.a)),
                    merged.layout_to_map(frame.to_metres(opening.gap_px.b))});
  return gaps;
}

cv::Mat hull_of_plan(const MergedMap& merged, const GridFrame& frame) {
  std::vector<cv::Point> points;
  for (const MergedWall& wall : merged.walls)
    if (wall.layout_wall && is_somewhere(wall))
      for (const Point2& p : {wall.segment_map.a, wall.segment_map.b}) {
        const Cell cell = frame.cell_of(p);
        points.emplace_back(cell.x, cell.y);
      }
  cv::Mat inside(frame.height_cells, frame.width_cells, CV_8UC1, cv::Scalar(0));
  if (points.size() < 3) return inside;
  std::vector<cv::Point> hull;
  cv::convexHull(points, hull);
  cv::fillConvexPoly(inside, hull, cv::Scalar(255));
  return inside;
}

/// Everything within `radius_cells` of what is set.
cv::Mat grown(const cv::Mat& set, double radius_cells) {
  cv::Mat cells;
  cv::distanceTransform(set == 0, cells, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return cells <= radius_cells;
}

/// Inside the building as drawn: what a flood from outside does not reach when gaps in the outer walls up to five
/// metres (exits, windows and walls that the reader missed) are thought closed; where that leaks too, the convex hull.
cv::Mat inside_of_plan(const MergedMap& merged, const LayoutMap& layout, const GridFrame& frame) {
  Canvas shell(frame);
  for (const MergedWall& wall : merged.walls)
    if (wall.layout_wall && is_somewhere(wall)) shell.line(wall.segment_map, 255);
  for (const Segment2& gap : openings_map(merged, layout)) shell.line(gap, 255);
  cv::Mat thick = grown(shell.mat(), kHalfGapM / frame.resolution_m);
  cv::floodFill(thick, {0, 0}, cv::Scalar(128));
  const cv::Mat inside = grown(thick == 128, kHalfGapM / frame.resolution_m) == 0;
  const cv::Mat hull = hull_of_plan(merged, frame);
  return cv::countNonZero(inside) * 2 >= cv::countNonZero(hull) ? inside : hull;
}

/// Smoke sends an echo here and there, and one in a doorway would close it: what was met once or twice, and nothing
/// beside it, closes no way. What really stands there is met again, and stops the robot before that.
bool is_lone_echo(const OccupancyGrid& sensed, const Cell& cell) {
  if (sensed.at(cell) >= kSurePercent) return false;
  const int reach = static_cast<int>(std::lround(kEchoesM / sensed.frame().resolution_m));
  int together = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Cell near{cell.x + dx, cell.y + dy};
      together += sensed.get(near) >= kOccupiedPercent;
    }
  return together < kEchoes;
}

void paint_sensed(const OccupancyGrid& sensed, const GridFrame& frame, std::vector<Ground>& ground) {
  const GridFrame& from = sensed.frame();
  Cell cell;
  for (cell.y = 0; cell.y < from.height_cells; ++cell.y)
    for (cell.x = 0; cell.x < from.width_cells; ++cell.x) {
      const std::int8_t percent = sensed.at(cell);
      if (percent < 0) continue;
      const Cell target = frame.cell_of(from.center_of(cell));
      if (!frame.contains(target)) continue;
      Ground& g = ground[frame.index(target)];
      if (percent >= kOccupiedPercent) {
        if (!is_lone_echo(sensed, cell)) g = Ground::kBlocked;
      } else if (percent <= kFreePercent && g != Ground::kBlocked) {
        g = Ground::kFree;
      }
    }
}

void paint_walls(const MergedMap& merged, const GridFrame& frame, std::vector<Ground>& ground) {
  Canvas walls(frame);
  for (const MergedWall& wall : merged.walls)
    if (wall.state != WallState::kMissing && is_somewhere(wall)) walls.line(wall.segment_map, 255);
  for (std::size_t i = 0; i < ground.size(); ++i)
    if (walls.mat().data[i] != 0 && ground[i] != Ground::kFree) ground[i] = Ground::kBlocked;
}

}  // namespace

Result<Ok> CostMapParams::validate() const {
  return ParamCheck("CostMapParams")
      .in_range("resolution_m", resolution_m, 0.02, 0.5)
      .positive("robot_radius_m", robot_radius_m)
      .positive("soft_clearance_m", soft_clearance_m)
      .in_range("planned_penalty", planned_penalty, 1, 100)
      .in_range("margin_m", margin_m, 0, 100)
      .result();
}

CostMap::CostMap(const GridFrame& frame, std::vector<Ground> ground, const CostMapParams& params)
    : frame_(frame), ground_(std::move(ground)), clearance_m_(ground_.size()), params_(params) {
  ENGINE_EXPECT(ground_.size() == frame.cell_count());
  cv::Mat open(frame.height_cells, frame.width_cells, CV_8UC1);
  for (std::size_t i = 0; i < ground_.size(); ++i) open.data[i] = ground_[i] == Ground::kBlocked ? 0 : 255;
  cv::Mat cells;
  cv::distanceTransform(open, cells, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto* distance = cells.ptr<float>();
  const auto most =
      static_cast<float>(std::hypot(frame.width_cells, frame.height_cells));  // without any wall: no limit
  for (std::size_t i = 0; i < ground_.size(); ++i)
    clearance_m_[i] = std::min(distance[i], most) * static_cast<float>(frame.resolution_m);
}

bool CostMap::drivable(Cell cell) const {
  const Ground g = ground(cell);
  return (g == Ground::kFree || g == Ground::kPlanned) && clearance_m(cell) >= params_.robot_radius_m;
}

CostMap CostMap::with_blocked(const std::vector<Point2>& places_map) const {
  std::vector<Ground> ground = ground_;
  for (const Point2& p : places_map)
    if (const Cell cell = frame_.cell_of(p); frame_.contains(cell)) ground[frame_.index(cell)] = Ground::kBlocked;
  return CostMap(frame_, std::move(ground), params_);
}

double CostMap::cost_per_metre(Cell cell) const {
  const double room = (clearance_m(cell) - params_.robot_radius_m) / params_.soft_clearance_m;
  const double tight = std::clamp(1 - room, 0.0, 1.0);
  return (1 + 3 * tight * tight) * (ground(cell) == Ground::kPlanned ? params_.planned_penalty : 1.0);
}

Result<CostMap> build_cost_map(const MergedMap& merged, const OccupancyGrid& sensed, const LayoutMap* layout,
                               const CostMapParams& params) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  const Bounds bounds = bounds_of(merged, sensed);
  if (bounds.empty()) return fail(Errc::kDegenerate, "neither a plan nor anything seen yet");
  if (!bounds.low.allFinite() || !bounds.high.allFinite() || (bounds.high - bounds.low).maxCoeff() > 2000)
    return fail(Errc::kTooLarge, "the map is over 2 km wide");
  const GridFrame frame = frame_around(bounds.low, bounds.high, params.resolution_m, params.margin_m);
  std::vector<Ground> ground(frame.cell_count(), Ground::kUnknown);
  if (layout && layout->scale) {
    const cv::Mat inside = inside_of_plan(merged, *layout, frame);
    for (std::size_t i = 0; i < ground.size(); ++i)
      if (inside.data[i] != 0) ground[i] = Ground::kPlanned;
  }
  paint_sensed(sensed, frame, ground);
  paint_walls(merged, frame, ground);
  return CostMap(frame, std::move(ground), params);
}

}  // namespace smokemap
