// The Auto-Complete Graph, white box: ./run bench acg [--seeds N] [--only TEXT] [--online] [--acg2017 | --acg2019]
// Data: simulation (generated buildings, wrong plans of them, a robot's lidar and wheels through them), seeds 1..N, the
// real front end (SLAM) and the real alignment in the loop, no true pose anywhere. Median over the seeds, the worst in
// brackets. --online updates after every node and measures each update (one thread's CPU time, plan's walls and nodes
// as they come); without it the whole run is merged at once.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "acg/auto_complete_graph.hpp"
#include "acg/published_graph.hpp"
#include "core/random.hpp"
#include "geometry/angle.hpp"
#include "localization/localize_nodes.hpp"
#include "simulation/demo_scenario.hpp"
#include "simulation/recorded_run.hpp"
#include "slam/slam.hpp"

namespace {

using namespace smokemap;

struct Scenario {
  std::string name;
  DemoParams demo;
  double noise = 0;  ///< of the wheels: share of each step's way and turn, the sign holds for two metres (Paper V)
};

enum class Method { kOurs, k2017, k2019 };

struct Score {
  double pose_m = 0, yaw_rad = 0;
  double before_m = 0, seen_m = 0, never_before_m = 0, never_m = 0;
  double within_seen = 0, within_never = 0;  ///< share of errors within two sigma
  double links_right = 0, links_found = 0;
  double missing_right = 1, missing_found = 1, new_right = 1, new_found = 1;
  double update_s = 0, slowest_s = 0, turned_deg = 0;
  bool success = false;
};

double cpu_now_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double share_of(double part, double all) { return all > 0 ? part / all : 1; }

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

bool well_seen(const DemoScenario& demo, const RecordedRun& run, std::size_t corner, double radius_m, int least) {
  int echoes = 0;
  for (std::size_t w = 0; w < demo.truth.layout.walls.size(); ++w)
    if (demo.truth.wall_source[w] >= 0)
      echoes += run.witness.echoes_near(static_cast<int>(w), demo.truth.corner_world[corner], radius_m);
  return echoes >= least;
}

bool of_a_true_wall(const DemoScenario& demo, std::size_t corner) {
  for (std::size_t w = 0; w < demo.truth.layout.walls.size(); ++w) {
    const LayoutWall& wall = demo.truth.layout.walls[w];
    const bool touches = wall.corner_a == static_cast<int>(corner) || wall.corner_b == static_cast<int>(corner);
    if (touches && demo.truth.wall_source[w] >= 0) return true;
  }
  return false;
}

void score_corners(const DemoScenario& demo, const RecordedRun& run, const PlanStart& start, const MergedMap& merged,
                   Score& out) {
  std::vector<double> before, after, never_before, never;
  double within = 0, never_within = 0;
  const PixelFrame frame = demo.truth.layout.frame();
  for (std::size_t i = 0; i < merged.corners.size(); ++i) {
    if (!of_a_true_wall(demo, i)) continue;
    const Point2 truth = demo.to_map(demo.truth.corner_world[i]);
    const Point2 rigid = start.T_layout_robot.inverse() * frame.to_metres(demo.truth.layout.corners[i].p_px);
    const double error = (merged.corners[i].p_map - truth).norm();
    const bool inside = error <= 2 * merged.corners[i].sigma_m;
    if (well_seen(demo, run, i, 0.6, 16)) {
      before.push_back((rigid - truth).norm());
      after.push_back(error);
      within += inside;
    } else if (!well_seen(demo, run, i, 1.0, 1)) {
      never_before.push_back((rigid - truth).norm());
      never.push_back(error);
      never_within += inside;
    }
  }
  out.before_m = middle_of(before), out.seen_m = middle_of(after);
  out.never_before_m = middle_of(never_before), out.never_m = middle_of(never);
  out.within_seen = share_of(within, static_cast<double>(after.size()));
  out.within_never = share_of(never_within, static_cast<double>(never.size()));
}

/// A link is right when the corner truly lies behind the seen crossing: within a wall's thickness and some.
void score_links(const DemoScenario& demo, const RecordedRun& run, const MergedMap& merged, Score& out) {
  double kept = 0, right = 0, corners = 0, found = 0;
  std::vector<bool> linked(merged.corners.size(), false);
  for (const MapLink& link : merged.links) {
    if (link.state != LinkState::kKept) continue;
    const auto c = static_cast<std::size_t>(link.layout_corner);
    const bool good = of_a_true_wall(demo, c) && (link.p_map - demo.to_map(demo.truth.corner_world[c])).norm() < 0.40;
    ++kept, right += good;
    linked[c] = linked[c] || good;
  }
  for (std::size_t c = 0; c < linked.size(); ++c) {
    if (demo.truth.layout.corners[c].degree < 2 || !of_a_true_wall(demo, c) || !well_seen(demo, run, c, 0.6, 60))
      continue;
    ++corners, found += linked[c];
  }
  out.links_right = share_of(right, kept), out.links_found = share_of(found, corners);
}

double beside_m(const Segment2& s, const std::vector<Segment2>& others) {
  double near = 0;
  for (double t = 0.05; t < s.length(); t += 0.1) {
    const Point2 p = s.a + t * s.direction();
    near +=
        std::any_of(others.begin(), others.end(), [&](const Segment2& o) { return distance(o, p) < 0.3; }) ? 0.1 : 0;
  }
  return near;
}

void score_walls(const DemoScenario& demo, const RecordedRun& run, const MergedMap& merged, Score& out) {
  double called = 0, right = 0, phantoms = 0, found = 0;
  std::vector<Segment2> new_walls, unplanned;
  for (const MergedWall& w : merged.walls) {
    if (w.state == WallState::kNew) new_walls.push_back(w.segment_map);
    if (!w.layout_wall) continue;
    const bool phantom = demo.truth.wall_source[static_cast<std::size_t>(*w.layout_wall)] < 0;
    const bool missing = w.state == WallState::kMissing;
    called += missing, right += missing && phantom;
    if (!phantom || run.witness.crossed(*w.layout_wall, 8) < 0.5) continue;
    ++phantoms, found += missing;
  }
  out.missing_right = share_of(right, called), out.missing_found = share_of(found, phantoms);
  double seen = 0, covered = 0, drawn = 0, true_new = 0;
  const int first = static_cast<int>(demo.truth.layout.walls.size());
  for (std::size_t k = 0; k < run.unplanned.size(); ++k)
    unplanned.push_back({demo.to_map(run.unplanned[k].a), demo.to_map(run.unplanned[k].b)});
  for (std::size_t k = 0; k < run.unplanned.size(); ++k)
    for (const Segment2& part : run.witness.seen_parts(first + static_cast<int>(k), 8)) {
      seen += part.length();
      covered += beside_m({demo.to_map(part.a), demo.to_map(part.b)}, new_walls);
    }
  for (const Segment2& s : new_walls) drawn += s.length(), true_new += beside_m(s, unplanned);
  out.new_right = share_of(true_new, drawn), out.new_found = share_of(covered, seen);
}

void score_poses(const PoseGraph& graph, const RecordedRun& run, const MergedMap& merged, Score& out) {
  double square = 0, turn = 0;
  std::size_t k = 0, count = 0;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    while (k + 1 < run.truth.size() && run.truth[k].stamp < graph.nodes[i].stamp) ++k;
    const Pose2 error = run.truth[k].T_map_robot.inverse() * merged.trajectory[i].T_map_robot;
    square += error.translation().squaredNorm(), turn += error.heading() * error.heading(), ++count;
  }
  out.pose_m = std::sqrt(share_of(square, static_cast<double>(count)));
  out.yaw_rad = std::sqrt(share_of(turn, static_cast<double>(count)));
}

/// Largest angle between a wall of some length and where it truly leads, so far.
double turned_deg(const DemoScenario& demo, const MergedMap& merged) {
  double worst = 0;
  for (const MergedWall& w : merged.walls) {
    if (!w.layout_wall || w.segment_map.length() < 1.5) continue;
    const int source = demo.truth.wall_source[static_cast<std::size_t>(*w.layout_wall)];
    if (source < 0) continue;
    const double truth = demo.building.wall_line(source).heading() - demo.T_world_start.heading();
    worst = std::max(worst, line_angle_between(w.segment_map.heading(), truth));
  }
  return worst * 180 / kPi;
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

bool run_one(const Scenario& scenario, std::uint64_t seed, const Method method, bool online, Score& out) {
  const auto demo = make_demo(seed, scenario.demo);
  if (!demo) return false;
  RunParams drive;
  drive.with_radar = false;
  const auto run = record_run(*demo, drive);
  if (!run) return false;
  const PoseGraph graph = map_of(*run, scenario.noise, seed);
  PlanStart start;
  start.T_layout_robot = Pose2(demo->truth.layout.frame().to_metres(demo->start.layout_px), demo->start.heading_rad);
  start.sigma_m = std::max(0.1, scenario.demo.sigma_start_m);
  start.sigma_rad = std::max(0.02, scenario.demo.sigma_start_rad);
  AutoCompleteGraph acg;
  if (!acg.set_plan(demo->truth.layout, start)) return false;
  std::vector<double> updates_s;
  for (std::size_t n = online && method == Method::kOurs ? 1 : graph.nodes.size(); n <= graph.nodes.size(); ++n) {
    const PoseGraph part = first_part(graph, n);
    const double begin = cpu_now_s();
    const auto merged = method == Method::k2017   ? published(PublishedMethod::kAcg2017, *demo, part, start)
                        : method == Method::k2019 ? published(PublishedMethod::kAcg2019, *demo, part, start)
                                                  : acg.update(part);
    updates_s.push_back(cpu_now_s() - begin);
    if (!merged) return false;
    if (n > 20) out.turned_deg = std::max(out.turned_deg, turned_deg(*demo, *merged));
    if (n < graph.nodes.size()) continue;
    score_poses(graph, *run, *merged, out);
    score_corners(*demo, *run, start, *merged, out);
    score_links(*demo, *run, *merged, out);
    score_walls(*demo, *run, *merged, out);
  }
  out.slowest_s = *std::max_element(updates_s.begin(), updates_s.end());
  out.update_s = middle_of(updates_s);
  out.success = out.pose_m < 0.3 && out.seen_m < 0.15;
  return true;
}

std::vector<Scenario> scenarios() {
  std::vector<Scenario> all;
  const auto add = [&](const std::string& name, double noise, double stretch, int missing, int phantom,
                       double start_m) {
    Scenario s{name, {}, noise};
    s.demo.fire = false;
    s.demo.distortion.sigma_stretch = stretch;
    s.demo.distortion.sigma_corner_m = 0.05;
    s.demo.distortion.missing_walls = missing;
    s.demo.distortion.phantom_walls = phantom;
    s.demo.sigma_start_m = start_m;
    all.push_back(s);
  };
  for (const int percent : {10, 40, 90})
    add("odometry noise " + std::to_string(percent) + " %", 0.01 * percent, 0.10, 2, 2, 0.15);
  add("plan stretched 5 %", 0.1, 0.05, 2, 2, 0.15);
  add("plan stretched 15 %", 0.1, 0.15, 2, 2, 0.15);
  add("many walls wrong", 0.1, 0.10, 8, 8, 0.15);
  add("start 0.8 m off", 0.1, 0.10, 2, 2, 0.57);
  return all;
}

struct Column {
  const char* name;
  double Score::*value;
  bool large_is_good;
};

constexpr Column kColumns[] = {
    {"pose m", &Score::pose_m, false},          {"yaw rad", &Score::yaw_rad, false},
    {"plan m", &Score::before_m, false},        {"seen m", &Score::seen_m, false},
    {"plan m", &Score::never_before_m, false},  {"never m", &Score::never_m, false},
    {"2sig seen", &Score::within_seen, true},   {"2sig never", &Score::within_never, true},
    {"links P", &Score::links_right, true},     {"links R", &Score::links_found, true},
    {"missing P", &Score::missing_right, true}, {"missing R", &Score::missing_found, true},
    {"new P", &Score::new_right, true},         {"new R", &Score::new_found, true},
    {"update s", &Score::update_s, false},      {"slowest s", &Score::slowest_s, false},
    {"turned deg", &Score::turned_deg, false},
};

void print_row(const std::string& name, const std::vector<Score>& scores) {
  if (scores.empty()) return;
  double success = 0;
  for (const Score& s : scores) success += s.success;
  std::printf("%-22s %5.2f", name.c_str(), success / static_cast<double>(scores.size()));
  for (const Column& c : kColumns) {
    std::vector<double> values;
    for (const Score& s : scores) values.push_back(s.*c.value);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    std::printf("  %6.3f (%.3f)", middle_of(values), c.large_is_good ? *low : *high);
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int seeds = 10;
  bool online = false;
  Method method = Method::kOurs;
  std::string only;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--online") == 0) online = true;
    if (std::strcmp(argv[i], "--acg2017") == 0) method = Method::k2017;
    if (std::strcmp(argv[i], "--acg2019") == 0) method = Method::k2019;
    if (std::strcmp(argv[i], "--seeds") == 0 && i + 1 < argc) seeds = std::atoi(argv[++i]);
    if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) only = argv[++i];
  }
  std::printf("%-22s %5s", "median (worst)", "ok");
  for (const Column& c : kColumns) std::printf("  %14s", c.name);
  std::printf("\n");
  std::fflush(stdout);
  for (const Scenario& scenario : scenarios()) {
    if (scenario.name.find(only) == std::string::npos) continue;
    std::vector<Score> scores;
    for (int seed = 1; seed <= seeds; ++seed) {
      Score score;
      if (run_one(scenario, static_cast<std::uint64_t>(seed), method, online, score)) scores.push_back(score);
    }
    print_row(scenario.name, scores);
  }
}
