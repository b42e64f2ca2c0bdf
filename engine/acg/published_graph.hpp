#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "geometry/similarity2.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

enum class PublishedMethod {
  kAcg2017,  ///< SSRR 2017: the robot's map is right; every seen corner within 2 m of a corner of the plan links to it
  kAcg2019,  ///< Robotics 2019 8(2) 40: poses and plan are corrected; corners link from poses localised in the plan
};

/// Where Monte-Carlo localisation in the plan, laid down as it is, has a node.
struct LocalizedNode {
  Pose2 T_map_robot;
  Eigen::Matrix2d covariance = 0.01 * Eigen::Matrix2d::Identity();  ///< of x, y
};

struct PublishedInput {
  LayoutMap plan;               ///< with a scale
  Similarity2 map_from_layout;  ///< the alignment by two pairs
  PoseGraph graph;
  std::vector<std::optional<LocalizedNode>> localized;  ///< per node; kAcg2019 links nothing where there is none
};

/// The Auto-Complete Graph as it was published, for comparison only: same read-out as ours where it has one (walls are
/// confirmed when a corner of theirs is linked, else unseen; nothing is ever missing or new).
///
/// kAcg2017: vertices are plan corners; wall edges (p_B - p_A) against the drawn vector in map, variances 10 % of
/// length along and 0.005 across; links sigma 0.5 m, removed beyond 3 m; Huber 1, then dynamic covariance scaling.
/// kAcg2019: vertices are poses (one each 2 m), seen corners (one each 1 m), plan corners; odometry, corner
/// observations 0.05 m, plan observations with the localiser's covariance through its 5.99 gate, walls 10 % and 0.05;
/// Huber, then dynamic covariance scaling, both of width 100, which hardly acts. Differs: exact Jacobians and two-sided
/// orientation test (the released program has neither), no NDT cells on walls (the published edge moved one end of a
/// wall only), corners from fitted lines. Deterministic. kDegenerate without walls or nodes, kNotConverged.
Result<MergedMap> merge_as_published(PublishedMethod method, const PublishedInput& input);

}  // namespace smokemap
