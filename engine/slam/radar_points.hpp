#pragma once

#include <vector>

#include "maps/radar_sweep.hpp"
#include "slam/surface_points.hpp"

namespace smokemap {

/// The strongest echoes of each azimuth, in the robot frame at the sweep's stamp, straightened.
/// weight = log of power over receiver noise, less for echoes behind others of their azimuth: what a mirror shows
/// stands behind the mirror, and so does what shines through a wall.
struct RadarEcho {
  Point2 p = Point2::Zero();
  int azimuth = 0;
  double range_m = 0;
  double weight = 0;
};

/// At most params.strongest local maxima of power per azimuth, over params.least_power, within the range limits; near
/// to far within an azimuth.
std::vector<RadarEcho> strongest_echoes(const RadarSweep& sweep, const Twist2& twist, const RadarParams& params);

/// A sweep as a scan with a beam an azimuth, each ending at its nearest echo on a surface; infinite where there is
/// none.
LaserScan nearest_surfaces(const RadarSweep& sweep, const RadarParams& params);

/// Weighted oriented surface points for the matcher: mean and main direction of the echoes around each thinned one.
/// Hits to draw are echoes on a surface, nearest of their azimuth; a radar clears nothing: no free ends.
/// Source: CFEAR (Adolfsson et al., T-RO 2023), lengths for rooms instead of streets.
/// @param left_out_m  of each azimuth the range at which echoes are left out, 0 = none; or nothing at all
ScanPoints surface_points(const RadarSweep& sweep, const Twist2& twist, const RadarParams& radar,
                          const PointParams& points, const std::vector<double>& left_out_m = {});

}  // namespace smokemap
