#include "tests/bench/long_log_figures.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "simulation/lidar.hpp"
#include "tests/support/half_turn_lidar.hpp"

namespace smokemap::bench {
namespace {

constexpr int kLines = 4;  ///< corridors each way
constexpr double kHalfCorridor_m = 1.1;
constexpr double kScanEvery_m = 0.20, kScanEvery_rad = 0.20;
constexpr double kSpeed_mps = 0.5, kTurn_radps = 0.8;
constexpr double kPersonRadius_m = 0.25;
constexpr double kRevisitWay_m = 20.0, kRevisitApart_m = 1.0, kRevisitTurn_rad = 0.8;

struct Door {
  Point2 outside, inside;  ///< in the corridor before it, in the middle of the room
};

struct Site {
  std::vector<WorldSegment> walls;
  std::vector<double> xs, ys;                   ///< middle lines of the corridors
  std::vector<std::vector<Door>> doors_of_row;  ///< by horizontal corridor
};

class SiteBuilder {
 public:
  SiteBuilder(std::mt19937_64& random, bool alike) : random_(random), alike_(alike) {
    for (int i = 0; i < kLines; ++i) {
      site_.xs.push_back(i == 0 ? 0 : site_.xs.back() + uniform(random, 16, 26));
      site_.ys.push_back(i == 0 ? 0 : site_.ys.back() + uniform(random, 12, 19));
    }
    site_.doors_of_row.resize(kLines);
    box({site_.xs.front() - kHalfCorridor_m, site_.ys.front() - kHalfCorridor_m},
        {site_.xs.back() + kHalfCorridor_m, site_.ys.back() + kHalfCorridor_m});
    for (std::size_t i = 0; i + 1 < kLines; ++i)
      for (std::size_t j = 0; j + 1 < kLines; ++j) add_block(i, j);
  }
  Site take() { return std::move(site_); }

 private:
  void wall(const Point2& a, const Point2& b) { site_.walls.push_back({{a, b}, Material::kBrick}); }
  void box(const Point2& low, const Point2& high) {
    const Point2 c[4] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    for (int k = 0; k < 4; ++k) wall(c[k], c[(k + 1) % 4]);
  }

  /// Two rows of rooms back to back, doors to the corridors below and above; pillars along the other two sides.
  void add_block(std::size_t i, std::size_t j) {
    const Point2 low(site_.xs[i] + kHalfCorridor_m, site_.ys[j] + kHalfCorridor_m),
        high(site_.xs[i + 1] - kHalfCorridor_m, site_.ys[j + 1] - kHalfCorridor_m);
    const double middle = drawn(0.4, 0.6) * (high.y() - low.y()) + low.y();
    wall({low.x(), low.y()}, {low.x(), high.y()});
    wall({high.x(), low.y()}, {high.x(), high.y()});
    wall({low.x(), middle}, {high.x(), middle});
    for (const double x : {low.x(), high.x()})
      for (double y = low.y() + drawn(1, 5); y < high.y() - 1; y += drawn(2, 6)) {
        const double side = x == low.x() ? -1 : 1, deep = drawn(0.15, 0.35);
        box({std::min(x, x + side * deep), y}, {std::max(x, x + side * deep), y + drawn(0.2, 0.5)});
      }
    row_of_rooms(low.x(), high.x(), low.y(), middle, site_.doors_of_row[j]);
    row_of_rooms(low.x(), high.x(), high.y(), middle, site_.doors_of_row[j + 1]);
  }

  void row_of_rooms(double from_x, double to_x, double front_y, double back_y, std::vector<Door>& doors) {
    const double out = front_y < back_y ? -1 : 1;
    for (double x = from_x; x < to_x - 0.1;) {
      double end = std::min(to_x, x + drawn(3, 7));
      if (to_x - end < 3) end = to_x;
      if (end < to_x) wall({end, front_y}, {end, back_y});
      const double door = drawn(x + 0.9, end - 0.9);
      wall({x, front_y}, {door - 0.5, front_y});
      wall({door + 0.5, front_y}, {end, front_y});
      const double depth = std::abs(back_y - front_y);
      const double cupboard = drawn(0.5, 1.2), at = drawn(x + 0.1, end - cupboard - 0.1);
      const double y = back_y + out * 0.5;
      box({at, std::min(y, back_y)}, {at + cupboard, std::max(y, back_y)});
      doors.push_back({{door, front_y + out * kHalfCorridor_m}, {door, front_y - out * 0.5 * depth}});
      x = end;
    }
  }

  /// Of rooms that are alike, the middle of what they might be.
  double drawn(double low, double high) { return alike_ ? 0.5 * (low + high) : uniform(random_, low, high); }

  std::mt19937_64& random_;
  bool alike_;
  Site site_;
};

/// Corners of a walk from crossing to crossing that does not turn back on the spot.
std::vector<Point2> walk(const Site& site, double way_m, std::mt19937_64& random) {
  int i = 0, j = 0, from_i = -1, from_j = -1;
  std::vector<Point2> way{{site.xs[0], site.ys[0]}};
  double driven = 0;
  const auto go = [&](const Point2& to) {
    driven += (to - way.back()).norm();
    way.push_back(to);
  };
  while (driven < way_m) {
    std::vector<std::pair<int, int>> next;
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int to_i = i + di, to_j = j + dj;
      if (to_i < 0 || to_j < 0 || to_i >= kLines || to_j >= kLines || (to_i == from_i && to_j == from_j)) continue;
      next.emplace_back(to_i, to_j);
    }
    const auto [to_i, to_j] = next[uniform_index(random, next.size())];
    const Point2 goal(site.xs[static_cast<std::size_t>(to_i)], site.ys[static_cast<std::size_t>(to_j)]);
    if (to_j == j) {  // rooms lie along these corridors: look into one of six, in the order of the doors
      std::vector<Door> doors;
      for (const Door& door : site.doors_of_row[static_cast<std::size_t>(j)])
        if ((door.outside.x() - way.back().x()) * (door.outside.x() - goal.x()) < 0 && uniform01(random) < 1.0 / 6)
          doors.push_back(door);
      const double ahead = goal.x() > way.back().x() ? 1 : -1;
      std::sort(doors.begin(), doors.end(),
                [ahead](const Door& a, const Door& b) { return ahead * a.outside.x() < ahead * b.outside.x(); });
      for (const Door& door : doors)
        for (const Point2& p : {door.outside, door.inside, door.outside}) go(p);
    }
    go(goal);
    from_i = std::exchange(i, to_i);
    from_j = std::exchange(j, to_j);
  }
  return way;
}

/// Poses of scans along the walk, with their times; turns on the spot.
Trajectory poses_along(const std::vector<Point2>& way) {
  Trajectory poses;
  double t = 100, heading = 0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const Point2 leg = way[k] - way[k - 1];
    if (leg.norm() < 0.05) continue;
    const double to = std::atan2(leg.y(), leg.x()), turn = wrap_angle(to - heading);
    const int turns = static_cast<int>(std::abs(turn) / kScanEvery_rad),
              steps = static_cast<int>(leg.norm() / kScanEvery_m);
    for (int s = 1; s <= turns; ++s) {
      t += std::abs(turn) / (turns + 1) / kTurn_radps;
      poses.push_back({from_seconds(t), {way[k - 1], heading + turn * s / (turns + 1)}, Eigen::Matrix3d::Zero()});
    }
    heading = to;
    for (int s = 0; s <= steps; ++s) {
      t += leg.norm() / (steps + 1) / kSpeed_mps;
      poses.push_back({from_seconds(t), {way[k - 1] + leg * s / (steps + 1), heading}, Eigen::Matrix3d::Zero()});
    }
  }
  return poses;
}

void add_relations(LongLog& log) {
  std::vector<double> way(log.truth.size(), 0);
  for (std::size_t k = 1; k < log.truth.size(); ++k)
    way[k] = way[k - 1] + (log.truth[k].T_map_robot.translation() - log.truth[k - 1].T_map_robot.translation()).norm();
  log.way_m = way.back();
  const auto relation = [&](std::size_t a, std::size_t b) {
    return PoseRelation{log.truth[a].stamp, log.truth[b].stamp,
                        log.truth[a].T_map_robot.inverse() * log.truth[b].T_map_robot};
  };
  std::size_t last = 0;
  double searched = -10;
  for (std::size_t k = 1; k < log.truth.size(); ++k) {
    if (way[k] - way[last] >= 1) {
      log.relations.push_back(relation(last, k));
      last = k;
    }
    if (way[k] - searched < 1) continue;
    searched = way[k];
    double visited = -10;
    for (std::size_t a = 0; a < k && way[k] - way[a] > kRevisitWay_m; ++a) {
      const Pose2 apart = log.truth[a].T_map_robot.inverse() * log.truth[k].T_map_robot;
      if (way[a] - visited < 5 || apart.translation().norm() > kRevisitApart_m ||
          std::abs(apart.heading()) > kRevisitTurn_rad)
        continue;
      visited = way[a];
      log.revisits.push_back(relation(a, k));
    }
  }
  log.relations.insert(log.relations.end(), log.revisits.begin(), log.revisits.end());
}

/// Where somebody is who walks 1.5 m and more before the robot, each a metre before the last, left and right in turn.
Point2 person_at(const Trajectory& poses, std::size_t k, int person) {
  const auto ahead = static_cast<std::size_t>((1.5 + person) / kScanEvery_m);
  const Pose2& at = poses[std::min(k + ahead, poses.size() - 1)].T_map_robot;
  return at * Point2(0, person % 2 == 0 ? 0.35 : -0.35);
}

/// Beams end at a person who stands there, given in the scanner's frame.
void put_before(LaserScan& scan, const Point2& person) {
  for (std::size_t b = 0; b < scan.ranges_m.size(); ++b) {
    const double angle = scan.angle_min_rad + static_cast<double>(b) * scan.angle_increment_rad;
    const Point2 beam(std::cos(angle), std::sin(angle));
    const double along = beam.dot(person), beside2 = person.squaredNorm() - along * along;
    if (along <= 0 || beside2 > kPersonRadius_m * kPersonRadius_m) continue;
    const double range = along - std::sqrt(kPersonRadius_m * kPersonRadius_m - beside2);
    if (range > 0.1 && !(scan.ranges_m[b] < range)) scan.ranges_m[b] = static_cast<float>(range);
  }
}

}  // namespace

LongLog long_log(std::uint64_t seed, double way_m, const LongLogKind& kind) {
  std::mt19937_64 random(seed);
  const Site site = SiteBuilder(random, kind.alike).take();
  const SegmentWorld world(site.walls);
  const LidarParams lidar = test::half_turn_lidar();
  const Trajectory poses = poses_along(walk(site, way_m, random));
  LongLog log;
  const double scale = 1 + normal(random, 0.01), bend = normal(random, 0.004);
  Pose2 T_odom, T_world_scan;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Pose2& at = poses[k].T_map_robot;
    if (k > 0) {
      const Pose2 step = poses[k - 1].T_map_robot.inverse() * at;
      const double way = step.translation().norm(), turn = std::abs(step.heading());
      T_odom = T_odom * Pose2(scale * step.translation() + Point2(normal(random, 0.02 * std::sqrt(way)), 0),
                              kind.turn_told * step.heading() + bend * way +
                                  normal(random, 0.03 * std::sqrt(turn) + 0.01 * std::sqrt(way)));
    }
    log.items.emplace_back(Odometry{poses[k].stamp, "robot", T_odom, 0, 0});
    LaserScan scan = simulate_scan(world, {}, at, at, poses[k].stamp, lidar, random).scan;
    const Pose2 since = T_world_scan.inverse() * at;
    if (k > 0 && since.translation().norm() < kind.scans_apart_m && std::abs(since.heading()) < kind.scans_apart_rad)
      continue;
    for (int person = 0; person < kind.people; ++person) put_before(scan, at.inverse() * person_at(poses, k, person));
    log.items.emplace_back(std::move(scan));
    log.truth.push_back(poses[k]);
    T_world_scan = at;
  }
  add_relations(log);
  return log;
}

}  // namespace smokemap::bench
