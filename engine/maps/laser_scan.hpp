#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// What one range says. In smoke "no return" is kUnknown: it never clears a cell.
enum class BeamKind : std::uint8_t {
  kHit,        ///< something stands at the range
  kFreeToMax,  ///< nothing up to the sensor's maximum (only where the sensor is known to say so in clear air)
  kUnknown,    ///< no information
};

/// How to read ranges that are no range; real bags mix inf, 0, NaN, > range_max and max + 1.
struct BeamConvention {
  bool no_return_is_free = false;  ///< true only for clear-air logs: inf and >= max count as free to max
  double usable_range_m = 0;       ///< ranges beyond are kFreeToMax / kUnknown; 0 = the scan's range_max
};

/// One sweep of a 2D lidar. Beam i looks at angle_min + i * angle_increment in the laser frame.
struct LaserScan {
  Stamp stamp = 0;  ///< of the first beam, robot's clock
  std::string robot;
  double angle_min_rad = 0;
  double angle_increment_rad = 0;
  double time_increment_s = 0;  ///< between beams; 0 = all at once
  double range_min_m = 0;
  double range_max_m = 0;
  std::vector<float> ranges_m;     ///< as received
  std::vector<float> intensities;  ///< empty or one a beam
  Pose2 T_robot_laser;
};

BeamKind classify(float range_m, const LaserScan& scan, const BeamConvention& convention);

/// Rejects, with the reason, what no later stage should see: no beams, more than 20 000, an increment that is zero, not
/// finite or goes round more than twice (degrees), a pose that is not finite, limits without a range between them.
Result<Ok> check(const LaserScan& scan);

/// Number of beams that look in different directions: a 361st beam of a full turn repeats the first, all later ones
/// too.
std::size_t distinct_beams(const LaserScan& scan);

/// Hits in the laser frame, in beam order.
std::vector<Point2> hit_points(const LaserScan& scan, const BeamConvention& convention);

}  // namespace smokemap
