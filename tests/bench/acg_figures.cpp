#include "tests/bench/acg_figures.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "acg/auto_complete_graph.hpp"
#include "acg/published_graph.hpp"
#include "acg/scan_pieces.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "localization/localize_nodes.hpp"
#include "slam/slam.hpp"
#include "tests/bench/acg_score_figures.hpp"

namespace smokemap::bench {
namespace {

constexpr double kRun_s = 180;  ///< some 65 m of way, as in the published protocol

/// Wheels that are wrong by `noise` of each step in x, y and turn.
class BadWheels {
 public:
  BadWheels(double noise, std::mt19937_64 random) : noise_(noise), random_(std::move(random)) { draw(); }

  Pose2 wrong(const Pose2& T_odom_robot) {
    if (first_) last_true_ = last_wrong_ = T_odom_robot;
    first_ = false;
    const Pose2 step = last_true_.inverse() * T_odom_robot;
    last_true_ = T_odom_robot;
    way_m_ += step.translation().norm();
    if (way_m_ > 2) draw();
    const double length = step.translation().norm();
    last_wrong_ = last_wrong_ * Pose2(step.x() + sign_[0] * noise_ * length, step.y() + sign_[1] * noise_ * length,
                                      step.heading() * (1 + sign_[2] * noise_));
    return last_wrong_;
  }

 private:
  void draw() {
    way_m_ = 0;
    for (double& s : sign_) s = uniform01(random_) < 0.5 ? -1 : 1;
  }
  double noise_, way_m_ = 0;
  double sign_[3] = {1, 1, 1};
  bool first_ = true;
  Pose2 last_true_, last_wrong_;
  std::mt19937_64 random_;
};

PoseGraph map_of(const RecordedRun& run, double noise, std::uint64_t seed) {
  BadWheels wheels(noise, random_stream(seed, 77));
  Slam slam;
  std::size_t scans = 0;
  for (const auto& item : run.items) {
    if (const auto* odometry = std::get_if<Odometry>(&item)) {
      Odometry bad = *odometry;
      bad.T_odom_robot = wheels.wrong(odometry->T_odom_robot);
      slam.add_odometry(bad);
    }
    const auto* scan = std::get_if<LaserScan>(&item);
    if (scan == nullptr) continue;
    (void)slam.add_scan(*scan).ok();
    if (++scans % 20 == 0) slam.optimize();
  }
  slam.polish();
  return slam.graph();
}

PoseGraph first_part(const PoseGraph& graph, std::size_t nodes) {
  PoseGraph part;
  part.nodes.assign(graph.nodes.begin(), graph.nodes.begin() + static_cast<std::ptrdiff_t>(nodes));
  for (const PoseEdge& e : graph.edges)
    if (std::max(e.from, e.to) < static_cast<int>(nodes)) part.edges.push_back(e);
  return part;
}

/// Something with a corner that no plan shows stands before the robot: the beams end on it.
void stand_in_the_way(std::vector<Point2>& hits, const Pose2& T_robot_thing) {
  constexpr double kArm_m = 0.45;
  const Segment2 arms[2] = {{T_robot_thing.translation(), T_robot_thing * Point2(kArm_m, 0)},
                            {T_robot_thing.translation(), T_robot_thing * Point2(0, kArm_m)}};
  for (Point2& hit : hits)
    for (const Segment2& arm : arms)
      if (const auto p = intersection({0.05 * hit.normalized(), hit}, arm)) hit = *p;
}

/// Adds things with corners until their share of the corners a scan shows is reached.
void add_spurious_corners(double share, std::uint64_t seed, PoseGraph& graph) {
  auto random = random_stream(seed, 78);
  for (PoseNode& node : graph.nodes) {
    if (!node.hits_robot || node.hits_robot->empty()) continue;
    auto hits = std::make_shared<std::vector<Point2>>(*node.hits_robot);
    const double wanted = share * static_cast<double>(view_of(node, {}).corners.size());
    for (double made = 0; made < wanted; ++made) {
      const Point2 beyond = (*hits)[uniform_index(random, hits->size())];
      stand_in_the_way(*hits, Pose2(uniform(random, 0.4, 0.8) * beyond, uniform(random, -kPi, kPi)));
    }
    node.hits_robot = hits;
  }
}

PlanStart start_of(const AcgScenario& scenario, const DemoScenario& demo, std::uint64_t seed) {
  auto random = random_stream(seed, 79);
  const double where = uniform(random, -kPi, kPi), sign = uniform01(random) < 0.5 ? -1 : 1;
  PlanStart start;
  start.T_layout_robot = Pose2(Point2(demo.truth.layout.frame().to_metres(demo.true_start.layout_px) +
                                      scenario.start_m * Point2(std::cos(where), std::sin(where))),
                               demo.true_start.heading_rad + sign * radians(scenario.start_deg));
  start.sigma_m = std::max(0.1, scenario.start_m / std::sqrt(2.0));
  start.sigma_rad = std::max(0.02, radians(scenario.start_deg));
  return start;
}

/// The same problem as the published programs would have taken it.
Result<MergedMap> published(PublishedMethod method, const DemoScenario& demo, const PoseGraph& graph,
                            const PlanStart& start) {
  PublishedInput input{demo.truth.layout, {1, start.T_layout_robot.inverse()}, graph, {}};
  std::vector<LocalizerWall> walls;
  for (std::size_t w = 0; w < input.plan.walls.size(); ++w) {
    const Segment2 s = input.plan.wall_m(static_cast<int>(w));
    walls.push_back({{input.map_from_layout * s.a, input.map_from_layout * s.b},
                     input.plan.walls[w].thickness_px * input.plan.frame().metres_per_pixel});
  }
  for (const LocalizerEstimate& e : localize_nodes(walls, graph, {})) {
    input.localized.emplace_back();
    if (!e.lost) input.localized.back() = LocalizedNode{e.T_map_robot, e.covariance.topLeftCorner<2, 2>()};
  }
  return merge_as_published(method, input);
}

int inner_walls(const FloorPlan& building) {
  int count = 0;
  for (std::size_t w = 0; w < building.walls.size(); ++w) {
    const auto [left, right] = building.rooms_beside(static_cast<int>(w));
    count += left >= 0 && right >= 0 && building.wall_line(static_cast<int>(w)).length() >= 2;
  }
  return count;
}

}  // namespace

double cpu_now_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

Result<AcgProblem> make_acg_problem(const AcgScenario& scenario, std::uint64_t seed) {
  DemoParams params;
  params.fire = false;
  params.distortion.sigma_stretch = scenario.stretch;
  params.distortion.sigma_corner_m = 0.05;
  auto random = random_stream(seed, 76);
  auto building = random_building(params.building, random);
  if (!building) return building.error();
  const int inner = inner_walls(*building);
  params.distortion.missing_walls = static_cast<int>(std::lround(scenario.missing_share * inner));
  params.distortion.phantom_walls = static_cast<int>(std::lround(scenario.phantom_share * inner));
  auto demo = make_demo_in(std::move(*building), std::nullopt, seed, params);
  if (!demo) return demo.error();
  RunParams drive;
  drive.with_radar = false;
  drive.max_duration_s = kRun_s;
  auto run = record_run(*demo, drive);
  if (!run) return run.error();
  return AcgProblem{std::move(*demo), std::move(*run)};
}

Result<AcgScore> run_acg(const AcgScenario& scenario, const AcgProblem& problem, std::uint64_t seed, AcgMethod method) {
  PoseGraph graph = map_of(problem.run, scenario.noise, seed);
  if (scenario.spurious_share > 0) add_spurious_corners(scenario.spurious_share, seed, graph);
  const PlanStart start = start_of(scenario, problem.demo, seed);
  AutoCompleteGraph acg;
  if (const auto set = acg.set_plan(problem.demo.truth.layout, start); !set) return set.error();
  AcgScore out;
  std::vector<double> updates_s;
  const bool online = scenario.online && method == AcgMethod::kOurs;
  for (std::size_t n = online ? 1 : graph.nodes.size(); n <= graph.nodes.size(); ++n) {
    const PoseGraph part = first_part(graph, n);
    const double begin = cpu_now_s();
    const auto merged = method == AcgMethod::kOurs ? acg.update(part)
                                                   : published(method == AcgMethod::k2017 ? PublishedMethod::kAcg2017
                                                                                          : PublishedMethod::kAcg2019,
                                                               problem.demo, part, start);
    updates_s.push_back(cpu_now_s() - begin);
    if (!merged) return merged.error();
    if (online) {
      TurnedWall turned = most_turned(problem.demo, *merged);
      turned.nodes = n;
      out.plan_turned_deg = std::max(out.plan_turned_deg, std::abs(turned.plan_turned_deg));
      if (turned.turned_deg > out.turned_deg) out.turned = turned, out.turned_deg = turned.turned_deg;
    }
    if (n == graph.nodes.size()) score_merged({problem.demo, problem.run, graph, start}, *merged, out);
  }
  out.slowest_s = *std::max_element(updates_s.begin(), updates_s.end());
  out.update_s = median_of(updates_s);
  return out;
}

}  // namespace smokemap::bench
