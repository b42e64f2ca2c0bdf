#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "acg/acg_params.hpp"
#include "acg/graph_state.hpp"
#include "core/progress.hpp"
#include "core/result.hpp"
#include "maps/pose_graph.hpp"

namespace smokemap {

/// Poses from..to-1 by position; the first pose of all is never free.
struct PoseRange {
  std::size_t from = 0, to = 0;
  bool empty() const { return to <= std::max<std::size_t>(from, 1); }
  bool contains(std::size_t i) const { return i > 0 && i >= from && i < to; }
};

/// One round's problem: what is known, and with what weight.
struct SolveInput {
  const PlanModel* plan = nullptr;  ///< none: poses only
  std::vector<PoseEdge> edges;      ///< from, to: positions in GraphState::poses
  std::vector<PieceLink> links;
  std::vector<EndLink> ends;
  std::vector<CornerLink> corners;
  std::vector<AnchorLink> anchors;
  std::vector<CornerPin> pins;
  std::vector<WallLength> lengths;
  std::optional<StartHold> start;
  std::vector<double>
      wall_firmness;     ///< per wall 0..1: how much the plan's shape counts (low for a wall that is not there)
  PoseRange free_poses;  ///< the others stay where they are
  int iterations = 10;
};

/// Levenberg-Marquardt over everything in the state; the first pose stays. One thread, deterministic.
/// kNotConverged when the answer is not usable (the state is then unchanged), kCancelled on request.
Result<Ok> solve(const SolveInput& input, const AcgParams& params, const Progress& progress, GraphState& state);

/// Works out the plan's even_corners and even_lines. kNotConverged: they stay empty.
Result<Ok> even_out(const AcgParams& params, PlanModel& plan);

/// One standard deviation per coordinate, against the first pose of all.
struct Sigmas {
  std::vector<double> corners_m;
  std::vector<double> poses_m;  ///< of those asked for
};

/// Of every corner and of the poses asked for (positions in GraphState::poses), from the inverse of the normal
/// equations at the solution; of corners plus what the model leaves out (wall thickness, a sensor's own bias). Without
/// a plan: 0. Cost: one sparse factorisation and two solves each.
Result<Sigmas> sigmas_at(const SolveInput& input, const AcgParams& params, const GraphState& state,
                         const std::vector<std::size_t>& poses = {});

}  // namespace smokemap
