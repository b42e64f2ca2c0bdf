#include "acg/published_graph.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "acg/corner_links.hpp"
#include "acg/residuals/corner_cost.hpp"
#include "acg/residuals/drawn_vector_cost.hpp"
#include "acg/residuals/relative_pose_cost.hpp"
#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kSubmap_m = 2.0;    ///< of way between two poses of the graph
constexpr double kLandmark_m = 1.0;  ///< corners nearer than this are one
constexpr double kGate = 5.99;       ///< squared Mahalanobis distance, 2 degrees of freedom, 95 %
constexpr double kLink_m = 2.0, kUnlink_m = 3.0, kSigmaLink_m = 0.5;
constexpr double kSigmaObserved_m = 0.05;
constexpr double kStretch = 0.10;  ///< of a wall's length; a variance, as in the released program

/// Dynamic covariance scaling (Agarwal et al., ICRA 2013) of width phi, as a loss of the squared residual.
class ScalingLoss final : public ceres::LossFunction {
 public:
  explicit ScalingLoss(double phi) : phi_(phi) {}
  void Evaluate(double s, double out[3]) const override {
    if (s <= phi_) {
      out[0] = s, out[1] = 1, out[2] = 0;
      return;
    }
    const double sum = phi_ + s;
    out[0] = phi_ * (3 * s - phi_) / sum;
    out[1] = 4 * phi_ * phi_ / (sum * sum);
    out[2] = -8 * phi_ * phi_ / (sum * sum * sum);
  }

 private:
  double phi_;
};

struct Landmark {
  Point2 p_map = Point2::Zero();
  double orientation_rad = 0, opening_rad = 0;
  int seen = 0;
};

class PublishedGraph {
 public:
  PublishedGraph(PublishedMethod method, const PublishedInput& input, PlanModel plan)
      : in_(input), plan_(std::move(plan)), moves_poses_(method == PublishedMethod::kAcg2019) {}

  Result<MergedMap> run() {
    lay_down();
    choose_submaps();
    find_landmarks();
    for (const bool scaling : {false, true})
      if (const auto done = solve(scaling); !done) return done.error();
    return read_out();
  }

 private:
  struct Observation {
    std::size_t submap = 0, landmark = 0;
    Point2 seen_robot = Point2::Zero();
  };
  struct PlanLink {
    std::size_t submap = 0, landmark = 0;
    int corner = 0;
    Point2 seen_robot = Point2::Zero(), offset_map = Point2::Zero();
    double sigma_m = kSigmaLink_m;
  };

  void lay_down() {
    for (const Point2& p : plan_.corners) {
      const Point2 q = in_.map_from_layout * p;
      state_.corners.push_back({q.x(), q.y()});
    }
    drawn_ = state_;
    sectors_ = corner_sectors(plan_, drawn_);
  }

  void choose_submaps() {
    double way = kSubmap_m;
    for (std::size_t i = 0; i < in_.graph.nodes.size(); ++i) {
      const Pose2& pose = in_.graph.nodes[i].T_map_robot;
      if (i > 0) way += (in_.graph.nodes[i - 1].T_map_robot.inverse() * pose).translation().norm();
      if (way < kSubmap_m) continue;
      way = 0;
      submaps_.push_back(i);
      state_.poses.push_back({pose.x(), pose.y(), pose.heading()});
    }
  }

  void find_landmarks() {
    for (std::size_t k = 0; k < submaps_.size(); ++k) {
      const NodeView view = view_of(in_.graph.nodes[submaps_[k]], {});
      for (const Corner& c : view.corners) {
        const Point2 p = state_.pose(k) * c.position;
        std::size_t l = 0;
        while (l < landmarks_.size() && (landmarks_[l].p_map - p).norm() > kLandmark_m) ++l;
        if (l == landmarks_.size())
          landmarks_.push_back({p, wrap_angle(c.orientation_rad + state_.pose(k).heading()), c.opening_rad, 0});
        ++landmarks_[l].seen;
        observations_.push_back({k, l, c.position});
        if (moves_poses_) link_localized(k, l, c);
      }
    }
    if (!moves_poses_) link_landmarks();
  }

  /// 2019: through the gate of the localiser's covariance, seen from where the localiser has the robot.
  void link_localized(std::size_t k, std::size_t landmark, const Corner& c) {
    const auto& localized = in_.localized[submaps_[k]];
    if (!localized) return;
    const Pose2& pose = localized->T_map_robot;
    const Eigen::Matrix2d information =
        (localized->covariance + kSigmaObserved_m * kSigmaObserved_m * Eigen::Matrix2d::Identity()).inverse();
    for (const CornerSector& s : sectors_) {
      const Point2 apart = drawn_.corner(s.corner) - s.offset_map - pose * c.position;
      if (apart.dot(information * apart) > kGate || !alike(s, c.orientation_rad + pose.heading())) continue;
      const double sigma = std::sqrt(0.5 * localized->covariance.trace());
      links_.push_back({k, landmark, s.corner, c.position, s.offset_map, std::max(0.02, sigma)});
    }
  }

  /// 2017: whatever is near.
  void link_landmarks() {
    for (std::size_t l = 0; l < landmarks_.size(); ++l)
      for (std::size_t c = 0; c < plan_.corners.size(); ++c)
        if ((drawn_.corner(static_cast<int>(c)) - landmarks_[l].p_map).norm() < kLink_m)
          links_.push_back({0, l, static_cast<int>(c), landmarks_[l].p_map, Point2::Zero(), kSigmaLink_m});
  }

  static bool alike(const CornerSector& s, double orientation_rad) {
    return std::abs(wrap_angle(s.orientation_rad - orientation_rad)) < kPi / 4;
  }

  Result<Ok> solve(bool scaling) {
    ceres::Problem problem;
    values_.clear();
    for (const auto& p : state_.poses) values_.insert(values_.end(), p.begin(), p.end());
    for (const auto& c : state_.corners) values_.insert(values_.end(), c.begin(), c.end());
    for (const Landmark& l : landmarks_) values_.insert(values_.end(), {l.p_map.x(), l.p_map.y()});
    const double width = moves_poses_ ? 100 : 1;
    const auto kernel = [&]() -> ceres::LossFunction* {
      if (scaling) return new ScalingLoss(width);
      return new ceres::HuberLoss(width);
    };
    add_walls(problem, kernel);
    add_links(problem, kernel);
    if (moves_poses_) add_poses(problem, kernel);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 30;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return fail(Errc::kNotConverged, "the published graph gave no usable answer");
    for (std::size_t i = 0; i < state_.poses.size(); ++i) std::copy_n(pose(i), 3, state_.poses[i].begin());
    for (std::size_t i = 0; i < state_.corners.size(); ++i)
      std::copy_n(corner(static_cast<int>(i)), 2, state_.corners[i].begin());
    for (std::size_t i = 0; i < landmarks_.size(); ++i)
      if (moves_poses_) landmarks_[i].p_map = {landmark(i)[0], landmark(i)[1]};
    return Ok{};
  }

  double* pose(std::size_t i) { return &values_[3 * i]; }
  double* corner(int i) { return &values_[3 * state_.poses.size() + 2 * static_cast<std::size_t>(i)]; }
  double* landmark(std::size_t i) { return &values_[3 * state_.poses.size() + 2 * state_.corners.size() + 2 * i]; }

  template <typename Kernel>
  void add_walls(ceres::Problem& problem, const Kernel& kernel) {
    const double across = moves_poses_ ? 0.05 : 0.005;
    for (const PlanEdge& w : plan_.walls) {
      if (!w.usable) continue;
      const Segment2 s = drawn_.segment(w);
      problem.AddResidualBlock(DrawnVectorCost::Create(s.b - s.a, std::sqrt(kStretch * s.length()), std::sqrt(across)),
                               kernel(), corner(w.corner_a), corner(w.corner_b));
    }
  }

  template <typename Kernel>
  void add_links(ceres::Problem& problem, const Kernel& kernel) {
    for (const PlanLink& l : links_) {
      if (moves_poses_) {
        problem.AddResidualBlock(CornerCost::Create(l.seen_robot, l.offset_map, l.sigma_m), kernel(), pose(l.submap),
                                 corner(l.corner));
        continue;
      }
      if ((state_.corner(l.corner) - landmarks_[l.landmark].p_map).norm() > kUnlink_m) continue;
      const Pose2 first = state_.pose(0);
      problem.AddResidualBlock(CornerCost::Create(first.inverse() * l.seen_robot, Point2::Zero(), l.sigma_m), kernel(),
                               pose(0), corner(l.corner));
    }
    if (problem.HasParameterBlock(pose(0))) problem.SetParameterBlockConstant(pose(0));
  }

  template <typename Kernel>
  void add_poses(ceres::Problem& problem, const Kernel& kernel) {
    for (const Observation& o : observations_)
      problem.AddResidualBlock(CornerCost::Create(o.seen_robot, Point2::Zero(), kSigmaObserved_m), kernel(),
                               pose(o.submap), landmark(o.landmark));
    for (std::size_t k = 0; k + 1 < submaps_.size(); ++k) {
      const Pose2 step =
          in_.graph.nodes[submaps_[k]].T_map_robot.inverse() * in_.graph.nodes[submaps_[k + 1]].T_map_robot;
      const Eigen::Matrix3d sqrt_information = Eigen::Vector3d(20, 20, 50).asDiagonal();
      problem.AddResidualBlock(RelativePoseCost::Create(step, sqrt_information), kernel(), pose(k), pose(k + 1));
    }
    if (problem.HasParameterBlock(pose(0))) problem.SetParameterBlockConstant(pose(0));
  }

  MergedMap read_out() const {
    MergedMap out;
    std::size_t k = 0;
    for (std::size_t i = 0; i < in_.graph.nodes.size(); ++i) {
      if (k + 1 < submaps_.size() && submaps_[k + 1] <= i) ++k;
      StampedPose p;
      p.stamp = in_.graph.nodes[i].stamp;
      p.T_map_robot =
          state_.pose(k) * (in_.graph.nodes[submaps_[k]].T_map_robot.inverse() * in_.graph.nodes[i].T_map_robot);
      out.trajectory.push_back(p);
    }
    std::vector<bool> linked(plan_.corners.size(), false);
    for (const PlanLink& l : links_) {
      linked[static_cast<std::size_t>(l.corner)] = true;
      const Point2 seen = moves_poses_ ? Point2(state_.pose(l.submap) * l.seen_robot) : l.seen_robot;
      out.links.push_back({seen, l.corner, LinkState::kKept});
    }
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < plan_.corners.size(); ++i) {
      const Point2 p = state_.corner(static_cast<int>(i));
      out.corners.push_back({in_.plan.corners[i].p_px, p, linked[i] ? 0.3 : 1.0, static_cast<bool>(linked[i])});
      pairs.push_back({p, plan_.corners[i], 1.0});
    }
    for (std::size_t w = 0; w < plan_.walls.size(); ++w) {
      MergedWall wall;
      wall.layout_wall = static_cast<int>(w);
      wall.segment_map = state_.segment(plan_.walls[w]);
      const bool known = linked[static_cast<std::size_t>(plan_.walls[w].corner_a)] ||
                         linked[static_cast<std::size_t>(plan_.walls[w].corner_b)];
      wall.state = known ? WallState::kConfirmed : WallState::kUnseen;
      wall.confidence = 0.5;
      out.walls.push_back(wall);
    }
    if (auto deformation = Deformation::build(pairs); deformation.ok()) out.layout_to_map = std::move(*deformation);
    return out;
  }

  const PublishedInput& in_;
  PlanModel plan_;
  bool moves_poses_;
  GraphState state_, drawn_;
  std::vector<CornerSector> sectors_;
  std::vector<std::size_t> submaps_;
  std::vector<Landmark> landmarks_;
  std::vector<Observation> observations_;
  std::vector<PlanLink> links_;
  std::vector<double> values_;
};

}  // namespace

Result<MergedMap> merge_as_published(PublishedMethod method, const PublishedInput& input) {
  if (input.graph.nodes.empty()) return fail(Errc::kDegenerate, "no node to merge the plan with");
  auto plan = make_plan_model(input.plan, {});
  if (!plan) return plan.error();
  PublishedInput complete = input;
  complete.localized.resize(input.graph.nodes.size());
  return PublishedGraph(method, complete, std::move(*plan)).run();
}

}  // namespace smokemap
