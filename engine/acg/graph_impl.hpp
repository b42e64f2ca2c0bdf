#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "acg/anchors.hpp"
#include "acg/auto_complete_graph.hpp"
#include "acg/first_alignment.hpp"
#include "acg/line_search.hpp"
#include "acg/node_store.hpp"
#include "acg/read_out.hpp"
#include "acg/solver.hpp"
#include "acg/wall_evidence.hpp"

namespace smokemap {

/// A pair that a person vouches for.
struct GraphAnchor {
  Point2 p_px = Point2::Zero(), p_map = Point2::Zero();
};

/// The works of the Auto-Complete Graph: how it begins (graph_start.cpp), a round of linking and solving
/// (graph_rounds.cpp), other places for its lines (graph_lines.cpp), what people say (graph_words.cpp), an update as a
/// whole (auto_complete_graph.cpp).
class AutoCompleteGraph::Impl {
 public:
  explicit Impl(const AcgParams& p) : params(p), nodes(p) {}

  /// What a failed update must not change is kept here and copied.
  struct Learnt {
    GraphState state;
    bool aligned = false;
    double taken_way_m = 0;
    double aligned_way_m = 0;  ///< way that was known when the plan was last laid down, or when that was last tried
    std::vector<WallState> walls;
    std::vector<double> linked_m, near_m;         ///< per wall: length with pieces on it, within its gate
    std::vector<double> sigma_m;                  ///< per corner
    std::map<std::string, double> robot_sigma_m;  ///< of each robot's newest pose
    std::vector<double> rivals_m;  ///< per wall: how far beside it stands what might be it as well; 0: nothing
    BeamMemory beams;
    int updates = 0;
    double searched_way_m = 0;  ///< way that was known when other places of its lines were last looked for
    std::array<std::vector<LineBelief>, 2> beliefs;
    double gate_share = 1;  ///< of how far walls are looked for from where they are expected
    bool fits = false;      ///< what was said of the plan the last time
  };

  Result<MergedMap> update(const PoseGraph& graph, const Progress& progress);
  Result<Ok> correct(Learnt& learnt, bool warm, const Progress& progress, SolveInput& last) const;
  bool align(Learnt& learnt) const;
  bool choose(const std::vector<PlanAlignment>& found, Learnt& learnt) const;
  double first_metres_explained(Learnt& trial, double way_m) const;
  double standing(const SolveInput& input, const std::vector<bool>& use, const Learnt& learnt) const;
  Result<Ok> question(Learnt& learnt, SolveInput& last, const Progress& progress) const;
  Result<Ok> look_again(double gate_share, Learnt& learnt, SolveInput& last, const Progress& progress) const;
  Result<Ok> rearrange(Learnt& learnt, SolveInput& last, const Progress& progress) const;
  Result<bool> rearrange_axis(std::size_t axis, const std::vector<LineBelief::Move>& moves, Learnt& learnt,
                              SolveInput& last, const Progress& progress) const;
  LineHolds line_holds(const Learnt& learnt) const;
  AcgParams stretch_learnt(const Learnt& learnt) const;
  double doubt_of(const Learnt& learnt, std::size_t wall) const;
  double line_doubt_of(const Learnt& learnt, std::size_t wall) const;
  Result<Ok> work_out_sigmas(const SolveInput& last, const PoseGraph& graph, Learnt& learnt) const;
  void put_down(const PlanPlacement& placement, Learnt& learnt) const;
  Result<Ok> take_up(Learnt& learnt, const Progress& progress) const;
  Result<Ok> release_tense(Learnt& learnt, const SolveInput& input, const Progress& progress) const;
  Result<Ok> round(Learnt& learnt, const std::vector<bool>& use, double sharpness, const PoseRange& free_poses,
                   const Progress& progress, SolveInput* kept) const;
  void follow(const GraphState& before, const PoseRange& free_poses, GraphState& state) const;
  SolveInput link(Learnt& learnt, const std::vector<bool>& use, const std::vector<double>& gates, double sharpness,
                  const PoseRange& free_poses) const;
  SolveInput make_input(const Learnt& learnt, const PoseRange& free_poses) const;
  std::vector<PointPair> anchor_pairs() const;
  std::vector<bool> outlying_anchors(const Learnt& learnt) const;
  std::vector<AnchorLink> anchor_links(const Learnt& learnt) const;
  std::vector<MergedAnchor> read_anchors(const Learnt& learnt) const;
  void judge_walls(const std::vector<WallEvidence>& evidence, Learnt& learnt) const;
  MergedMap read_out(const PoseGraph& graph, const SolveInput& input, Learnt& learnt) const;
  PlanFit plan_fit(const SolveInput& input, const MergedMap& merged, const Learnt& learnt) const;

  AcgParams params;
  NodeStore nodes;
  LayoutMap layout;
  std::optional<PlanModel> plan;
  std::optional<PlanStart> start;
  std::map<std::string, GraphAnchor> anchors;
  std::map<int, WallJudgement> judgements;
  std::map<int, Point2> pins;       ///< per corner, map
  std::map<int, double> lengths_m;  ///< per wall
  Learnt learnt;
  bool words_changed = false;  ///< people said something since the last update
  int revision = 0;
};

}  // namespace smokemap
