// ndt_bench [--seeds N]: the two other uses the thesis has for NDT-OM cells, against what the product does instead.
//
// Corners: scans from a few known places in random buildings; corners of walls that were in sight, found from wall
// lines fitted to the hits (features/corners.hpp), and where the Gaussians of neighbouring NDT cells cross (Paper V,
// algorithm 1). Printed: how many were found within 0.25 m, how far off, how many lie beside every true corner.
// Localization: how well a scan tells its true pose (a particle 5 cm and 2 degrees off it) from others up to 5 m away,
// by the likelihood of the map of earlier scans: as points blurred in a grid (slam/likelihood_grid.hpp), as NDT cells.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>

#include "core/random.hpp"
#include "features/corners.hpp"
#include "simulation/building.hpp"
#include "simulation/lidar.hpp"
#include "simulation/random_building.hpp"
#include "slam/likelihood_grid.hpp"
#include "slam/surface_points.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/support/ndt_grid.hpp"

namespace smokemap::bench {
namespace {

constexpr int kScans = 12;
constexpr double kInSight_m = 6.0, kFound_m = 0.25;
constexpr int kOthers = 400;
constexpr double kPoseNoise_m = 0.01, kPoseNoise_rad = 0.003;  ///< of the scans that make the map

struct PosedScan {
  Pose2 T_map_robot;
  LaserScan scan;
  std::vector<Point2> hits_map;
};

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Places a few steps apart along a straight way through free space, and one scan more for localization.
std::vector<PosedScan> scans_in(const SegmentWorld& walls, const FloorPlan& plan, std::mt19937_64& random) {
  for (int tries = 0; tries < 2000; ++tries) {
    const Pose2 start(uniform(random, walls.low().x(), walls.high().x()),
                      uniform(random, walls.low().y(), walls.high().y()), uniform(random, -kPi, kPi));
    const Point2 end = start * Point2(0.2 * kScans, 0);
    if (plan.room_at(start.translation()) < 0 || walls.clearance_m(start.translation(), 1) < 0.4 ||
        walls.clearance_m(end, 1) < 0.4 || !walls.sees(start.translation(), end))
      continue;
    std::vector<PosedScan> scans;
    for (int k = 0; k <= kScans; ++k) {
      const Pose2 at = start * Pose2(0.2 * k, 0, normal(random, 0.1));
      PosedScan posed{at, simulate_scan(walls, {}, at, at, 0, {}, random).scan, {}};
      const ScanPoints points = surface_points(posed.scan, {}, {}, {});
      const Pose2 believed =
          at * Pose2(normal(random, kPoseNoise_m), normal(random, kPoseNoise_m), normal(random, kPoseNoise_rad));
      for (const Point2& p : *points.hits_robot) posed.hits_map.push_back(believed * p);
      scans.push_back(std::move(posed));
    }
    return scans;
  }
  return {};
}

/// Ends of walls where two of them meet at an angle, in sight of one of the scans.
std::vector<Point2> true_corners(const SegmentWorld& walls, const std::vector<PosedScan>& scans) {
  std::vector<Point2> corners;
  const auto& segments = walls.segments();
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (std::size_t j = i + 1; j < segments.size(); ++j)
      for (const Point2& p : {segments[i].line.a, segments[i].line.b}) {
        if (std::min((p - segments[j].line.a).norm(), (p - segments[j].line.b).norm()) > 1e-3) continue;
        if (std::abs(std::sin(segments[i].line.heading() - segments[j].line.heading())) < 0.5) continue;
        if (std::min(segments[i].line.length(), segments[j].line.length()) < 0.5) continue;
        const bool seen = std::any_of(scans.begin(), scans.end(), [&](const PosedScan& scan) {
          const Point2 eye = scan.T_map_robot.translation();
          return (p - eye).norm() < kInSight_m && walls.sees(eye, p + 0.03 * (eye - p).normalized());
        });
        const bool new_one = std::none_of(corners.begin(), corners.end(),
                                          [&](const Point2& other) { return (other - p).norm() < 0.05; });
        if (seen && new_one) corners.push_back(p);
      }
  return corners;
}

std::vector<Point2> line_corners(const std::vector<PosedScan>& scans) {
  std::vector<PosedHit> hits;
  for (const PosedScan& scan : scans)
    for (const Point2& p : scan.hits_map) hits.push_back({p, scan.T_map_robot.translation()});
  std::vector<Point2> corners;
  for (const Corner& corner : find_corners(find_wall_lines(hits))) corners.push_back(corner.position);
  return corners;
}

/// Crossings of the main axes of two flat cells that are neighbours of the cell they cross in; merged within half a
/// cell.
std::vector<Point2> ndt_corners(const NdtGrid& grid) {
  struct Line {
    Point2 mean, along;
  };
  std::vector<Point2> corners;
  for (const Cell middle : grid.cells()) {
    if (!grid.find(middle)->has_gaussian()) continue;
    std::vector<Line> lines;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const NdtCell* cell = grid.find({middle.x + dx, middle.y + dy});
        if (!cell || !cell->has_gaussian() || cell->count < 6) continue;
        const Eigen::Matrix2d covariance = cell->covariance();
        if (covariance.determinant() > 0.08 * std::pow(covariance.trace(), 2)) continue;  // round: no wall
        lines.push_back({cell->mean, {std::cos(cell->main_direction()), std::sin(cell->main_direction())}});
      }
    Point2 sum = Point2::Zero();
    int crossings = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t j = i + 1; j < lines.size(); ++j) {
        Eigen::Matrix2d axes;
        axes << lines[i].along, -lines[j].along;
        if (std::abs(axes.determinant()) < 0.56) continue;  // as CornerParams::min_angle_rad
        const Point2 p = lines[i].mean + axes.inverse().row(0).dot(lines[j].mean - lines[i].mean) * lines[i].along;
        if (grid.cell_of(p) == middle) sum += p, ++crossings;
      }
    if (crossings == 0) continue;
    const Point2 p = sum / crossings;
    if (std::none_of(corners.begin(), corners.end(),
                     [&](const Point2& c) { return (c - p).norm() < 0.5 * grid.cell_m(); }))
      corners.push_back(p);
  }
  return corners;
}

NdtGrid ndt_of(const std::vector<PosedScan>& scans, double cell_m, std::size_t count) {
  NdtGrid grid(cell_m);
  for (std::size_t k = 0; k < count; ++k)
    for (const Point2& p : scans[k].hits_map) grid.add_hit(scans[k].T_map_robot.translation(), p);
  return grid;
}

struct CornerTally {
  int truth = 0, found = 0, told = 0, beside = 0;
  std::vector<double> off_m;

  void count(const std::vector<Point2>& truth_now, const std::vector<Point2>& told_now) {
    const auto nearest = [](const Point2& p, const std::vector<Point2>& all) {
      double best = 1e9;
      for (const Point2& other : all) best = std::min(best, (other - p).norm());
      return best;
    };
    for (const Point2& p : truth_now) {
      const double off = nearest(p, told_now);
      if (off < kFound_m) off_m.push_back(off);
    }
    truth += static_cast<int>(truth_now.size()), told += static_cast<int>(told_now.size());
    found = static_cast<int>(off_m.size());
    for (const Point2& p : told_now) beside += nearest(p, truth_now) > kFound_m;
  }
  void print(const char* name) {
    std::sort(off_m.begin(), off_m.end());
    if (off_m.empty()) return;
    std::printf("%-26s %6d %8.1f%% %10.4f %10.4f %8.1f%%\n", name, truth, 100.0 * found / truth,
                off_m[off_m.size() / 2], off_m[off_m.size() * 9 / 10], 100.0 * beside / std::max(1, told));
  }
};

struct LocalTally {
  int scans = 0, first = 0;
  double rank = 0, cpu_s = 0;
  /// @param score  of a pose
  template <typename Score>
  void count(const std::vector<Pose2>& poses, Score&& score) {
    const double begin = bench::cpu_s();
    const double here = score(poses.front());
    int better = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) better += score(poses[i]) >= here;
    cpu_s += bench::cpu_s() - begin;
    ++scans, first += better == 0, rank += better;
  }
  void print(const char* name) const {
    std::printf("%-26s %6d %8.1f%% %10.2f %10.2f\n", name, scans, 100.0 * first / scans, rank / scans,
                1e6 * cpu_s / scans / (kOthers + 1));
  }
};

void localize(const std::vector<PosedScan>& scans, std::mt19937_64& random, LocalTally& points, LocalTally& ndt) {
  const PosedScan& asked = scans.back();
  const ScanPoints seen = surface_points(asked.scan, {}, {}, {});
  std::vector<Pose2> poses{asked.T_map_robot *
                           Pose2(normal(random, 0.05), normal(random, 0.05), normal(random, 0.035))};
  while (poses.size() <= kOthers) {
    const Pose2 away(uniform(random, -5, 5), uniform(random, -5, 5), uniform(random, -kPi, kPi));
    if (away.translation().norm() > 0.5 || std::abs(away.heading()) > 0.3) poses.push_back(asked.T_map_robot * away);
  }
  std::vector<Point2> known;
  for (std::size_t k = 0; k + 1 < scans.size(); ++k)
    known.insert(known.end(), scans[k].hits_map.begin(), scans[k].hits_map.end());
  const LikelihoodGrid grid(known, 0.1, 0.12, 1);
  points.count(poses, [&](const Pose2& T) {
    double sum = 0;
    for (const SurfacePoint& s : seen.surface) {
      const Cell cell = grid.frame().cell_of(T * s.p);
      sum += grid.most(0, cell.x, cell.y);
    }
    return sum;
  });
  const NdtGrid cells = ndt_of(scans, 0.5, scans.size() - 1);
  std::map<std::pair<int, int>, Eigen::Matrix2d> information;
  for (const Cell cell : cells.cells())
    if (cells.find(cell)->has_gaussian()) information[{cell.x, cell.y}] = cells.find(cell)->covariance(0.01).inverse();
  ndt.count(poses, [&](const Pose2& T) {
    double sum = 0;
    for (const SurfacePoint& s : seen.surface) {
      const Point2 p = T * s.p;
      const Cell cell = cells.cell_of(p);
      if (const auto found = information.find({cell.x, cell.y}); found != information.end()) {
        const Point2 r = p - cells.find(cell)->mean;
        sum += 0.1 + 0.9 * std::exp(-0.5 * 0.05 * r.dot(found->second * r));
      }
    }
    return sum;
  });
}

void run(int seeds) {
  CornerTally by_lines, by_cells, by_small_cells;
  LocalTally by_points, by_ndt;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const auto plan = random_building({}, random);
    if (!plan) continue;
    const SegmentWorld walls = build_world(*plan);
    for (int place = 0; place < 4; ++place) {
      const std::vector<PosedScan> scans = scans_in(walls, *plan, random);
      if (scans.empty()) continue;
      const std::vector<Point2> truth = true_corners(walls, scans);
      by_lines.count(truth, line_corners(scans));
      by_cells.count(truth, ndt_corners(ndt_of(scans, 0.5, scans.size())));
      by_small_cells.count(truth, ndt_corners(ndt_of(scans, 0.25, scans.size())));
      localize(scans, random, by_points, by_ndt);
    }
  }
  std::printf("%-26s %6s %9s %10s %10s %9s\n", "corners", "true", "found", "median m", "90 % m", "beside");
  by_lines.print("wall lines");
  by_cells.print("NDT cells 0.5 m");
  by_small_cells.print("NDT cells 0.25 m");
  std::printf("\n%-26s %6s %9s %10s %10s\n", "localization", "scans", "first", "better", "us a pose");
  by_points.print("blurred points 0.1 m");
  by_ndt.print("NDT cells 0.5 m");
}

}  // namespace
}  // namespace smokemap::bench

int main(int argc, char** argv) {
  smokemap::bench::run(smokemap::bench::seeds_option(
      argc, argv, 20, "NDT-OM cells for corners and for localization, against what the product does instead"));
}
