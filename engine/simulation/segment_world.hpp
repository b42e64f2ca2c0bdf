#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/segment2.hpp"

namespace smokemap {

/// What a surface is made of: the lidar sees its reflectance, the radar its echo, shine and transmission.
enum class Material : std::uint8_t { kBrick, kWood, kGlass, kMetal };

/// One straight surface of the true world (frame `world`, metres). Both sides reflect.
struct WorldSegment {
  Segment2 line;
  Material material = Material::kBrick;
};

/// A door that swings about `hinge`; `latch` is where its free edge is when it is shut.
struct DoorLeaf {
  Point2 hinge = Point2::Zero();
  Point2 latch = Point2::Zero();
  double open_rad = 0;  ///< 0 = shut, counter-clockwise positive
  Material material = Material::kWood;
};

struct RayHit {
  double range_m = 0;
  double cos_incidence = 1;  ///< 1 = square on, 0 = grazing
  int segment = 0;           ///< index into segments()
};

/// The true world as line segments in a bucket grid: exact, nothing precomputed over angles, doors can move.
///
/// A ray that passes through a corner shared by two segments hits one of them: sides are decided by the sign of the
/// same expression for both. Casting is const and free of allocation: any number of threads may cast at once.
class SegmentWorld {
 public:
  SegmentWorld() = default;
  explicit SegmentWorld(std::vector<WorldSegment> segments, std::vector<DoorLeaf> doors = {});

  /// The first surface from `origin` along the unit vector `direction`, not further than `max_range_m`.
  std::optional<RayHit> cast(const Point2& origin, const Point2& direction, double max_range_m) const;
  /// The same, direction as an angle counter-clockwise from +x.
  std::optional<RayHit> cast(const Point2& origin, double angle_rad, double max_range_m) const;
  /// True where nothing stands between the two points.
  bool sees(const Point2& from, const Point2& to) const;
  /// Distance to the nearest surface, `limit_m` if none is nearer.
  double clearance_m(const Point2& p, double limit_m) const;

  /// Turns a door. Cost: the grid is built anew (2 ms for 15 000 segments).
  void set_door(int door, double open_rad);
  const std::vector<DoorLeaf>& doors() const { return doors_; }

  /// Fixed surfaces first, then one per door.
  const std::vector<WorldSegment>& segments() const { return segments_; }
  /// Corners of the box around everything; both zero for an empty world.
  const Point2& low() const { return low_; }
  const Point2& high() const { return high_; }

 private:
  struct Ends {
    double ax, ay, bx, by;
  };
  void build();
  void count_or_place(int segment, bool place);
  std::size_t index_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
  }

  std::vector<WorldSegment> segments_;
  std::vector<DoorLeaf> doors_;
  Point2 low_ = Point2::Zero(), high_ = Point2::Zero();
  Point2 origin_ = Point2::Zero();  ///< of bucket (0, 0)
  double bucket_m_ = 1;
  int width_ = 0, height_ = 0;   ///< buckets
  std::vector<int> first_;       ///< bucket -> first entry; one more than buckets
  std::vector<Ends> ends_;       ///< the segments of a bucket side by side
  std::vector<int> owner_;       ///< entry -> segment
  std::vector<Point2> normals_;  ///< per segment
};

/// The oracle: tries every segment. For tests and for worlds of a few segments.
std::optional<RayHit> cast_by_force(const SegmentWorld& world, const Point2& origin, const Point2& direction,
                                    double max_range_m);

}  // namespace smokemap
