#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "geometry/pose2.hpp"
#include "grids/occupancy_grid.hpp"

namespace smokemap {

/// A pose kept in the graph, with what its scan saw. Ids count up from 0 over all robots of a floor.
struct PoseNode {
  int id = 0;
  std::string robot;
  Stamp stamp = 0;
  Pose2 T_map_robot;  ///< SLAM's own estimate
  Pose2 T_odom_robot;
  std::shared_ptr<const std::vector<Point2>> hits_robot;  ///< de-skewed hits, robot frame, thinned
  /// What the radar saw beside a lidar that smoke had blinded; null otherwise. Several times less exact than hits: to
  /// be drawn, not to be measured by. (Of a robot with a radar alone, hits_robot are the radar's.)
  std::shared_ptr<const std::vector<Point2>> radar_hits_robot;
  std::shared_ptr<const std::vector<Point2>> free_ends_robot;  ///< ends of beams known free up to there, robot frame
};

enum class EdgeKind : std::uint8_t { kOdometry, kMatched, kLoop };
enum class LinkState : std::uint8_t { kKept, kDoubtful, kRejected };

/// A measured relative pose between two nodes.
struct PoseEdge {
  int from = 0;
  int to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d sqrt_information = Eigen::Matrix3d::Identity();  ///< of (x, y, heading) in frame `from`
  EdgeKind kind = EdgeKind::kOdometry;
  LinkState state = LinkState::kKept;
};

/// What SLAM hands to the Auto-Complete Graph: nodes in the order in which they came, edges between them.
struct PoseGraph {
  std::vector<PoseNode> nodes;
  std::vector<PoseEdge> edges;
};

}  // namespace smokemap
