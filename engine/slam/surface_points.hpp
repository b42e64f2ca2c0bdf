#pragma once

#include <memory>
#include <vector>

#include "maps/laser_scan.hpp"
#include "slam/slam_params.hpp"

namespace smokemap {

/// A measured point with the direction of the surface it lies on, where that is known.
struct SurfacePoint {
  Point2 p = Point2::Zero();
  Point2 normal = Point2::Zero();  ///< unit, towards the sensor; zero = direction unknown
  double weight = 1;

  bool oriented() const { return normal.squaredNorm() > 0.5; }
};

/// What one scan or sweep gives to matching and to the map, in the robot frame at the scan's stamp.
struct ScanPoints {
  std::vector<SurfacePoint> surface;                            ///< for matching: thinned, at most params.most_points
  std::shared_ptr<const std::vector<Point2>> hits_robot;        ///< for drawing
  std::shared_ptr<const std::vector<Point2>> radar_hits_robot;  ///< the radar's beside a lidar's, may be null
  std::shared_ptr<const std::vector<Point2>> free_ends_robot;   ///< ends of beams known free
  bool by_radar = false;                                        ///< by the radar alone: matched as RadarParams say
};

/// The robot's motion during a scan, constant: what is used to straighten it.
struct Twist2 {
  Point2 velocity_mps = Point2::Zero();  ///< robot frame
  double turn_radps = 0;
  Pose2 after(double seconds) const { return {velocity_mps * seconds, turn_radps * seconds}; }
};

/// What a beam may be used for.
enum class BeamUse : std::uint8_t {
  kAll,
  kDrawing,  ///< not matched
  kNothing,
};

/// Classifies, straightens (when the scan says how long a beam takes) and thins a scan; estimates surface directions.
/// Free ends of beams to the maximum are cut at params.farthest_m. `uses`: one a beam, or none
/// at all. Cost: linear in beams.
ScanPoints surface_points(const LaserScan& scan, const BeamConvention& convention, const Twist2& twist,
                          const PointParams& params, const std::vector<BeamUse>& uses = {});

/// Keeps, in order, points at least `spacing_m` from the one kept before, widening until at most `most` are left.
std::vector<Point2> thin(const std::vector<Point2>& points, double spacing_m, std::size_t most);

}  // namespace smokemap
