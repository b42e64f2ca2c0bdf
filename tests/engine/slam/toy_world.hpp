#pragma once

#include <vector>

#include "core/random.hpp"
#include "geometry/segment2.hpp"
#include "maps/laser_scan.hpp"
#include "maps/odometry.hpp"
#include "maps/radar_sweep.hpp"

namespace smokemap::test {

/// A ring of corridors around a block, with niches so that no place looks like another: 14 m x 10 m.
inline std::vector<Segment2> ring_of_corridors() {
  const std::vector<std::vector<Point2>> rings{
      {{0, 0},   {3, 0},  {3, -0.6}, {4.2, -0.6}, {4.2, 0},  {14, 0}, {14, 4}, {14.8, 4}, {14.8, 6.5}, {14, 6.5},
       {14, 10}, {9, 10}, {9, 10.7}, {7.5, 10.7}, {7.5, 10}, {0, 10}, {0, 7},  {-0.5, 7}, {-0.5, 6.2}, {0, 6.2}},
      {{2, 2},
       {2, 8},
       {5, 8},
       {5, 7.4},
       {6.5, 7.4},
       {6.5, 8},
       {12, 8},
       {12, 5},
       {11.3, 5},
       {11.3, 3.5},
       {12, 3.5},
       {12, 2},
       {8, 2},
       {8, 2.5},
       {7.2, 2.5},
       {7.2, 2}}};
  std::vector<Segment2> walls;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) walls.push_back({ring[i], ring[(i + 1) % ring.size()]});
  return walls;
}

inline double cast(const std::vector<Segment2>& walls, const Point2& from, double angle, double farthest_m) {
  const Segment2 ray{from, from + farthest_m * Point2(std::cos(angle), std::sin(angle))};
  double best = farthest_m;
  for (const Segment2& wall : walls)
    if (const auto hit = intersection(ray, wall)) best = std::min(best, (*hit - from).norm());
  return best;
}

/// A scan of 180 beams over the whole turn, 1 cm noise, 12 m reach; no return is infinite.
inline LaserScan scan_at(const std::vector<Segment2>& walls, const Pose2& T_world_robot, double seconds,
                         std::mt19937_64& random, int beams = 180) {
  LaserScan scan;
  scan.stamp = from_seconds(seconds);
  scan.robot = "robot";
  scan.angle_min_rad = -kPi;
  scan.angle_increment_rad = 2 * kPi / beams;
  scan.range_min_m = 0.05;
  scan.range_max_m = 12;
  for (int i = 0; i < beams; ++i) {
    const double r = cast(walls, T_world_robot.translation(),
                          T_world_robot.heading() + scan.angle_min_rad + i * scan.angle_increment_rad, 13);
    scan.ranges_m.push_back(r < 12 ? static_cast<float>(r + normal(random, 0.01))
                                   : std::numeric_limits<float>::infinity());
  }
  return scan;
}

/// A radar turn in the toy world: an echo of 25 dB at each wall with exponential speckle, receiver noise of mean 1.
inline RadarSweep sweep_at(const std::vector<Segment2>& walls, const Pose2& at, double seconds,
                           std::mt19937_64& random) {
  RadarSweep sweep;
  sweep.stamp = from_seconds(seconds);
  sweep.robot = "robot";
  sweep.duration_s = 0;
  sweep.azimuths = 200;
  sweep.azimuth_increment_rad = 2 * kPi / 200;
  sweep.bins = 320;
  sweep.range_resolution_m = 0.0375;
  sweep.power.resize(200 * 320);
  for (float& p : sweep.power) p = static_cast<float>(exponential(random));
  for (std::size_t a = 0; a < 200; ++a) {
    const double r = cast(walls, at.translation(), at.heading() + 2 * kPi * static_cast<double>(a) / 200, 12);
    const auto bin = static_cast<std::size_t>(std::lround(r / sweep.range_resolution_m));
    if (bin + 1 < 320) sweep.power[a * 320 + bin] += static_cast<float>(300 * (0.2 + exponential(random)));
  }
  return sweep;
}

/// Rounds through the middle of the corridors: a pose every `step_m`, corners turned on the spot in steps of 0.2 rad.
inline std::vector<Pose2> rounds(int times, double step_m) {
  const std::vector<Point2> corners{{1, 1}, {13, 1}, {13, 9}, {1, 9}};
  std::vector<Pose2> poses;
  for (int round = 0; round < times; ++round)
    for (std::size_t side = 0; side < 4; ++side) {
      const Point2 a = corners[side], b = corners[(side + 1) % 4];
      const double heading = std::atan2(b.y() - a.y(), b.x() - a.x()), length = (b - a).norm();
      for (double s = 0; s < length; s += step_m) poses.emplace_back(a + s / length * (b - a), heading);
      for (double turn = 0; turn < kPi / 2; turn += 0.2) poses.emplace_back(b, heading + turn);
    }
  return poses;
}

/// What wheels would say: every increment scaled and turned a little wrong, plus noise.
class Wheels {
 public:
  Wheels(double scale, double drift_rad_per_m, double sigma_share, std::uint64_t seed)
      : scale_(scale), drift_(drift_rad_per_m), share_(sigma_share), random_(seed) {}
  Odometry read(const Pose2& T_world_robot, double seconds) {
    if (started_) {
      const Pose2 step = last_.inverse() * T_world_robot;
      const double way = step.translation().norm();
      T_odom_ = T_odom_ * Pose2(step.translation() * (scale_ + normal(random_, share_)),
                                step.heading() * (1 + normal(random_, share_)) + drift_ * way);
    }
    started_ = true;
    last_ = T_world_robot;
    return {from_seconds(seconds), "robot", T_odom_, 0, 0};
  }

 private:
  double scale_, drift_, share_;
  std::mt19937_64 random_;
  Pose2 T_odom_, last_;
  bool started_ = false;
};

}  // namespace smokemap::test
