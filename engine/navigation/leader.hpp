#pragma once

#include <optional>

#include "navigation/follower.hpp"

namespace smokemap {

/// What a robot's own navigator has made of the place it was last led to.
enum class Errand {
  kNone,      ///< it was led nowhere
  kUnderWay,  ///< it drives, or has not answered yet
  kDone,      ///< it says that it is there
  kGivenUp,   ///< it would not go, or gave up
};

struct LeaderParams {
  double ahead_m = 6.0;        ///< of the robot, along the path: where it is led to
  double least_ahead_m = 1.5;  ///< after its navigator gave up, which may not know the ground so far ahead
  double renew_m = 2.0;        ///< a place that moved less than this is not told again
  double end_renew_m = 0.15;   ///< the same for the end of the path, which is to be met
  int patience = 4;            ///< so many errands in a row may fail
  Result<Ok> validate() const;
};

/// Leads a robot that has a navigator of its own (Nav2) along our path: from place to place, always some metres ahead.
///
/// Why not the goal at once: our path goes by the merged map, through rooms no robot has seen, of which the robot's
/// navigator knows nothing; it would refuse what lies beyond its own map, or choose another way round. A place that
/// the navigator gives up on is tried again half as far ahead.
class Leader {
 public:
  explicit Leader(const LeaderParams& params) : params_(params), ahead_m_(params.ahead_m) {}

  /// @param path at least two points
  /// @param heading_rad to stand in at the end, in `map`; without it the last piece of the path says
  /// @param errand what became of the place that was told last
  /// @return the place to tell now, in `map`; nothing while the last one still holds, or `gave_up`
  std::optional<Pose2> next(const Path& path, const Pose2& T_map_robot, std::optional<double> heading_rad,
                            Errand errand);
  bool gave_up() const { return failures_ >= params_.patience; }
  /// Whether it was led anywhere since the last `reset`.
  bool leads() const { return told_.has_value(); }
  /// Another goal, or none, or the robot was stopped: what was told holds no more.
  void reset() { *this = Leader(params_); }

 private:
  LeaderParams params_;
  double ahead_m_;
  std::optional<Pose2> told_;
  bool told_end_ = false;
  std::optional<Point2> end_;  ///< of the path
  int failures_ = 0;
};

}  // namespace smokemap
