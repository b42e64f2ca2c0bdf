#pragma once

#include <vector>

#include "slam/trajectory_error.hpp"

namespace smokemap::bench {

/// Relations of a log whose stamps are coarse, when a stamp that may mean several readings means the one that the
/// relations themselves say.
struct ReadingFigures {
  std::size_t stamps = 0, ambiguous = 0;        ///< of relations; that may mean readings at different places
  double mean_m = 0, most_m = 0, mean_rad = 0;  ///< each relation judged by readings that four fifths of the others say
  double best_mean_m = 0, best_most_m = 0, best_mean_rad = 0;  ///< by readings that all relations say
};

/// @param reading_of_scan  index of the reading that came with each pose of the trajectory
ReadingFigures told_by_relations(const Trajectory& trajectory, const std::vector<std::size_t>& reading_of_scan,
                                 const std::vector<Odometry>& odometry, const std::vector<PoseRelation>& relations);

}  // namespace smokemap::bench
