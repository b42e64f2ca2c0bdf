#include "simulation/plan_distortion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/check.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

double piecewise(const std::vector<double>& from, const std::vector<double>& to, double value) {
  if (from.size() < 2) return value;
  const auto upper = std::upper_bound(from.begin() + 1, from.end() - 1, value);
  const auto i = static_cast<std::size_t>(upper - from.begin());
  return to[i - 1] + (value - from[i - 1]) * (to[i] - to[i - 1]) / (from[i] - from[i - 1]);
}

/// Knots from a random phase below `low` to beyond `high`. Drawn again until the spread of the factors is what was
/// asked for within a fifth: few intervals would otherwise often give a plan without error.
PlanWarp::Axis random_axis(double low, double high, const PlanDistortionParams& params, std::mt19937_64& random) {
  PlanWarp::Axis axis;
  axis.knots.push_back(low - uniform(random, 0, params.knot_spacing_m));
  while (axis.knots.back() < high) axis.knots.push_back(axis.knots.back() + params.knot_spacing_m);
  std::vector<double> factors(axis.knots.size() - 1);
  const double sigma = params.sigma_stretch, cut = params.stretch_cut_sigmas * sigma;
  for (int attempt = 0; attempt < 200; ++attempt) {
    double squares = 0;
    for (double& factor : factors) {
      const double off = std::clamp(normal(random, sigma), -cut, cut);
      factor = std::max(1 + off, 0.2);
      squares += off * off;
    }
    const double spread = std::sqrt(squares / static_cast<double>(factors.size()));
    if (spread >= 0.8 * sigma && spread <= 1.2 * sigma) break;
  }
  axis.drawn.push_back(axis.knots.front());
  for (const double factor : factors) axis.drawn.push_back(axis.drawn.back() + factor * params.knot_spacing_m);
  return axis;
}

/// A plan while its walls are split and taken out. Every wall knows which true wall it came from.
class PlanEditor {
 public:
  explicit PlanEditor(const FloorPlan& building) : plan(building), source(building.walls.size()) {
    for (std::size_t i = 0; i < source.size(); ++i) source[i] = static_cast<int>(i);
  }

  /// Cuts the wall at a share of its length; the new corner. Nothing if a door or window is in the way.
  std::optional<int> split(int wall, double share) {
    const PlanWall old = plan.walls[static_cast<std::size_t>(wall)];
    const double margin = 0.2 / std::max(plan.wall_line(wall).length(), 1e-9);
    const auto blocks = [&](const auto& gap) {
      return gap.wall == wall && gap.from < share + margin && gap.to > share - margin;
    };
    if (share < 2 * margin || share > 1 - 2 * margin || std::any_of(plan.doors.begin(), plan.doors.end(), blocks))
      return {};
    std::erase_if(plan.windows, blocks);
    const Segment2 line = plan.wall_line(wall);
    const auto corner = static_cast<int>(plan.corners.size());
    const auto second = static_cast<int>(plan.walls.size());
    plan.corners.push_back(line.a + share * (line.b - line.a));
    plan.walls[static_cast<std::size_t>(wall)].corner_b = corner;
    plan.walls.push_back(old);
    plan.walls.back().corner_a = corner;
    source.push_back(source[static_cast<std::size_t>(wall)]);
    const auto reassign = [&](auto& gap) {
      if (gap.wall != wall) return;
      const bool beyond = gap.from > share;
      const double base = beyond ? share : 0, length = beyond ? 1 - share : share;
      gap.from = (gap.from - base) / length;
      gap.to = (gap.to - base) / length;
      if (beyond) gap.wall = second;
    };
    for (PlanDoor& door : plan.doors) reassign(door);
    for (PlanWindow& window : plan.windows) reassign(window);
    for (PlanRoom& room : plan.rooms) insert_corner(room.ring, old.corner_a, old.corner_b, corner);
    return corner;
  }

  /// A wall between two corners of the room's ring makes two rooms of it.
  void divide(int room, int p, int q) {
    std::vector<int>& ring = plan.rooms[static_cast<std::size_t>(room)].ring;
    std::rotate(ring.begin(), std::find(ring.begin(), ring.end(), p), ring.end());
    const auto far = std::find(ring.begin(), ring.end(), q);
    PlanRoom second{plan.rooms[static_cast<std::size_t>(room)].name + "a", {far, ring.end()}, false};
    second.ring.push_back(p);
    ring.erase(far + 1, ring.end());
    plan.rooms.push_back(std::move(second));
  }

  /// Takes a wall out; the rooms on its sides become one.
  void remove(int wall) {
    const auto w = static_cast<std::size_t>(wall);
    join_rooms(wall);
    plan.walls.erase(plan.walls.begin() + wall);
    source.erase(source.begin() + static_cast<std::ptrdiff_t>(w));
    const auto gone = [&](const auto& gap) { return gap.wall == wall; };
    std::erase_if(plan.doors, gone);
    std::erase_if(plan.windows, gone);
    for (PlanDoor& door : plan.doors) door.wall -= door.wall > wall;
    for (PlanWindow& window : plan.windows) window.wall -= window.wall > wall;
  }

  FloorPlan plan;
  std::vector<int> source;

 private:
  void join_rooms(int wall) {
    const auto [left, right] = plan.rooms_beside(wall);
    if (left < 0 || right < 0 || left == right) return;
    std::vector<int>& one = plan.rooms[static_cast<std::size_t>(left)].ring;
    std::vector<int>& other = plan.rooms[static_cast<std::size_t>(right)].ring;
    const PlanWall& w = plan.walls[static_cast<std::size_t>(wall)];  // `one` runs a -> b, `other` b -> a
    std::rotate(one.begin(), std::find(one.begin(), one.end(), w.corner_b), one.end());
    std::rotate(other.begin(), std::find(other.begin(), other.end(), w.corner_a), other.end());
    one.insert(one.end(), other.begin() + 1, other.end() - 1);
    plan.rooms.erase(plan.rooms.begin() + right);
  }

  static void insert_corner(std::vector<int>& ring, int a, int b, int corner) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int here = ring[k], next = ring[(k + 1) % ring.size()];
      if ((here == a && next == b) || (here == b && next == a)) {
        ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(k) + 1, corner);
        return;
      }
    }
  }
};

/// A straight wall across the room from the middle part of wall `from`, drawn but not there.
bool add_phantom(PlanEditor& editor, int room, int from, const PlanDistortionParams& params, std::mt19937_64& random) {
  const Segment2 line = editor.plan.wall_line(from);
  const auto [left, right] = editor.plan.rooms_beside(from);
  const Point2 inward = left == room ? line.normal() : Point2(-line.normal());
  const Point2 p = line.a + uniform(random, 0.4, 0.6) * (line.b - line.a);
  const Segment2 ray{p + 0.05 * inward, p + 100 * inward};
  int opposite = -1;
  double nearest = 1e9;
  for (std::size_t i = 0; i < editor.plan.walls.size(); ++i) {
    const auto wall = static_cast<int>(i);
    const auto beside = editor.plan.rooms_beside(wall);
    if (beside.first != room && beside.second != room) continue;
    if (const auto q = intersection(ray, editor.plan.wall_line(wall)); q && (*q - p).norm() < nearest) {
      nearest = (*q - p).norm();
      opposite = wall;
    }
  }
  if (opposite < 0 || opposite == from || nearest < params.min_wall_m || nearest > 8) return false;
  const Point2 q = p + nearest * inward;
  PlanEditor trial = editor;
  const auto corner_q = trial.split(opposite, along(trial.plan.wall_line(opposite), q));
  if (!corner_q) return false;
  const auto corner_p = trial.split(from, along(line, p));
  if (!corner_p) return false;
  trial.plan.walls.push_back({*corner_p, *corner_q, 0.14, Material::kWood, false});
  trial.source.push_back(-1);
  trial.divide(room, *corner_p, *corner_q);
  editor = std::move(trial);
  return true;
}

void add_phantoms(PlanEditor& editor, const PlanDistortionParams& params, std::mt19937_64& random) {
  std::vector<std::pair<int, int>> places;  // a room and a wall of it
  for (std::size_t i = 0; i < editor.plan.walls.size(); ++i) {
    const auto wall = static_cast<int>(i);
    const auto [left, right] = editor.plan.rooms_beside(wall);
    for (const int room : {left, right})
      if (room >= 0 && !editor.plan.rooms[static_cast<std::size_t>(room)].corridor &&
          editor.plan.wall_line(wall).length() > 2.4)
        places.emplace_back(room, wall);
  }
  std::vector<int> taken;
  while (!places.empty() && static_cast<int>(taken.size()) < params.phantom_walls) {
    const std::size_t pick = uniform_index(random, places.size());
    const auto [room, wall] = places[pick];
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(pick));
    if (std::count(taken.begin(), taken.end(), room)) continue;
    bool made = false;
    for (int attempt = 0; attempt < 4 && !made; ++attempt) made = add_phantom(editor, room, wall, params, random);
    if (made) taken.push_back(room);
  }
}

std::vector<int> remove_walls(PlanEditor& editor, const FloorPlan& building, const PlanDistortionParams& params,
                              std::mt19937_64& random) {
  std::vector<int> candidates, missing;
  for (std::size_t i = 0; i < building.walls.size(); ++i) {
    const auto wall = static_cast<int>(i);
    const auto [left, right] = building.rooms_beside(wall);
    const bool untouched = std::count(editor.source.begin(), editor.source.end(), wall) == 1 &&
                           editor.source[i] == wall &&
                           (editor.plan.wall_line(wall).length() == building.wall_line(wall).length());
    if (left < 0 || right < 0 || !untouched || building.wall_line(wall).length() < params.min_wall_m) continue;
    if (building.rooms[static_cast<std::size_t>(left)].corridor ||
        building.rooms[static_cast<std::size_t>(right)].corridor)
      continue;
    candidates.push_back(wall);
  }
  while (!candidates.empty() && static_cast<int>(missing.size()) < params.missing_walls) {
    const std::size_t pick = uniform_index(random, candidates.size());
    missing.push_back(candidates[pick]);
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(pick));
  }
  std::sort(missing.begin(), missing.end());
  for (auto wall = missing.rbegin(); wall != missing.rend(); ++wall)
    editor.remove(*wall);  // their indices are still true ones
  return missing;
}

/// Corners that only cut a straight wall (their third wall is not drawn) stay on the line between their neighbours.
void straighten(FloorPlan& plan, const std::vector<Point2>& corner_world) {
  for (std::size_t i = 0; i < plan.corners.size(); ++i) {
    std::vector<std::size_t> others;
    for (const PlanWall& wall : plan.walls) {
      if (wall.corner_a == static_cast<int>(i)) others.push_back(static_cast<std::size_t>(wall.corner_b));
      if (wall.corner_b == static_cast<int>(i)) others.push_back(static_cast<std::size_t>(wall.corner_a));
    }
    if (others.size() != 2) continue;
    const Segment2 through{corner_world[others[0]], corner_world[others[1]]};
    if (distance(through, corner_world[i]) > 1e-6) continue;
    const Segment2 drawn{plan.corners[others[0]], plan.corners[others[1]]};
    plan.corners[i] = closest_point(drawn, plan.corners[i]);
  }
}

}  // namespace

Result<Ok> PlanDistortionParams::validate() const {
  return ParamCheck("PlanDistortionParams")
      .in_range("sigma_stretch", sigma_stretch, 0, 0.3)
      .in_range("stretch_cut_sigmas", stretch_cut_sigmas, 0.5, 4)
      .in_range("knot_spacing_m", knot_spacing_m, 0.5, 1000)
      .in_range("sigma_corner_m", sigma_corner_m, 0, 0.3)
      .in_range("missing_walls", missing_walls, 0, 10000)
      .in_range("phantom_walls", phantom_walls, 0, 10000)
      .in_range("min_wall_m", min_wall_m, 0.5, 20)
      .in_range("turn_rad", turn_rad, -2 * kPi, 2 * kPi)
      .in_range("scale", scale, 0.01, 100)
      .result();
}

double PlanWarp::Axis::forward(double value) const { return piecewise(knots, drawn, value); }
double PlanWarp::Axis::backward(double value) const { return piecewise(drawn, knots, value); }

Point2 PlanWarp::operator()(const Point2& p_world) const {
  return after_ * Point2(x_.forward(p_world.x()), y_.forward(p_world.y()));
}
Point2 PlanWarp::inverse(const Point2& p_plan) const {
  const Point2 p = after_.inverse() * p_plan;
  return {x_.backward(p.x()), y_.backward(p.y())};
}

Result<DistortedPlan> distort(const FloorPlan& building, const PlanDistortionParams& params, std::mt19937_64& random) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (building.corners.empty() || building.rooms.empty()) return fail(Errc::kDegenerate, "the building has no rooms");
  PlanEditor editor(building);
  add_phantoms(editor, params, random);
  DistortedPlan result;
  result.missing = remove_walls(editor, building, params, random);
  result.drawn = std::move(editor.plan);
  result.drawn.furniture.clear();
  result.wall_source = std::move(editor.source);
  result.corner_world = result.drawn.corners;

  Point2 low = building.corners.front(), high = low;
  for (const Point2& p : building.corners) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  PlanWarp::Axis x = random_axis(low.x(), high.x(), params, random), y = random_axis(low.y(), high.y(), params, random);
  result.warp = PlanWarp(std::move(x), std::move(y), {params.scale, Pose2(0, 0, params.turn_rad)});
  const double cut = 2.5 * params.sigma_corner_m;
  for (Point2& p : result.drawn.corners) {
    p = result.warp(p);
    for (int axis = 0; axis < 2; ++axis)
      p[axis] += params.scale * std::clamp(normal(random, params.sigma_corner_m), -cut, cut);
  }
  straighten(result.drawn, result.corner_world);
  for (PlanWall& wall : result.drawn.walls) wall.thickness_m *= params.scale;
  return result;
}

}  // namespace smokemap
