#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "simulation/building.hpp"
#include "simulation/wall_solids.hpp"

namespace smokemap {
namespace {

constexpr double kPoke =
    1e-6;  ///< faces reach so far into the solid behind a corner: they cross there instead of just touching

/// The share [from, to] of `edge` strictly inside the rectangle; from >= to if none.
std::pair<double, double> share_inside(const Segment2& edge, const WallSolid& solid) {
  const Point2 u = solid.line.direction(), center = solid.line.midpoint(), way = edge.b - edge.a;
  double from = 0, to = 1;
  const auto clip = [&](const Point2& axis, double half) {
    const double start = axis.dot(edge.a - center), speed = axis.dot(way), reach = half - kPoke;
    if (std::abs(speed) < 1e-12) {
      if (std::abs(start) >= reach) to = -1;
      return;
    }
    const double one = (-reach - start) / speed, other = (reach - start) / speed;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  };
  clip(u, solid.line.length() / 2);
  clip(Point2(-u.y(), u.x()), solid.half_thickness_m);
  return {from, to};
}

/// What is left of `edge` outside all other solids.
void add_visible(const Segment2& edge, Material material, const std::vector<WallSolid>& solids, std::size_t own,
                 std::vector<WorldSegment>& out) {
  std::vector<std::pair<double, double>> hidden;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (i == own) continue;
    const auto inside = share_inside(edge, solids[i]);
    if (inside.first < inside.second) hidden.push_back(inside);
  }
  std::sort(hidden.begin(), hidden.end());
  hidden.emplace_back(1.0, 1.0);
  const double poke = kPoke / std::max(edge.length(), kPoke);
  double from = 0;
  for (const auto& [begin, end] : hidden) {
    if (begin > from) {
      const double a = std::max(from - poke, 0.0), b = std::min(begin + poke, 1.0);
      out.push_back({{edge.a + a * (edge.b - edge.a), edge.a + b * (edge.b - edge.a)}, material});
    }
    from = std::max(from, end);
  }
}

/// Pieces of one face (overlapping or touching on one line) become one segment: fewer for every ray to look at.
std::vector<WorldSegment> merge_faces(std::vector<WorldSegment> pieces) {
  struct OnLine {
    long heading = 0, offset = 0;  ///< of the line, in millionths; lines that differ by rounding only may stay apart
    Material material = Material::kBrick;
    double from = 0, to = 0;
    Segment2 line;
    auto key() const { return std::tuple(heading, offset, material); }
  };
  std::vector<OnLine> faces;
  for (WorldSegment& piece : pieces) {
    Point2 u = piece.line.direction();
    if (u.x() < -1e-9 || (std::abs(u.x()) <= 1e-9 && u.y() < 0)) {
      std::swap(piece.line.a, piece.line.b);
      u = -u;
    }
    const Point2 n(-u.y(), u.x());
    faces.push_back({std::lround(1e6 * std::atan2(u.y(), u.x())), std::lround(1e6 * n.dot(piece.line.a)),
                     piece.material, u.dot(piece.line.a), u.dot(piece.line.b), piece.line});
  }
  std::sort(faces.begin(), faces.end(), [](const OnLine& a, const OnLine& b) {
    return std::tuple(a.key(), a.from, a.to) < std::tuple(b.key(), b.from, b.to);
  });
  std::vector<WorldSegment> merged;
  for (std::size_t i = 0; i < faces.size();) {
    OnLine face = faces[i];
    for (++i; i < faces.size() && faces[i].key() == face.key() && faces[i].from <= face.to; ++i) {
      if (faces[i].to <= face.to) continue;
      face.to = faces[i].to;
      face.line.b = faces[i].line.b;
    }
    merged.push_back({face.line, face.material});
  }
  return merged;
}

}  // namespace

SegmentWorld build_world(const FloorPlan& plan) {
  const std::vector<WallSolid> solids = wall_solids(plan);
  std::vector<WorldSegment> segments;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Polygon quad = solids[i].quad();
    const Material material = plan.walls[static_cast<std::size_t>(solids[i].wall)].material;
    for (std::size_t k = 0; k < 4; ++k) add_visible({quad[k], quad[(k + 1) % 4]}, material, solids, i, segments);
  }
  segments = merge_faces(std::move(segments));
  for (const Polygon& piece : plan.furniture)
    for (std::size_t k = 0; k < piece.size(); ++k)
      segments.push_back({{piece[k], piece[(k + 1) % piece.size()]}, Material::kWood});

  std::vector<DoorLeaf> leaves;
  for (std::size_t i = 0; i < plan.doors.size(); ++i) {
    const PlanDoor& door = plan.doors[i];
    if (!door.has_leaf) continue;
    Segment2 gap = plan.door_gap(static_cast<int>(i));
    if (door.hinge_at_to) std::swap(gap.a, gap.b);
    const double sign = door.swings_left != door.hinge_at_to ? 1 : -1;
    leaves.push_back({gap.a, gap.b, sign * door.open_rad, Material::kWood});
  }
  return SegmentWorld(std::move(segments), std::move(leaves));
}

}  // namespace smokemap
