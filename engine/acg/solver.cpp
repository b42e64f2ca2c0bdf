#include "acg/solver.hpp"

#include <ceres/ceres.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "acg/residuals/anchor_cost.hpp"
#include "acg/residuals/corner_cost.hpp"
#include "acg/residuals/drawn_line_cost.hpp"
#include "acg/residuals/neighbour_stretch_cost.hpp"
#include "acg/residuals/piece_to_wall_cost.hpp"
#include "acg/residuals/pin_cost.hpp"
#include "acg/residuals/prior_value_cost.hpp"
#include "acg/residuals/relative_pose_cost.hpp"
#include "acg/residuals/start_cost.hpp"
#include "acg/residuals/strip_stretch_cost.hpp"
#include "acg/residuals/wall_end_cost.hpp"
#include "acg/residuals/wall_length_cost.hpp"
#include "acg/residuals/wall_shape_cost.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kEdgeWidth = 3.0;  ///< sigmas from which SLAM is thought to have slipped
constexpr double kLinesKnow = 2.5;  ///< times less sure than a wall that no line knows
constexpr double kSigmaPin_m = 0.003;
constexpr double kSigmaMeasured_m = 0.003;
constexpr double kStartWidth = 2.0;      ///< sigmas from which a person is thought to have pointed elsewhere
constexpr double kApartLines_m = 1.0;    ///< lines nearer to each other say little about places far from them
constexpr double kUnmodelled_m = 0.007;  ///< drawn wall thickness against the true one, bias of the sensor

/// A weight that does not depend on the residual: the robust scheme sets it between solves.
ceres::LossFunction* weighted(double weight) { return new ceres::ScaledLoss(nullptr, weight, ceres::TAKE_OWNERSHIP); }

/// The state in one piece of memory. Ceres orders blocks by address: in one piece the order, and with it every last bit
/// of the answer, is the same in each run.
class ParameterBlocks {
 public:
  explicit ParameterBlocks(const GraphState& state)
      : corners_at_(3 * state.poses.size()),
        plan_at_(corners_at_ + 2 * state.corners.size()),
        lines_at_{plan_at_ + 2, plan_at_ + 2 + state.lines[0].size()} {
    for (const auto& pose : state.poses) values_.insert(values_.end(), pose.begin(), pose.end());
    for (const auto& corner : state.corners) values_.insert(values_.end(), corner.begin(), corner.end());
    values_.push_back(state.turn);
    values_.push_back(state.log_scale);
    for (const auto& lines : state.lines) values_.insert(values_.end(), lines.begin(), lines.end());
  }
  double* pose(std::size_t i) { return &values_[3 * i]; }
  double* corner(std::size_t i) { return &values_[corners_at_ + 2 * i]; }
  double* turn() { return &values_[plan_at_]; }
  double* log_scale() { return &values_[plan_at_ + 1]; }
  double* line(std::size_t axis, std::size_t i) { return &values_[lines_at_[axis] + i]; }

  void write_to(GraphState& state) {
    for (std::size_t i = 0; i < state.poses.size(); ++i) std::copy_n(pose(i), 3, state.poses[i].begin());
    for (std::size_t i = 0; i < state.corners.size(); ++i) std::copy_n(corner(i), 2, state.corners[i].begin());
    state.turn = *turn();
    state.log_scale = *log_scale();
    for (std::size_t axis = 0; axis < 2; ++axis)
      for (std::size_t i = 0; i < state.lines[axis].size(); ++i) state.lines[axis][i] = *line(axis, i);
  }

 private:
  std::vector<double> values_;
  std::size_t corners_at_, plan_at_;
  std::array<std::size_t, 2> lines_at_;
};

/// The drawn lines on both sides of a place; of one outside of all, the outermost and one well behind it.
std::optional<std::pair<std::size_t, std::size_t>> lines_beside(const std::vector<double>& drawn, double at) {
  if (drawn.size() < 2) return std::nullopt;
  std::size_t next = static_cast<std::size_t>(std::upper_bound(drawn.begin(), drawn.end(), at) - drawn.begin());
  if (next > 0 && next < drawn.size()) return std::pair{next - 1, next};
  if (next == 0) {
    while (++next + 1 < drawn.size() && drawn[next] - drawn.front() < kApartLines_m) continue;
    return std::pair{std::size_t{0}, next};
  }
  std::size_t line = drawn.size() - 1;
  while (--line > 0 && drawn.back() - drawn[line] < kApartLines_m) continue;
  return std::pair{line, drawn.size() - 1};
}

class ProblemBuilder {
 public:
  ProblemBuilder(const SolveInput& input, const AcgParams& params, const GraphState& state, ParameterBlocks& blocks)
      : in_(input), params_(params), state_(state), blocks_(blocks) {}

  void build(ceres::Problem& problem) {
    add_poses(problem);
    if (in_.plan == nullptr) return;
    add_plan(problem);
    add_lines(problem, 0);
    add_lines(problem, 1);
    add_evidence(problem);
    add_words(problem);
    add_start(problem);
  }

 private:
  double* pose(std::size_t i) { return blocks_.pose(i); }
  double* corner(int i) { return blocks_.corner(static_cast<std::size_t>(i)); }
  bool even() const { return !in_.plan->even_corners.empty(); }
  const Point2& expected_corner(int i) const {
    return (even() ? in_.plan->even_corners : in_.plan->corners)[static_cast<std::size_t>(i)];
  }

  void add_poses(ceres::Problem& problem) {
    for (std::size_t i = 0; i < state_.poses.size(); ++i) {
      problem.AddParameterBlock(pose(i), 3);
      if (!in_.free_poses.contains(i)) problem.SetParameterBlockConstant(pose(i));
    }
    for (const PoseEdge& e : in_.edges) {
      const auto from = static_cast<std::size_t>(e.from), to = static_cast<std::size_t>(e.to);
      if (!in_.free_poses.contains(from) && !in_.free_poses.contains(to)) continue;
      problem.AddResidualBlock(RelativePoseCost::Create(e.T_from_to, e.sqrt_information),
                               new ceres::CauchyLoss(kEdgeWidth), pose(from), pose(to));
    }
  }

  void add_shape(ceres::Problem& problem, const PlanEdge& edge, double along_share, double firmness) {
    if (!edge.usable || firmness <= 0) return;
    const double corners = std::sqrt(2.0) * params_.sigma_corner_draw_m;
    const Segment2 drawn{expected_corner(edge.corner_a), expected_corner(edge.corner_b)};
    problem.AddResidualBlock(
        WallShapeCost::Create(drawn.length(), drawn.heading(), std::hypot(along_share * edge.length_m, corners),
                              std::hypot(params_.sigma_wall_turn_rad * edge.length_m, corners)),
        weighted(firmness), corner(edge.corner_a), corner(edge.corner_b), blocks_.turn(), blocks_.log_scale());
  }

  void add_plan(ceres::Problem& problem) {
    problem.AddResidualBlock(PriorValueCost::Create(0, in_.plan->scale_sigma), nullptr, blocks_.log_scale());
    problem.AddParameterBlock(blocks_.turn(), 1);
    for (std::size_t w = 0; w < in_.plan->walls.size(); ++w)
      add_shape(problem, in_.plan->walls[w], stretch_of(in_.plan->walls[w]), in_.wall_firmness[w]);
    for (const PlanEdge& g : in_.plan->gaps) add_shape(problem, g, 1.5 * stretch_of(g), 1);
  }

  /// The lines across a wall along one of the plan's axes know its stretch already; counted once for each wall between
  /// the same two lines, it would look surer than it is.
  double stretch_of(const PlanEdge& wall) const {
    return (in_.plan->offset_axis(wall) >= 0 ? kLinesKnow : 1.0) * params_.sigma_wall_log_length;
  }

  void add_lines(ceres::Problem& problem, int axis) {
    const auto& drawn = (even() ? in_.plan->even_lines : in_.plan->lines)[static_cast<std::size_t>(axis)];
    const auto& line_of = in_.plan->line_of_corner[static_cast<std::size_t>(axis)];
    const auto line = [&](std::size_t i) { return blocks_.line(static_cast<std::size_t>(axis), i); };
    const double heading = in_.plan->axis_rad + axis * kPi / 2;
    const Point2 across(std::cos(heading), std::sin(heading));
    for (std::size_t c = 0; c < line_of.size(); ++c) {
      const auto l = static_cast<std::size_t>(line_of[c]);
      const double offset = even() ? across.dot(in_.plan->even_corners[c]) - drawn[l] : 0;
      problem.AddResidualBlock(DrawnLineCost::Create(heading, offset, params_.sigma_corner_draw_m),
                               new ceres::CauchyLoss(2.0), corner(static_cast<int>(c)), blocks_.turn(), line(l),
                               blocks_.log_scale());
    }
    const double sigma = params_.sigma_wall_log_length;
    for (std::size_t k = 0; k + 1 < drawn.size(); ++k) {
      const double width = drawn[k + 1] - drawn[k];
      if (k == 0) {
        problem.AddResidualBlock(StripStretchCost::Create(width, sigma), nullptr, line(0), line(1),
                                 blocks_.log_scale());
        continue;
      }
      const double before = drawn[k] - drawn[k - 1], apart = 0.5 * (width + before);
      const double correlation = std::exp(-apart / (0.6 * params_.stretch_length_m));
      problem.AddResidualBlock(
          NeighbourStretchCost::Create(before, width, correlation, sigma * std::sqrt(1 - correlation * correlation)),
          nullptr, line(k - 1), line(k), line(k + 1), blocks_.log_scale());
    }
  }

  void add_evidence(ceres::Problem& problem) {
    for (const PieceLink& link : in_.links) {
      if (link.weight < 1e-3) continue;
      const PlanEdge& wall = in_.plan->walls[static_cast<std::size_t>(link.wall)];
      problem.AddResidualBlock(
          PieceToWallCost::Create(link.part_robot, link.side, wall.half_thickness_m, params_.sigma_point_m),
          weighted(link.weight), pose(link.node), corner(wall.corner_a), corner(wall.corner_b));
    }
    for (const EndLink& end : in_.ends)
      if (end.weight > 1e-3)
        problem.AddResidualBlock(WallEndCost::Create(end.end_robot, std::hypot(params_.sigma_end_m, end.sigma_m)),
                                 weighted(end.weight), pose(end.node), corner(end.corner), corner(end.other_corner));
    for (const CornerLink& c : in_.corners)
      if (c.weight > 1e-3)
        problem.AddResidualBlock(CornerCost::Create(c.seen_robot, c.offset_map, params_.sigma_seen_corner_m),
                                 weighted(c.weight), pose(c.node), corner(c.corner));
  }

  /// What people say is never weighted down.
  void add_words(ceres::Problem& problem) {
    for (const AnchorLink& a : in_.anchors)
      problem.AddResidualBlock(AnchorCost::Create(a.shares, a.p_map, AnchorCost::Finger{}), nullptr,
                               corner(a.corners[0]), corner(a.corners[1]), corner(a.corners[2]));
    for (const CornerPin& p : in_.pins)
      problem.AddResidualBlock(PinCost::Create(p.p_map, kSigmaPin_m), nullptr, corner(p.corner));
    for (const WallLength& l : in_.lengths) {
      const PlanEdge& wall = in_.plan->walls[static_cast<std::size_t>(l.wall)];
      problem.AddResidualBlock(WallLengthCost::Create(l.length_m, kSigmaMeasured_m), nullptr, corner(wall.corner_a),
                               corner(wall.corner_b));
    }
  }

  /// Until walls are known, nothing else says where the plan lies.
  void add_start(ceres::Problem& problem) {
    if (!in_.start) return;
    const StartHold& hold = *in_.start;
    const double turn = hold.T_map_robot.heading() - hold.T_layout_robot.heading();
    problem.AddResidualBlock(PriorValueCost::Create(state_.turn + wrap_angle(turn - state_.turn), hold.sigma_rad),
                             new ceres::CauchyLoss(kStartWidth), blocks_.turn());
    for (const std::size_t axis : {0u, 1u}) {
      const auto& drawn = in_.plan->lines[axis];
      const double heading = in_.plan->axis_rad + static_cast<double>(axis) * kPi / 2;
      const double at = Point2(std::cos(heading), std::sin(heading)).dot(hold.T_layout_robot.translation());
      const auto beside = lines_beside(drawn, at);
      if (!beside) continue;
      const auto [line, next] = *beside;
      problem.AddResidualBlock(StartCost::Create(heading, (at - drawn[line]) / (drawn[next] - drawn[line]),
                                                 hold.T_map_robot.translation(), hold.sigma_m),
                               new ceres::CauchyLoss(kStartWidth), blocks_.turn(), blocks_.line(axis, line),
                               blocks_.line(axis, next));
    }
  }

  const SolveInput& in_;
  const AcgParams& params_;
  const GraphState& state_;
  ParameterBlocks& blocks_;
};

class StopWhenAsked final : public ceres::IterationCallback {
 public:
  explicit StopWhenAsked(const Progress& progress) : progress_(progress) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return progress_.cancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const Progress& progress_;
};

/// J^T J of the whole problem, with a whisper on the diagonal for what nothing speaks about.
Eigen::SparseMatrix<double> normal_matrix(const ceres::CRSMatrix& jacobian) {
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const Eigen::Map<const Rows> rows(jacobian.num_rows, jacobian.num_cols,
                                    static_cast<Eigen::Index>(jacobian.values.size()), jacobian.rows.data(),
                                    jacobian.cols.data(), jacobian.values.data());
  const Eigen::SparseMatrix<double> columns(rows);
  Eigen::SparseMatrix<double> normal = columns.transpose() * columns;
  Eigen::SparseMatrix<double> whisper(normal.rows(), normal.cols());
  whisper.setIdentity();
  normal += 1e-4 * whisper;
  return normal;
}

}  // namespace

Result<Ok> solve(const SolveInput& input, const AcgParams& params, const Progress& progress, GraphState& state) {
  if (progress.cancelled()) return fail(Errc::kCancelled, "stopped while merging plan and map");
  ParameterBlocks blocks(state);
  ceres::Problem problem;
  ProblemBuilder(input, params, state, blocks).build(problem);
  StopWhenAsked stop(progress);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = input.iterations;
  options.function_tolerance = 1e-4;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (progress.cancelled()) return fail(Errc::kCancelled, "stopped while merging plan and map");
  if (!summary.IsSolutionUsable())
    return fail(Errc::kNotConverged, "merging plan and map gave no usable answer: " + summary.message);
  blocks.write_to(state);
  return Ok{};
}

/// The drawing solved by itself, at its own scale.
Result<Ok> even_out(const AcgParams& params, PlanModel& plan) {
  constexpr double kOwnScale = 1e-6;
  constexpr int kEnough = 30;
  PlanModel drawing = plan;
  drawing.scale_sigma = kOwnScale;
  drawing.even_corners.clear();
  SolveInput input;
  input.plan = &drawing;
  input.wall_firmness.assign(plan.walls.size(), 1);
  input.iterations = kEnough;
  GraphState state;
  for (const Point2& p : plan.corners) state.corners.push_back({p.x(), p.y()});
  state.lines = plan.lines;
  if (const auto done = solve(input, params, {}, state); !done) return done;
  plan.even_corners.clear();
  const Eigen::Matrix2d back = Pose2(0, 0, -state.turn).rotation();
  for (const auto& c : state.corners) plan.even_corners.push_back(back * Point2(c[0], c[1]));
  plan.even_lines = state.lines;
  return Ok{};
}

Result<Sigmas> sigmas_at(const SolveInput& input, const AcgParams& params, const GraphState& state,
                         const std::vector<std::size_t>& poses) {
  Sigmas sigmas{std::vector<double>(state.corners.size(), 0), std::vector<double>(poses.size(), 0)};
  if (input.plan == nullptr) return sigmas;
  ParameterBlocks memory(state);
  ceres::Problem problem;
  ProblemBuilder(input, params, state, memory).build(problem);
  ceres::Problem::EvaluateOptions what;
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  std::map<const double*, int> first_column;
  int column = 0;
  for (double* block : blocks) {
    if (problem.IsParameterBlockConstant(block)) continue;
    what.parameter_blocks.push_back(block);
    first_column[block] = column;
    column += problem.ParameterBlockSize(block);
  }
  ceres::CRSMatrix jacobian;
  if (!problem.Evaluate(what, nullptr, nullptr, nullptr, &jacobian))
    return fail(Errc::kNotConverged, "the sigmas of the merged map could not be worked out");
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal_matrix(jacobian));
  if (factor.info() != Eigen::Success)
    return fail(Errc::kNotConverged, "the sigmas of the merged map could not be worked out");
  const auto sigma_m = [&](const double* block, double unmodelled_m) {
    const auto first = first_column.find(block);
    if (first == first_column.end()) return 0.0;
    double variance = 0;
    for (int k = 0; k < 2; ++k) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(jacobian.num_cols, first->second + k);
      variance += 0.5 * factor.solve(unit)[first->second + k];
    }
    return std::hypot(std::sqrt(std::max(0.0, variance)), unmodelled_m);
  };
  for (std::size_t c = 0; c < state.corners.size(); ++c) sigmas.corners_m[c] = sigma_m(memory.corner(c), kUnmodelled_m);
  for (std::size_t i = 0; i < poses.size(); ++i) sigmas.poses_m[i] = sigma_m(memory.pose(poses[i]), 0);
  return sigmas;
}

}  // namespace smokemap
