#pragma once

#include <memory>
#include <optional>
#include <string>

#include "acg/acg_params.hpp"
#include "core/progress.hpp"
#include "core/result.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

/// "The robot's first pose is here on the plan": pose in `layout` (metres, y up), with what is known about its error.
struct PlanStart {
  Pose2 T_layout_robot;
  double sigma_m = 0.3;
  double sigma_rad = 0.05;
};

/// What a person says about a wall of the plan; survives every update until it is taken back.
enum class WallJudgement { kNone, kGone, kThere };

/// The Auto-Complete Graph: an evacuation plan and a robot's map correct each other.
///
/// One least-squares problem over robot poses, plan corners, the plan's turn and scale, and its drawn lines. The plan
/// holds together by walls that may stretch but hardly turn, and by lines: what is drawn in line stays in line, and
/// neighbouring strips of the sheet are stretched alike, so rooms that nobody saw move sensibly too
/// (docs/residuals.md). Scans speak through straight pieces that lie on one face of a wall, and through seen ends of
/// walls. Links are made anew with the current estimate in every round and weighted by graduated non-convexity; a wall
/// moves by itself only with mature evidence.
///
/// The plan is taken up outward from where the robot started, so `update` is meant to be called often, with a growing
/// graph: warm-started, deterministic, <= 0.3 s at 100 nodes and 400 walls. `map` is SLAM's map frame.
/// Not thread-safe; one per floor. Source: Mielle, Magnusson, Lilienthal, SSRR 2017 and Robotics 2019 8(2) 40. Differs:
/// scale-free wall factors, point-to-wall against both corners and the seen face, real robust weights, structure
/// changes.
class AutoCompleteGraph {
 public:
  explicit AutoCompleteGraph(const AcgParams& params = {});
  ~AutoCompleteGraph();
  AutoCompleteGraph(AutoCompleteGraph&&) noexcept;
  AutoCompleteGraph& operator=(AutoCompleteGraph&&) noexcept;

  /// Replaces the plan and forgets everything learnt about the old one (anchors and judgements too). A plan without a
  /// scale gets a guess from its doors, or 0.03 m per pixel, with a wide sigma. kDegenerate without walls.
  Result<Ok> set_plan(const LayoutMap& plan, const std::optional<PlanStart>& start = std::nullopt);
  void clear_plan();
  /// Where the robot's first pose is; the alignment starts again from here.
  void set_start(const PlanStart& start);
  /// A pair that a person vouches for; never weighted down. Adds, or moves the one with this id. Two or more align the
  /// plan without a start.
  void add_anchor(const std::string& id, const Point2& p_layout_px, const Point2& p_map);
  void remove_anchor(const std::string& id);
  /// kNotFound for a wall that the plan does not have.
  Result<Ok> judge_wall(int layout_wall, WallJudgement judgement);
  /// "This corner of the plan is here": holds it there within a centimetre, whatever sensors say. Nothing takes the pin
  /// out. kNotFound for a corner that the plan does not have.
  Result<Ok> pin_corner(int layout_corner, const std::optional<Point2>& p_map);
  /// "This wall is 4.2 m long": holds its length within a centimetre. Nothing takes it back. kNotFound for a wall that
  /// the plan does not have, kInvalidArgument for a length that no wall has.
  Result<Ok> set_wall_length(int layout_wall, const std::optional<double>& length_m);

  /// Takes up what is new in the graph (nodes may be added and poses may be corrected by SLAM; ids must stay) and
  /// solves. Without a plan, or before the plan is aligned, the answer holds SLAM's trajectory and all sensed walls as
  /// new. kCancelled, kNotConverged: the state is as before the call.
  Result<MergedMap> update(const PoseGraph& slam_graph, const Progress& progress = {});

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// A robot's pose at any time from its corrected nodes: the correction of the one before and the one after, blended,
/// applied to `T_slam_robot` (its uncorrected pose at that time). As it is for a robot without nodes. `graph` and
/// `merged.trajectory` belong together; a robot's nodes come in the order of their stamps. Cost: nodes.
Pose2 corrected_pose(const PoseGraph& graph, const MergedMap& merged, const std::string& robot, Stamp stamp,
                     const Pose2& T_slam_robot);

}  // namespace smokemap
