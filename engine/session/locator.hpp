#pragma once

#include <cstdint>
#include <vector>

#include "localization/localizer.hpp"

namespace smokemap {

struct LocatorParams {
  LocalizerParams filter;
  int witnesses = 3;  ///< filters that must agree when nobody said where the robot is: look-alike rooms split them
  double agree_m = 0.5;
  double agree_rad = 0.15;
  double sure_sigma_m = 0.25;
  double sure_sigma_rad = 0.08;
  double sure_explained = 0.70;   ///< share of what is seen that the walls explain
  int sure_steps = 4;             ///< steps in a row that must all be sure
  double blind_travel_m = 6;      ///< driven before an answer without a hint is believed
  double worse_explained = 0.08;  ///< a filter that explains this much less than the best is in the wrong place
  int patience_steps = 10;        ///< between two looks at which filters are in the wrong place; those start again
  Result<Ok> validate() const;
};

/// Finds where a robot is on a map that another robot (or only the plan) made.
///
/// One particle filter when a person said where the robot stands; several with different seeds when nobody did, and
/// then they must agree: a filter that settled in one of two rooms that look alike says "sure", three rarely settle in
/// the same wrong one. Answers late rather than wrong. Deterministic. Cost a step: witnesses x Localizer::update.
class Locator {
 public:
  explicit Locator(const LocatorParams& params = {}, std::uint64_t seed = 1);

  /// The walls as they lie now.
  void set_walls(const std::vector<LocalizerWall>& walls);
  void start_at(const Pose2& T_map_robot, double sigma_m, double sigma_rad);
  void start_anywhere();
  /// @param T_before_after how the robot moved since the last step @param hits_robot what it sees now
  void step(const Pose2& T_before_after, const std::vector<Point2>& hits_robot);

  bool started() const { return !filters_.empty(); }
  /// The answer may be used.
  bool sure() const { return sure_steps_ >= params_.sure_steps && travelled_m_ >= needed_travel_m_; }
  LocalizerEstimate estimate() const;

 private:
  void start(int filters, double needed_travel_m);
  void restart_the_worse();
  bool sure_now() const;

  LocatorParams params_;
  std::uint64_t seed_;
  std::vector<LocalizerWall> walls_;
  std::vector<Localizer> filters_;
  double travelled_m_ = 0;
  double needed_travel_m_ = 0;
  int sure_steps_ = 0;
  int steps_ = 0;
};

}  // namespace smokemap
