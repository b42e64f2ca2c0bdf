#include "acg/plan_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kDefaultMetresPerPixel = 0.03;
constexpr double kDoorWidth_m = 0.9;
constexpr double kLargestGap_m = 2.5;
constexpr double kInRow = 4;       ///< sigmas of the pen: ends of a wall along a line
constexpr double kSameLine = 2.0;  ///< sigmas of the pen

PlanEdge make_edge(const std::vector<Point2>& corners, int a, int b, double half_thickness) {
  const Point2 d = corners[static_cast<std::size_t>(b)] - corners[static_cast<std::size_t>(a)];
  return {a, b, d.norm(), std::atan2(d.y(), d.x()), half_thickness, d.norm() > 0.02, 1};
}

/// Without a scale: from the drawn doors, if there are enough of them.
void set_scale(const LayoutMap& plan, PlanModel& model) {
  if (plan.scale && plan.scale->metres_per_pixel > 0) {
    model.metres_per_pixel = plan.scale->metres_per_pixel;
    model.scale_sigma = plan.scale->relative_sigma > 0 ? plan.scale->relative_sigma : 0.05;
    return;
  }
  std::vector<double> doors;
  for (const LayoutOpening& o : plan.openings)
    if (o.kind == OpeningKind::kDoor && o.gap_px.length() > 1) doors.push_back(o.gap_px.length());
  model.metres_per_pixel = kDefaultMetresPerPixel;
  model.scale_sigma = 0.4;
  if (doors.size() >= 3) {
    std::nth_element(doors.begin(), doors.begin() + static_cast<std::ptrdiff_t>(doors.size() / 2), doors.end());
    model.metres_per_pixel = kDoorWidth_m / doors[doors.size() / 2];
    model.scale_sigma = 0.15;
  }
}

/// The direction, modulo 90 degrees, that most wall length follows.
double main_direction(const PlanModel& model) {
  double c = 0, s = 0;
  for (const PlanEdge& w : model.walls) {
    c += w.length_m * std::cos(4 * w.heading_rad);
    s += w.length_m * std::sin(4 * w.heading_rad);
  }
  return std::atan2(s, c) / 4;
}

/// Corners that walls and doors along one line join.
struct CornerRow {
  std::vector<std::size_t> corners;
  double sum = 0;
  double mean() const { return sum / static_cast<double>(corners.size()); }
  double mean_variance() const { return 1.0 / static_cast<double>(corners.size()); }
};

std::vector<CornerRow> corner_rows(const PlanModel& model, int axis, const std::vector<double>& at, double apart_m) {
  std::vector<std::size_t> root(at.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto* edges : {&model.walls, &model.gaps})
    for (const PlanEdge& e : *edges) {
      const auto a = static_cast<std::size_t>(e.corner_a), b = static_cast<std::size_t>(e.corner_b);
      if (e.usable && model.offset_axis(e) == axis && std::abs(at[a] - at[b]) < apart_m) root[find(a)] = find(b);
    }
  std::map<std::size_t, CornerRow> rows;
  for (std::size_t i = 0; i < at.size(); ++i) {
    CornerRow& row = rows[find(i)];
    row.corners.push_back(i);
    row.sum += at[i];
  }
  std::vector<CornerRow> out;
  for (auto& [first, row] : rows) out.push_back(std::move(row));
  std::stable_sort(out.begin(), out.end(), [](const CornerRow& a, const CornerRow& b) { return a.mean() < b.mean(); });
  return out;
}

/// Rows of corners side by side are one line where the pen alone could have set them apart. A free end, a door's jamb,
/// stands where it stands: beside a line it does not belong to it.
void find_lines(PlanModel& model, int axis, double sigma_draw_m) {
  const double heading = model.axis_rad + axis * kPi / 2;
  const Point2 direction(std::cos(heading), std::sin(heading));
  std::vector<double> at;
  for (const Point2& p : model.corners) at.push_back(direction.dot(p));
  auto& lines = model.lines[static_cast<std::size_t>(axis)];
  auto& line_of = model.line_of_corner[static_cast<std::size_t>(axis)];
  line_of.assign(at.size(), 0);
  std::vector<CornerRow> merged;
  for (CornerRow& row : corner_rows(model, axis, at, kInRow * sigma_draw_m)) {
    const bool free_end = row.corners.size() == 1 && model.degree[row.corners.front()] == 1;
    const auto same = [&](const CornerRow& line) {
      return std::abs(row.mean() - line.mean()) <
             kSameLine * sigma_draw_m * std::sqrt(row.mean_variance() + line.mean_variance());
    };
    auto line = free_end ? merged.end() : std::find_if(merged.begin(), merged.end(), same);
    if (line == merged.end()) {
      merged.push_back(std::move(row));
      continue;
    }
    line->sum += row.sum;
    line->corners.insert(line->corners.end(), row.corners.begin(), row.corners.end());
  }
  std::stable_sort(merged.begin(), merged.end(),
                   [](const CornerRow& a, const CornerRow& b) { return a.mean() < b.mean(); });
  for (const CornerRow& line : merged) {
    for (const std::size_t c : line.corners) line_of[c] = static_cast<int>(lines.size());
    lines.push_back(line.mean());
  }
}

/// A door: the nearest free end that continues a free end's wall.
void find_gaps(PlanModel& model) {
  std::map<int, const PlanEdge*> ends;
  for (const PlanEdge& w : model.walls) {
    if (!w.usable) continue;
    for (const int c : {w.corner_a, w.corner_b}) ends.emplace(c, &w);
  }
  for (const auto& [i, wall] : ends) {
    const int other = wall->corner_a == i ? wall->corner_b : wall->corner_a;
    const Point2 here = model.corners[static_cast<std::size_t>(i)];
    const Point2 away = (here - model.corners[static_cast<std::size_t>(other)]).normalized();
    if (model.degree[static_cast<std::size_t>(i)] != 1) continue;
    int best = -1;
    double best_m = kLargestGap_m;
    for (std::size_t j = 0; j < model.corners.size(); ++j) {
      const Point2 d = model.corners[j] - here;
      const double ahead = away.dot(d), aside = std::abs(away.x() * d.y() - away.y() * d.x());
      if (static_cast<int>(j) == i || model.degree[j] == 0 || ahead < 0.3 || ahead > best_m ||
          aside > 0.05 + 0.08 * ahead)
        continue;
      best = static_cast<int>(j);
      best_m = ahead;
    }
    if (best < 0) continue;
    const bool known = std::any_of(model.gaps.begin(), model.gaps.end(),
                                   [&](const PlanEdge& g) { return g.corner_a == best && g.corner_b == i; });
    if (!known) model.gaps.push_back(make_edge(model.corners, i, best, wall->half_thickness_m));
  }
}

/// From where to where an edge reaches along the axis that it follows.
std::pair<double, double> reach_m(const PlanModel& model, const PlanEdge& edge, int offset_axis) {
  const double heading = model.axis_rad + (1 - offset_axis) * kPi / 2;
  const Point2 along(std::cos(heading), std::sin(heading));
  return std::minmax({along.dot(model.corners[static_cast<std::size_t>(edge.corner_a)]),
                      along.dot(model.corners[static_cast<std::size_t>(edge.corner_b)])});
}

void count_abreast(PlanModel& model) {
  struct Edge {
    PlanEdge* edge;
    int axis;
    std::pair<double, double> reach;
  };
  std::vector<Edge> all;
  for (auto* edges : {&model.walls, &model.gaps})
    for (PlanEdge& e : *edges)
      if (const int axis = model.offset_axis(e); axis >= 0 && e.usable)
        all.push_back({&e, axis, reach_m(model, e, axis)});
  for (const Edge& e : all) {
    double shared = 0;
    for (const Edge& o : all)
      if (o.axis == e.axis)
        shared += std::max(0.0, std::min(e.reach.second, o.reach.second) - std::max(e.reach.first, o.reach.first));
    e.edge->abreast = std::max(1.0, shared / std::max(1e-6, e.reach.second - e.reach.first));
  }
}

}  // namespace

int PlanModel::offset_axis(const PlanEdge& wall) const {
  const double turn = line_angle_between(wall.heading_rad, axis_rad);
  if (turn < radians(15)) return 1;
  return turn > radians(75) ? 0 : -1;
}

Result<PlanModel> make_plan_model(const LayoutMap& plan, const AcgParams& params) {
  PlanModel model;
  set_scale(plan, model);
  const PixelFrame frame{plan.height_px, model.metres_per_pixel};
  for (const LayoutCorner& c : plan.corners) {
    if (!c.p_px.allFinite()) return fail(Errc::kInvalidArgument, "plan: a corner is not finite");
    model.corners.push_back(frame.to_metres(c.p_px));
  }
  model.degree.assign(model.corners.size(), 0);
  const int count = static_cast<int>(model.corners.size());
  for (const LayoutWall& w : plan.walls) {
    if (w.corner_a < 0 || w.corner_b < 0 || w.corner_a >= count || w.corner_b >= count)
      return fail(Errc::kInvalidArgument, "plan: a wall names a corner that is not there");
    const double thickness = std::clamp(w.thickness_px * model.metres_per_pixel, 0.02, 0.5);
    model.walls.push_back(make_edge(model.corners, w.corner_a, w.corner_b, thickness / 2));
    if (!model.walls.back().usable) continue;
    ++model.degree[static_cast<std::size_t>(w.corner_a)];
    ++model.degree[static_cast<std::size_t>(w.corner_b)];
  }
  if (std::none_of(model.walls.begin(), model.walls.end(), [](const PlanEdge& w) { return w.usable; }))
    return fail(Errc::kDegenerate, "the plan has no wall");
  model.axis_rad = main_direction(model);
  find_gaps(model);
  for (const int axis : {0, 1}) find_lines(model, axis, params.sigma_corner_draw_m);
  count_abreast(model);
  return model;
}

}  // namespace smokemap
