#include "simulation/segment_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/expect.hpp"

namespace smokemap {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTouch = 1e-6;        ///< buckets take what comes this close to them, so that rounding loses nothing
constexpr double kBucketFactor = 1.5;  ///< bucket edge over the mean room of a segment; measured by raycast_bench
constexpr int kMaxBuckets = 1 << 22;

/// Range at which the ray from the origin along (dx, dy) meets the segment from a to b (both relative to the origin);
/// infinite if it does not. A shared end gives the same sign in both segments that meet there: no gap between them.
inline double meet(double ax, double ay, double bx, double by, double dx, double dy) {
  const double side_a = dx * ay - dy * ax, side_b = dx * by - dy * bx;
  if (side_a * side_b > 0) return kInfinite;
  const double ahead_a = dx * ax + dy * ay, ahead_b = dx * bx + dy * by;
  if (side_a == side_b) {  // the ray runs along the segment
    const double near = std::min(ahead_a, ahead_b), far = std::max(ahead_a, ahead_b);
    return far < 0 ? kInfinite : std::max(near, 0.0);
  }
  const double range = (ahead_a * side_b - ahead_b * side_a) / (side_b - side_a);
  return range < 0 ? kInfinite : range;
}

RayHit hit_on(const Point2& normal, int index, const Point2& direction, double range_m) {
  return {range_m, std::min(std::abs(normal.dot(direction)), 1.0), index};
}

Segment2 leaf_line(const DoorLeaf& door) {
  return {door.hinge, door.hinge + Pose2(0, 0, door.open_rad).rotation() * (door.latch - door.hinge)};
}

/// Share of the ray spent between the planes low and high of one axis.
inline void clip_to_slab(double origin, double direction, double low, double high, double& enter, double& leave) {
  if (direction == 0) {
    if (origin < low || origin > high) leave = -1;
    return;
  }
  const double one = (low - origin) / direction, other = (high - origin) / direction;
  enter = std::max(enter, std::min(one, other));
  leave = std::min(leave, std::max(one, other));
}

}  // namespace

SegmentWorld::SegmentWorld(std::vector<WorldSegment> segments, std::vector<DoorLeaf> doors)
    : segments_(std::move(segments)), doors_(std::move(doors)) {
  for (const DoorLeaf& door : doors_) segments_.push_back({leaf_line(door), door.material});
  build();
}

void SegmentWorld::set_door(int door, double open_rad) {
  ENGINE_EXPECT(door >= 0 && door < static_cast<int>(doors_.size()));
  DoorLeaf& leaf = doors_[static_cast<std::size_t>(door)];
  leaf.open_rad = open_rad;
  segments_[segments_.size() - doors_.size() + static_cast<std::size_t>(door)].line = leaf_line(leaf);
  build();
}

void SegmentWorld::build() {
  first_.clear();
  ends_.clear();
  owner_.clear();
  if (segments_.empty()) return;
  normals_.clear();
  for (const WorldSegment& segment : segments_) normals_.push_back(segment.line.normal());
  low_ = high_ = segments_.front().line.a;
  for (const WorldSegment& segment : segments_)
    for (const Point2& p : {segment.line.a, segment.line.b}) {
      ENGINE_EXPECT(p.allFinite());
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
  origin_ = low_ - Point2(2 * kTouch, 2 * kTouch);
  const Point2 size = high_ - origin_ + Point2(2 * kTouch, 2 * kTouch);
  bucket_m_ = kBucketFactor * std::sqrt(size.x() * size.y() / static_cast<double>(segments_.size()));
  bucket_m_ = std::max({bucket_m_, std::sqrt(size.x() * size.y() / kMaxBuckets), size.maxCoeff() / 65536, 1e-3});
  width_ = static_cast<int>(size.x() / bucket_m_) + 1;
  height_ = static_cast<int>(size.y() / bucket_m_) + 1;

  first_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, 0);
  for (std::size_t i = 0; i < segments_.size(); ++i) count_or_place(static_cast<int>(i), false);
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  ends_.resize(static_cast<std::size_t>(first_.back()));
  owner_.resize(ends_.size());
  for (std::size_t i = segments_.size(); i-- > 0;) count_or_place(static_cast<int>(i), true);
}

/// Counting sort in two passes: first the number of entries of every bucket, then (filling from each bucket's end,
/// which turns the running totals into first entries) the entries themselves.
void SegmentWorld::count_or_place(int segment, bool place) {
  const Segment2& line = segments_[static_cast<std::size_t>(segment)].line;
  const Point2 a = line.a - origin_, b = line.b - origin_;
  const auto bucket = [this](double v, int count) {
    return std::clamp(static_cast<int>(std::floor(v / bucket_m_)), 0, count - 1);
  };
  const int row_end = bucket(std::max(a.y(), b.y()) + kTouch, height_);
  for (int row = bucket(std::min(a.y(), b.y()) - kTouch, height_); row <= row_end; ++row) {
    double from = 0, to = 1;  // the share of the segment inside this row
    if (std::abs(b.y() - a.y()) > kTouch)
      clip_to_slab(a.y(), b.y() - a.y(), row * bucket_m_ - kTouch, (row + 1) * bucket_m_ + kTouch, from, to);
    const double x0 = a.x() + from * (b.x() - a.x()), x1 = a.x() + to * (b.x() - a.x());
    const int column_end = bucket(std::max(x0, x1) + kTouch, width_);
    for (int column = bucket(std::min(x0, x1) - kTouch, width_); column <= column_end; ++column) {
      const auto cell = index_of(column, row);
      if (!place) {
        ++first_[cell];
        continue;
      }
      const auto entry = static_cast<std::size_t>(--first_[cell]);
      ends_[entry] = {line.a.x(), line.a.y(), line.b.x(), line.b.y()};
      owner_[entry] = segment;
    }
  }
}

std::optional<RayHit> SegmentWorld::cast(const Point2& origin, double angle_rad, double max_range_m) const {
  return cast(origin, Point2(std::cos(angle_rad), std::sin(angle_rad)), max_range_m);
}

std::optional<RayHit> SegmentWorld::cast(const Point2& origin, const Point2& direction, double max_range_m) const {
  if (segments_.empty()) return std::nullopt;
  const double ox = origin.x(), oy = origin.y(), dx = direction.x(), dy = direction.y();
  double enter = 0, leave = max_range_m;
  clip_to_slab(ox, dx, origin_.x(), origin_.x() + width_ * bucket_m_, enter, leave);
  clip_to_slab(oy, dy, origin_.y(), origin_.y() + height_ * bucket_m_, enter, leave);
  if (!(enter <= leave)) return std::nullopt;

  const auto bucket = [this](double v, int count) { return std::clamp(static_cast<int>(v / bucket_m_), 0, count - 1); };
  int column = bucket(ox + enter * dx - origin_.x(), width_), row = bucket(oy + enter * dy - origin_.y(), height_);
  const int step_x = dx > 0 ? 1 : -1, step_y = dy > 0 ? 1 : -1;
  const double wide = dx == 0 ? kInfinite : bucket_m_ / std::abs(dx),
               high = dy == 0 ? kInfinite : bucket_m_ / std::abs(dy);
  double next_x = dx == 0 ? kInfinite : (origin_.x() + (column + (dx > 0 ? 1 : 0)) * bucket_m_ - ox) / dx;
  double next_y = dy == 0 ? kInfinite : (origin_.y() + (row + (dy > 0 ? 1 : 0)) * bucket_m_ - oy) / dy;

  double best = max_range_m;
  int found = -1;
  while (true) {
    const auto cell = index_of(column, row);
    for (int entry = first_[cell]; entry < first_[cell + 1]; ++entry) {
      const Ends& e = ends_[static_cast<std::size_t>(entry)];
      const double range = meet(e.ax - ox, e.ay - oy, e.bx - ox, e.by - oy, dx, dy);
      if (range <= best) {
        best = range;
        found = owner_[static_cast<std::size_t>(entry)];
      }
    }
    const double exit = std::min(next_x, next_y);
    if ((found >= 0 && best <= exit) || exit >= leave) break;
    if (next_x < next_y) {
      column += step_x;
      next_x += wide;
      if (column < 0 || column >= width_) break;
    } else {
      row += step_y;
      next_y += high;
      if (row < 0 || row >= height_) break;
    }
  }
  if (found < 0) return std::nullopt;
  return hit_on(normals_[static_cast<std::size_t>(found)], found, direction, best);
}

bool SegmentWorld::sees(const Point2& from, const Point2& to) const {
  const double way = (to - from).norm();
  return way == 0 || !cast(from, Point2((to - from) / way), way);
}

double SegmentWorld::clearance_m(const Point2& p, double limit_m) const {
  double nearest = limit_m;
  if (segments_.empty()) return nearest;
  const auto bucket = [this](double v, int count) {
    return static_cast<int>(std::clamp(std::floor(v / bucket_m_), -1.0, static_cast<double>(count)));
  };
  const Point2 from = p - origin_;
  const int row_end = std::min(bucket(from.y() + limit_m, height_), height_ - 1);
  const int column_end = std::min(bucket(from.x() + limit_m, width_), width_ - 1);
  for (int row = std::max(bucket(from.y() - limit_m, height_), 0); row <= row_end; ++row)
    for (int column = std::max(bucket(from.x() - limit_m, width_), 0); column <= column_end; ++column) {
      const auto cell = index_of(column, row);
      for (int entry = first_[cell]; entry < first_[cell + 1]; ++entry) {
        const Ends& e = ends_[static_cast<std::size_t>(entry)];
        nearest = std::min(nearest, distance({{e.ax, e.ay}, {e.bx, e.by}}, p));
      }
    }
  return nearest;
}

std::optional<RayHit> cast_by_force(const SegmentWorld& world, const Point2& origin, const Point2& direction,
                                    double max_range_m) {
  std::optional<RayHit> best;
  for (std::size_t i = 0; i < world.segments().size(); ++i) {
    const Point2 a = world.segments()[i].line.a - origin, b = world.segments()[i].line.b - origin;
    const double range = meet(a.x(), a.y(), b.x(), b.y(), direction.x(), direction.y());
    if (range <= max_range_m && (!best || range < best->range_m))
      best = hit_on(world.segments()[i].line.normal(), static_cast<int>(i), direction, range);
  }
  return best;
}

}  // namespace smokemap
