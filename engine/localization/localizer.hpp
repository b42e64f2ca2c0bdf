#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "geometry/segment2.hpp"

namespace smokemap {

struct LocalizerParams {
  int min_particles = 300;
  int max_particles = 4000;        ///< also used for a start without any hint
  double sigma_hit_m = 0.20;       ///< lidar noise, wall thickness and the plan's local error together
  double outlier_share = 0.35;     ///< beams that end on something the plan does not show
  double temper = 0.15;            ///< power of the likelihood: neighbouring beams are not independent
  int beams = 60;                  ///< hits used per update, spread evenly
  double sigma_move_share = 0.10;  ///< of the distance driven
  double sigma_turn_share = 0.10;  ///< of the turn
  double sigma_move_m = 0.02;      ///< added at every update
  double sigma_turn_rad = 0.01;    ///< added at every update
  double scale_sigma = 0.08;       ///< spread of the plan's unknown local scale among the particles
  double resolution_m = 0.05;      ///< of the distance field
  double lost_below = 0.50;        ///< running share of hits explained under which the answer is "lost"
  double lost_sigma_m = 1.5;       ///< spread above which the answer is "lost"
  Result<Ok> validate() const;
};

/// A wall to localise in: centre line and thickness, any one metric frame (`map` in live use).
struct LocalizerWall {
  Segment2 segment;
  double thickness_m = 0;
};

struct LocalizerEstimate {
  Pose2 T_map_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< x, y, heading
  double explained = 0;  ///< running share of hits within 1.25 sigma of a wall's face
  int particles = 0;
  bool lost = true;  ///< spread out, ambiguous, or the walls do not explain what is seen
};

/// Monte-Carlo localisation in walls that may be locally stretched and lack details.
///
/// Likelihood of a scan = product over hits of (outlier + (1 - outlier) exp(-d^2 / 2 sigma^2)), d from a distance field
/// of the walls' faces, to the power `temper`; every particle carries its own guess of the local scale. Systematic
/// resampling when the effective number halves, the number of particles from the spread (KLD-like: bins of 0.5 m and 10
/// degrees). Source: Thrun, Burgard, Fox 2005 ch. 8; Fox 2003 (KLD); differs from NDT-MCL of Robotics 2019 8(2) 40:
/// product instead of sum, heading resampled too, full covariance. Deterministic for a seed. Cost: particles x beams
/// per update.
class Localizer {
 public:
  explicit Localizer(const LocalizerParams& params = {}, std::uint64_t seed = 1);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  /// The walls as they lie now; particles stay. Call again when the plan was corrected.
  void set_walls(const std::vector<LocalizerWall>& walls);
  void start_at(const Pose2& T_map_robot, double sigma_m, double sigma_rad);
  /// Anywhere inside the bounding box of the walls, any heading.
  void start_anywhere();
  /// One step: how the robot moved since the last call (`T_before_after`, from odometry), then what it sees now.
  void update(const Pose2& T_before_after, const std::vector<Point2>& hits_robot);
  LocalizerEstimate estimate() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokemap
