#pragma once

#include <cstdint>
#include <vector>

#include "core/result.hpp"
#include "grids/grid_frame.hpp"
#include "simulation/segment_world.hpp"

namespace smokemap {

/// A fire: adds extinction to the cells around it until `ceiling` is reached there.
struct SmokeSource {
  Point2 p = Point2::Zero();
  double radius_m = 0.8;
  double rate_per_m_s = 0.5;   ///< 1/m per second
  double ceiling_per_m = 5.0;  ///< visibility is about 3 / extinction
};

struct SmokeParams {
  double cell_m = 0.5;
  double diffusion_m2ps = 0.35;  ///< turbulent mixing
  double decay_per_s = 0.004;    ///< settling and leaving through leaks
  Result<Ok> validate() const;
};

/// A piece of a ray inside one cell.
struct SmokePiece {
  double from_m = 0;
  double to_m = 0;
  double extinction_per_m = 0;
};

/// Extinction (1/m) on a coarse grid. Smoke spreads by diffusion between cells with a free way between their centres:
/// walls and shut doors hold it back. Deterministic; explicit steps, subdivided to stay stable.
class SmokeField {
 public:
  SmokeField() = default;  ///< clear air everywhere
  SmokeField(const SegmentWorld& world, const SmokeParams& params, std::vector<SmokeSource> sources = {});

  void advance(double seconds);
  /// After a door moved.
  void read_walls(const SegmentWorld& world);

  double extinction_at(const Point2& p) const;  ///< 0 outside
  void set_extinction(const Point2& p, double per_m);
  /// Integral of extinction along the ray; transmission one way is exp(-optical_depth) (Beer-Lambert). Exact for the
  /// grid.
  double optical_depth(const Point2& origin, const Point2& direction, double range_m) const;
  /// The ray cut at cell borders, near to far; pieces in clear air are left out.
  void trace(const Point2& origin, const Point2& direction, double range_m, std::vector<SmokePiece>& pieces) const;

  bool empty() const { return extinction_.empty(); }
  const GridFrame& frame() const { return frame_; }
  const std::vector<double>& extinction() const { return extinction_; }

 private:
  void add_sources(double seconds);
  void diffuse(double seconds);

  SmokeParams params_;
  GridFrame frame_;
  std::vector<SmokeSource> sources_;
  std::vector<double> extinction_, next_;
  std::vector<std::uint8_t> open_;  ///< per cell: bit 0 = free way to the right neighbour, bit 1 = to the upper one
};

}  // namespace smokemap
