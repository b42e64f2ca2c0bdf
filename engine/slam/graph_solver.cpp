#include "slam/graph_solver.hpp"

#include <ceres/ceres.h>

#include <algorithm>

#include "slam/graph_edge_cost.hpp"

namespace smokemap {
namespace {

constexpr double kDoubtfulSigmas = 6.0;
constexpr double kRejectedSigmas = 12.0;

using State = std::vector<Eigen::Vector3d>;

Result<ceres::Solver::Summary> solve_once(const PoseGraph& graph, State& state, double kernel) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  ceres::CauchyLoss robust(kernel);
  for (const PoseEdge& edge : graph.edges) {
    auto* cost = new GraphEdgeCost(edge.T_from_to, edge.sqrt_information);
    problem.AddResidualBlock(cost, edge.kind == EdgeKind::kLoop ? &robust : nullptr,
                             state[static_cast<std::size_t>(edge.from)].data(),
                             state[static_cast<std::size_t>(edge.to)].data());
  }
  if (problem.HasParameterBlock(state.front().data())) problem.SetParameterBlockConstant(state.front().data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-5;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return fail(Errc::kNotConverged, "pose graph: " + summary.message);
  return summary;
}

Pose2 pose_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

double largest_loop_error(const PoseGraph& graph) {
  double most = 0;
  for (const PoseEdge& edge : graph.edges)
    if (edge.kind == EdgeKind::kLoop)
      most = std::max(most, edge_error_sigmas(edge, graph.nodes[static_cast<std::size_t>(edge.from)].T_map_robot,
                                              graph.nodes[static_cast<std::size_t>(edge.to)].T_map_robot));
  return most;
}

int judge_loops(PoseGraph& graph) {
  int rejected = 0;
  for (PoseEdge& edge : graph.edges) {
    if (edge.kind != EdgeKind::kLoop) continue;
    const double error = edge_error_sigmas(edge, graph.nodes[static_cast<std::size_t>(edge.from)].T_map_robot,
                                           graph.nodes[static_cast<std::size_t>(edge.to)].T_map_robot);
    edge.state = error > kRejectedSigmas   ? LinkState::kRejected
                 : error > kDoubtfulSigmas ? LinkState::kDoubtful
                                           : LinkState::kKept;
    rejected += edge.state == LinkState::kRejected;
  }
  return rejected;
}

}  // namespace

double edge_error_sigmas(const PoseEdge& edge, const Pose2& T_map_from, const Pose2& T_map_to) {
  const Pose2 seen = T_map_from.inverse() * T_map_to;
  Eigen::Vector3d error = seen.vector() - edge.T_from_to.vector();
  error.z() = wrap_angle(error.z());
  return (edge.sqrt_information * error).norm();
}

Result<SolveSummary> solve_pose_graph(PoseGraph& graph, const GraphParams& params, const Progress& progress) {
  SolveSummary result;
  if (graph.nodes.size() < 2 || graph.edges.empty()) return result;
  State state;
  for (const PoseNode& node : graph.nodes) state.push_back(node.T_map_robot.vector());
  bool first = true;
  // Wide kernels are for loops that pull from afar; where all lie in the narrow one already it says the same at once.
  const bool all_near = largest_loop_error(graph) < params.loop_kernel;
  for (const double widen : {8.0, 2.0, 1.0}) {
    if (all_near && widen > 1) continue;
    if (progress.cancelled()) return fail(Errc::kCancelled, "pose graph solve stopped");
    const auto summary = solve_once(graph, state, widen * params.loop_kernel);
    if (!summary) return summary.error();
    if (first) result.cost_before = summary->initial_cost;
    result.cost_after = summary->final_cost;
    first = false;
  }
  for (std::size_t i = 0; i < state.size(); ++i) graph.nodes[i].T_map_robot = pose_of(state[i]);
  result.rejected = judge_loops(graph);
  return result;
}

}  // namespace smokemap
