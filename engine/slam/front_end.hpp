#pragma once

#include <deque>
#include <optional>

#include "maps/pose_graph.hpp"
#include "slam/align.hpp"
#include "slam/motion_model.hpp"

namespace smokemap {

/// What became of a scan. A scan without a match still moves the robot: by odometry, or by its last velocity.
enum class ScanFate : std::uint8_t {
  kMatched,       ///< pose from the match
  kFirst,         ///< the first scan defines the map
  kTooFewPoints,  ///< nearly all beams without information (smoke, open space): pose from the prediction
  kPoorMatch,     ///< did not fit the map: pose from the prediction
  kNewPiece,      ///< nothing had fitted for a while: a new piece of map begins here, tied by the prediction only
  kDuplicate,     ///< same stamp and same ranges as the scan before: ignored
};

/// The fast half: one scan after another against a local map of the last nodes, in a frame `track` that is smooth and
/// drifts. It never waits for the graph and never jumps when the graph is solved. The nodes of the local map count
/// together: a scan is registered jointly to all of them (as CFEAR does with its last keyframes). Lidar and radar may
/// take turns; each is matched by its own parameters, also against what the other has left in the map.
class FrontEnd {
 public:
  struct Tracked {
    ScanFate fate = ScanFate::kMatched;
    Pose2 T_track_robot;
    double score = 0;
    bool node = false;                                     ///< the scan joined the local map and belongs into the graph
    Pose2 T_node_robot;                                    ///< from the last node (before this one, if this is one)
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_node_robot, frame of that node
    EdgeKind kind = EdgeKind::kMatched;
    /// Of a node: what may be drawn. All hits of a lidar; of the radar those that an earlier node, from another
    /// place, has seen too: what mirrors show moves when the radar does.
    std::shared_ptr<const std::vector<Point2>> hits_robot, radar_hits_robot;
  };

  explicit FrontEnd(const SlamParams& params);
  /// @param step  predicted motion since the scan before
  Tracked track(const ScanPoints& points, const PredictedStep& step);
  const Pose2& T_track_robot() const { return T_track_robot_; }

 private:
  struct Node {
    Pose2 T_track_node;
    std::vector<SurfacePoint> surface;
    bool by_radar;
  };
  void match_as(bool radar);
  void add_to_map(const Node& node);
  std::shared_ptr<const std::vector<Point2>> lasting(const std::shared_ptr<const std::vector<Point2>>& hits) const;
  ScanAlignment match(const std::vector<SurfacePoint>& surface, const Pose2& predicted, const PredictedStep& step);
  bool believable(const ScanAlignment& found, const Pose2& predicted, const PredictedStep& step) const;
  Tracked go_on_blindly(const ScanPoints& points, const Pose2& predicted, const PredictedStep& step, double score);
  bool search_needed(const PredictedStep& step, double score) const;
  ScanAlignment search(const std::vector<SurfacePoint>& surface, const PosePrior& prior, const PredictedStep& step,
                       const ScanAlignment& so_far);
  bool far_from_last_node() const;
  void rebuild_map();
  void keep(const ScanPoints& points, Tracked& tracked);
  Tracked begin_piece(const ScanPoints& points, ScanFate fate);
  Eigen::Matrix3d match_covariance(const ScanAlignment& alignment) const;
  Tracked answer(ScanFate fate, double score) const;

  SlamParams by_lidar_, by_radar_;
  bool as_radar_ = false;
  SlamParams params_;  ///< one of the two
  SurfaceMap map_;
  std::deque<Node> nodes_;
  int nodes_since_rebuild_ = 0;
  Pose2 T_track_robot_;
  Eigen::Matrix3d blind_covariance_ =
      Eigen::Matrix3d::Zero();  ///< of predicted steps since the last match, track frame
  Eigen::Matrix3d predicted_covariance_ = Eigen::Matrix3d::Zero();  ///< of predicted steps since the last node
  int poor_in_a_row_ = 0;
  double usual_score_ = 0;
  bool started_ = false;
};

}  // namespace smokemap
