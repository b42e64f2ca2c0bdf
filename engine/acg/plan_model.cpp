#include "acg/plan_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kDefaultMetresPerPixel = 0.03;
constexpr double kDoorWidth_m = 0.9;
constexpr double kLargestGap_m = 2.5;

PlanEdge make_edge(const std::vector<Point2>& corners, int a, int b, double half_thickness) {
  const Point2 d = corners[static_cast<std::size_t>(b)] - corners[static_cast<std::size_t>(a)];
  return {a, b, d.norm(), std::atan2(d.y(), d.x()), half_thickness, d.norm() > 0.02};
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

/// Corners sorted along the axis; a new line begins where the spread of the current one would exceed the tolerance.
void find_lines(PlanModel& model, int axis, double tolerance_m) {
  const double heading = model.axis_rad + axis * kPi / 2;
  const Point2 direction(std::cos(heading), std::sin(heading));
  std::vector<double> at;
  for (const Point2& p : model.corners) at.push_back(direction.dot(p));
  std::vector<std::size_t> order(at.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return at[i] < at[j]; });
  auto& lines = model.lines[static_cast<std::size_t>(axis)];
  auto& line_of = model.line_of_corner[static_cast<std::size_t>(axis)];
  line_of.assign(at.size(), 0);
  double first = 0, sum = 0, last = 0;
  int members = 0;
  for (const std::size_t i : order) {
    const bool joins = members > 0 && at[i] - first <= tolerance_m && at[i] - last <= 0.5 * tolerance_m;
    if (!joins) {
      lines.push_back(at[i]);
      first = at[i];
      sum = 0;
      members = 0;
    }
    sum += at[i];
    ++members;
    last = at[i];
    lines.back() = sum / members;
    line_of[i] = static_cast<int>(lines.size()) - 1;
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
  for (const int axis : {0, 1}) find_lines(model, axis, 4 * params.sigma_corner_draw_m);
  find_gaps(model);
  return model;
}

}  // namespace smokemap
