#include "tests/bench/radar_figures.hpp"

#include <cmath>

#include "core/random.hpp"

namespace smokemap::bench {
namespace {

constexpr double kLidarTurn_s = 0.10085, kRadarTurn_s = 0.4021;  // measured from the paper's files

void add_box(std::vector<WorldSegment>& world, const Point2& low, const Point2& high, Material material) {
  const Point2 c[4] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  for (int i = 0; i < 4; ++i) world.push_back({{c[i], c[(i + 1) % 4]}, material});
}

/// A hall of a laboratory: 16 m x 11 m, pillars, a plasterboard office in a corner, metal cabinets, a window front.
std::vector<WorldSegment> hall() {
  std::vector<WorldSegment> world;
  const Point2 c[4] = {{0, 0}, {16, 0}, {16, 11}, {0, 11}};
  for (int i = 0; i < 4; ++i) world.push_back({{c[i], c[(i + 1) % 4]}, i == 1 ? Material::kGlass : Material::kBrick});
  world.push_back({{{12, 11}, {12, 8}}, Material::kWood});
  world.push_back({{{12, 8}, {14.8, 8}}, Material::kWood});
  add_box(world, {0.6, 4}, {1.2, 7}, Material::kMetal);
  add_box(world, {5, 9.8}, {9, 10.6}, Material::kMetal);
  add_box(world, {10.5, 0.5}, {13, 1.3}, Material::kWood);
  add_box(world, {7.7, 5.2}, {8.1, 5.6}, Material::kBrick);
  add_box(world, {13.4, 4.4}, {13.8, 4.8}, Material::kBrick);
  add_box(world, {3, 0.4}, {4.2, 1.4}, Material::kMetal);
  return world;
}

/// Where the truck is: straight legs at 0.1 m/s, turns on the spot at 15 degrees a second.
class Truck {
 public:
  explicit Truck(const std::vector<Point2>& way) {
    double t = 2, heading = std::atan2(way[1].y() - way[0].y(), way[1].x() - way[0].x());
    keys_.push_back({0, {way[0], heading}});
    keys_.push_back({t, {way[0], heading}});
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Point2 leg = way[i] - way[i - 1];
      const double next = std::atan2(leg.y(), leg.x());
      t += std::abs(wrap_angle(next - heading)) / 0.26 + 1e-6;
      keys_.push_back({t, {way[i - 1], next}});
      heading = next;
      t += leg.norm() / 0.1;
      keys_.push_back({t, {way[i], heading}});
    }
  }
  double duration_s() const { return keys_.back().first; }
  Pose2 at(double t) const {
    for (std::size_t i = 1; i < keys_.size(); ++i)
      if (t <= keys_[i].first)
        return interpolate(keys_[i - 1].second, keys_[i].second,
                           (t - keys_[i - 1].first) / (keys_[i].first - keys_[i - 1].first));
    return keys_.back().second;
  }

 private:
  std::vector<std::pair<double, Pose2>> keys_;
};

struct Twin {
  std::vector<LaserScan> scans;
  std::vector<RadarSweep> sweeps;
  Trajectory truth;
};

/// The hall with people walking to and fro in it.
SegmentWorld hall_at(double t, int people) {
  std::vector<WorldSegment> world = hall();
  for (int k = 0; k < people; ++k) {
    const Point2 p(5 + 3 * k + 2.5 * std::sin(0.11 * t + k), 7.8 - 5.5 * k + 0.5 * std::cos(0.17 * t));
    add_box(world, p - Point2(0.2, 0.15), p + Point2(0.2, 0.15), Material::kWood);
  }
  return SegmentWorld(world);
}

Twin drive(const std::vector<Point2>& way, int people, std::uint64_t seed) {
  const Truck truck(way);
  std::mt19937_64 random(seed);
  LidarParams lidar;
  lidar.range_max_m = 30;
  lidar.sigma_range_m = 0.03;
  lidar.turn_s = kLidarTurn_s;
  RadarSimParams radar;
  radar.turn_s = kRadarTurn_s;
  Twin twin;
  SegmentWorld world = hall_at(0, people);
  for (double t = 0; t + kLidarTurn_s < truck.duration_s(); t += kLidarTurn_s) {
    if (people > 0) world = hall_at(t, people);
    twin.scans.push_back(
        simulate_scan(world, {}, truck.at(t), truck.at(t + kLidarTurn_s), from_seconds(t), lidar, random).scan);
    twin.truth.push_back({from_seconds(t), truck.at(t), Eigen::Matrix3d::Zero()});
  }
  for (double t = 0; t + kRadarTurn_s < truck.duration_s(); t += kRadarTurn_s) {
    if (people > 0) world = hall_at(t, people);
    twin.sweeps.push_back(
        simulate_sweep(world, truck.at(t), truck.at(t + kRadarTurn_s), from_seconds(t), radar, random));
  }
  return twin;
}

/// Every `stride`-th pose: the paper's nodes come every 1.1 s (lidar) or 1.2 s (radar).
Trajectory nodes_of(const Trajectory& poses, std::size_t stride) {
  Trajectory nodes;
  for (std::size_t i = 0; i < poses.size(); i += stride) nodes.push_back(poses[i]);
  return nodes;
}

std::vector<PoseRelation> steps_of(const Trajectory& nodes, const Truck& truck) {
  std::vector<PoseRelation> steps;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    steps.push_back({nodes[i - 1].stamp, nodes[i].stamp,
                     truck.at(to_seconds(nodes[i - 1].stamp)).inverse() * truck.at(to_seconds(nodes[i].stamp))});
  return steps;
}

TwinFigures judged(const char* run, Use sensor, const Slam& slam, const Twin& twin, const Truck& truck) {
  TwinFigures figures{run, sensor, {}, {}, {}, slam.counters()};
  const Trajectory nodes = nodes_of(slam.trajectory(), sensor == Use::kLidar ? 11 : 3);
  if (const auto whole = absolute_error(slam.trajectory(), twin.truth, Point2::Zero(), 0.5)) figures.whole = *whole;
  if (const auto paper = displacement_error(nodes, twin.truth)) figures.paper = *paper;
  if (const auto step = relation_error(nodes, steps_of(nodes, truck))) figures.step = *step;
  return figures;
}

/// Through a few rooms and back to where the run began, so that there is a loop to close.
RunParams there_and_back(const DemoScenario& demo) {
  RunParams params;
  const Point2 start = demo.T_world_start.translation();
  const std::vector<Point2> tour = room_tour(demo.building, start);
  for (std::size_t i = 0; i < tour.size() && i < 6; ++i) params.waypoints.push_back(tour[i]);
  params.waypoints.push_back(start + demo.T_world_start.rotation() * Point2(0.5, 0));
  params.max_duration_s = 400;
  return params;
}

}  // namespace

std::vector<TwinFigures> paper_twin() {
  const std::vector<Point2> round{{3, 3}, {10.5, 3}, {10.5, 7}, {5.5, 7}, {3, 4.2}, {3, 3.2}};
  const std::vector<Point2> other{{11, 4}, {11, 7}, {4, 7}, {4, 3.5}, {9, 3.5}, {10.8, 4}};
  std::vector<Point2> twice = round;
  twice.insert(twice.end(), round.begin() + 1, round.end());
  const std::vector<std::vector<Point2>> ways{round, other, twice};
  const char* names[] = {"1", "2", "3 (people)"};
  std::vector<TwinFigures> all;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Twin twin = drive(ways[i], i == 2 ? 2 : 0, 10 + i);
    const Truck truck(ways[i]);
    Slam lidar, radar;
    for (const LaserScan& scan : twin.scans) (void)lidar.add_scan(scan).ok();
    lidar.polish();
    all.push_back(judged(names[i], Use::kLidar, lidar, twin, truck));
    for (const RadarSweep& sweep : twin.sweeps) (void)radar.add_sweep(sweep).ok();
    radar.polish();
    all.push_back(judged(names[i], Use::kRadar, radar, twin, truck));
  }
  return all;
}

std::optional<RecordedRun> building_run(int seed, bool fire) {
  DemoParams params;
  params.fire = fire;
  const auto demo = make_demo(static_cast<std::uint64_t>(seed), params);
  if (!demo) return std::nullopt;
  const auto run = record_run(*demo, there_and_back(*demo));
  return run ? std::optional(*run) : std::nullopt;
}

RunFigures judged(const RecordedRun& run, Use use) {
  Slam slam;
  for (const auto& item : run.items) {
    if (const auto* odometry = std::get_if<Odometry>(&item)) slam.add_odometry(*odometry);
    const auto* scan = std::get_if<LaserScan>(&item);
    if (scan && use != Use::kRadar) (void)slam.add_scan(*scan).ok();
    const auto* sweep = std::get_if<RadarSweep>(&item);
    if (sweep && use != Use::kLidar) (void)slam.add_sweep(*sweep).ok();
  }
  slam.polish();
  RunFigures figures{{}, 0, slam.counters()};
  const Trajectory poses = slam.trajectory();
  const auto whole = absolute_error(poses, run.truth);
  if (!whole || poses.empty()) return figures;
  figures.whole = *whole;
  const PoseRelation round{poses.front().stamp, run.truth.back().stamp, run.truth.back().T_map_robot};
  if (const auto end = relation_error(poses, {round}, {}, 0.5)) figures.end_m = end->translation_m.most;
  return figures;
}

}  // namespace smokemap::bench
