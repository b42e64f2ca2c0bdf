#pragma once

#include <deque>
#include <vector>

#include "maps/laser_scan.hpp"
#include "slam/hit_ranges.hpp"
#include "slam/slam_params.hpp"

namespace smokemap {

/// Beams of a scan, one flag each, that may have ended at somebody who walks.
struct WalkerView {
  std::vector<bool> unproven;  ///< at something small whose place was not seen taken from farther back
  std::vector<bool> moving;    ///< of these, where that place was seen free
};

/// People who walk with the robot. Whoever goes a few metres ahead of it, or follows it, is at the same place in every
/// scan: where a corridor says nothing along itself, he says that the robot stands. So an island, something no wider
/// than a person with his load and nearer than what the beams on both sides of it hit, counts only once its place was
/// seen taken from WalkerParams::proof_m back and from half of that; somebody who moves with the robot was nearer then.
/// Walls, jambs and all that hangs together with them are no islands; furniture and pillars are, and wait for so long.
///
/// Places are compared by the wheels' way and the matched heading: what is asked is whether the match may be believed.
/// Source: our own; a visibility check as those that clean maps of people (Schauer and Nuechter, "The Peopleremover",
/// 2018), made for somebody who hides the very place he comes to.
/// Cost: linear in beams.
class Walkers {
 public:
  explicit Walkers(const WalkerParams& params) : params_(params) {}

  /// @param T_way_robot  where the wheels and the matched headings so far have the robot
  WalkerView look(const LaserScan& scan, const HitRanges& hits, const Pose2& T_way_robot) const;
  /// Keeps the scan for later ones, unless the robot has hardly moved since the last one kept.
  void remember(const LaserScan& scan, HitRanges hits, const Pose2& T_way_robot);

 private:
  struct View {
    Pose2 T_way_robot, T_way_laser;
    double way_m;  ///< driven until here
    HitRanges hits;
  };
  /// Beams side by side whose hits hang together; around a full turn they may go beyond its end.
  struct Island {
    std::ptrdiff_t first, last;
  };
  enum class Place { kTaken, kFree, kHidden };

  std::vector<Island> pieces(const HitRanges& hits) const;
  std::vector<Island> islands(const HitRanges& hits) const;
  Place place_in(const View& view, const Island& island, const HitRanges& hits, const Pose2& T_way_laser,
                 double way_m) const;
  /// The newest scan kept from at least so far back.
  const View* from_back(double way_m, double least_m) const;
  double way_until(const Pose2& T_way_robot) const;

  WalkerParams params_;
  std::deque<View> views_;
};

}  // namespace smokemap
