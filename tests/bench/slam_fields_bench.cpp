// slam_fields_bench [--seeds N]: which smooth field a scan should be refined on. One interface, three fields made of
// the same scans at their true poses: the product's oriented surface points (slam/align.hpp), NDT cells (0.25 m,
// overlapped by half a cell, as the thesis uses), and a bicubic hit-probability grid (0.05 m, as Cartographer uses).
//
// Every next scan of a generated drive (corridors and rooms, 1 cm noise) starts at its true pose plus an error and is
// refined. Printed: where it ends (median and 95 %), how many end within 3 cm and half a degree, CPU time a scan.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "core/random.hpp"
#include "grids/log_odds_grid.hpp"
#include "slam/align.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/long_log_figures.hpp"
#include "tests/support/ndt_grid.hpp"

namespace smokemap::bench {
namespace {

struct PlacedScan {
  Pose2 T_map_robot;
  ScanPoints points;
};

/// Made of a few scans, then asked for the pose of another one.
class Field {
 public:
  virtual ~Field() = default;
  virtual const char* name() const = 0;
  virtual void build(const std::vector<const PlacedScan*>& scans) = 0;
  virtual Pose2 refine(const ScanPoints& scan, const Pose2& start) const = 0;
};

class SurfaceField : public Field {
 public:
  const char* name() const override { return "surface points 0.10 m"; }
  void build(const std::vector<const PlacedScan*>& scans) override {
    map_.reset(scans.back()->T_map_robot.translation(), 40);
    for (const PlacedScan* scan : scans) map_.add(scan->points.surface, scan->T_map_robot);
  }
  Pose2 refine(const ScanPoints& scan, const Pose2& start) const override {
    return align(scan.surface, map_, start, {}).T_map_robot;
  }

 private:
  SurfaceMap map_{0.10};
};

/// Gauss-Newton with a callback that adds one point's share to H and b.
template <typename AddPoint>
Pose2 gauss_newton(const ScanPoints& scan, Pose2 T, int iterations, AddPoint&& add_point) {
  for (int i = 0; i < iterations; ++i) {
    Eigen::Matrix3d H = 1e-3 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const Eigen::Matrix2d R = T.rotation();
    for (const SurfacePoint& point : scan.surface) {
      const Point2 arm = R * point.p;
      Eigen::Matrix<double, 2, 3> J;
      J << 1, 0, -arm.y(), 0, 1, arm.x();
      add_point(Point2(arm + T.translation()), J, i, H, b);
    }
    const Eigen::Vector3d step = H.ldlt().solve(-b);
    T = {T.translation() + step.head<2>(), T.heading() + step.z()};
    if (step.head<2>().norm() < 5e-4 && std::abs(step.z()) < 1e-4) break;
  }
  return T;
}

class NdtField : public Field {
 public:
  const char* name() const override { return "NDT 0.25 m, overlapped"; }
  void build(const std::vector<const PlacedScan*>& scans) override {
    for (std::size_t k = 0; k < grids_.size(); ++k) {
      grids_[k] = NdtGrid(kCell_m);
      for (const PlacedScan* scan : scans)
        for (const Point2& p : *scan->points.hits_robot) grids_[k].add_point(scan->T_map_robot * p + shift(k));
    }
  }
  Pose2 refine(const ScanPoints& scan, const Pose2& start) const override {
    return gauss_newton(scan, start, 20, [this](const Point2& p, const auto& J, int, auto& H, auto& b) {
      for (std::size_t k = 0; k < grids_.size(); ++k) {
        const NdtCell* cell = grids_[k].at(p + shift(k));
        if (!cell || cell->count < 5) continue;
        Eigen::Matrix2d covariance = cell->covariance(0.01);
        covariance.diagonal().array() += 0.02 * 0.02;
        const Eigen::Matrix2d information = covariance.inverse();
        const Point2 r = p + shift(k) - cell->mean;
        const double weight = std::exp(-0.05 * r.dot(information * r));
        H += weight * J.transpose() * information * J;
        b += weight * J.transpose() * (information * r);
      }
    });
  }

 private:
  static constexpr double kCell_m = 0.25;
  static Point2 shift(std::size_t k) { return 0.5 * kCell_m * Point2(k % 2 ? 1 : 0, k / 2 ? 1 : 0); }
  std::array<NdtGrid, 4> grids_;
};

class HitGridField : public Field {
 public:
  const char* name() const override { return "hit grid 0.05 m, bicubic"; }
  void build(const std::vector<const PlacedScan*>& scans) override {
    grid_ = LogOddsGrid(0.05);
    for (const PlacedScan* scan : scans)
      for (const Point2& p : *scan->points.hits_robot)
        grid_.add_hit(scan->T_map_robot.translation(), scan->T_map_robot * p);
  }
  Pose2 refine(const ScanPoints& scan, const Pose2& start) const override {
    return gauss_newton(scan, start, 20, [this](const Point2& p, const auto& J, int, auto& H, auto& b) {
      const auto [hit, gradient] = at(p);
      const Eigen::RowVector3d j = -gradient.transpose() * J;
      const double scale = 1e4;  // a probability missed by 0.01 counts as one sigma
      H += scale * j.transpose() * j;
      b += scale * j.transpose() * (1 - hit);
    });
  }

 private:
  double probability(int x, int y) const { return 1 / (1 + std::exp(-grid_.log_odds({x, y}))); }
  /// Catmull-Rom, and its derivative, along one axis.
  static std::array<double, 4> weights(double t) {
    return {-0.5 * t + t * t - 0.5 * t * t * t, 1 - 2.5 * t * t + 1.5 * t * t * t,
            0.5 * t + 2 * t * t - 1.5 * t * t * t, -0.5 * t * t + 0.5 * t * t * t};
  }
  static std::array<double, 4> slopes(double t) {
    return {-0.5 + 2 * t - 1.5 * t * t, -5 * t + 4.5 * t * t, 0.5 + 4 * t - 4.5 * t * t, -t + 1.5 * t * t};
  }
  std::pair<double, Point2> at(const Point2& p) const {
    const double cell = grid_.frame().resolution_m;
    const Point2 c = (p - grid_.frame().origin) / cell - Point2(0.5, 0.5);
    const int x = static_cast<int>(std::floor(c.x())), y = static_cast<int>(std::floor(c.y()));
    const auto wx = weights(c.x() - x), wy = weights(c.y() - y), dx = slopes(c.x() - x), dy = slopes(c.y() - y);
    double value = 0;
    Point2 gradient = Point2::Zero();
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        const double v = probability(x - 1 + static_cast<int>(k), y - 1 + static_cast<int>(i));
        value += wy[i] * wx[k] * v;
        gradient += Point2(wy[i] * dx[k], dy[i] * wx[k]) * v / cell;
      }
    return {value, gradient};
  }
  LogOddsGrid grid_{0.05};
};

struct Tally {
  std::vector<double> off_m, off_deg;
  int good = 0;
  double cpu_s = 0;
};

void compare(int seeds, double sigma_m, double sigma_rad) {
  std::vector<std::unique_ptr<Field>> fields;
  fields.push_back(std::make_unique<SurfaceField>());
  fields.push_back(std::make_unique<NdtField>());
  fields.push_back(std::make_unique<HitGridField>());
  std::vector<Tally> tallies(fields.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    const LongLog log = long_log(static_cast<std::uint64_t>(seed), 120);
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::vector<PlacedScan> scans;
    for (const auto& item : log.items)
      if (const auto* scan = std::get_if<LaserScan>(&item))
        scans.push_back({log.truth[scans.size()].T_map_robot, surface_points(*scan, {}, {}, {})});
    for (std::size_t i = 30; i < scans.size(); i += 3) {
      std::vector<const PlacedScan*> map;
      for (std::size_t k = i - 30; k < i; k += 2) map.push_back(&scans[k]);
      const Pose2& truth = scans[i].T_map_robot;
      const Pose2 start = truth * Pose2(normal(random, sigma_m), normal(random, sigma_m), normal(random, sigma_rad));
      for (std::size_t f = 0; f < fields.size(); ++f) {
        fields[f]->build(map);
        const std::clock_t begin = std::clock();
        const Pose2 off = truth.inverse() * fields[f]->refine(scans[i].points, start);
        tallies[f].cpu_s += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        tallies[f].off_m.push_back(off.translation().norm());
        tallies[f].off_deg.push_back(degrees(std::abs(off.heading())));
        tallies[f].good += off.translation().norm() < 0.03 && degrees(std::abs(off.heading())) < 0.5;
      }
    }
  }
  std::printf("\nstart off by %.2f m, %.1f deg (one sigma)\n%-26s %9s %9s %9s %9s %9s %9s\n", sigma_m,
              degrees(sigma_rad), "field", "median m", "95 % m", "med. deg", "95 % deg", "good", "us a scan");
  for (std::size_t f = 0; f < fields.size(); ++f) {
    Tally& t = tallies[f];
    std::sort(t.off_m.begin(), t.off_m.end());
    std::sort(t.off_deg.begin(), t.off_deg.end());
    const std::size_t n = t.off_m.size();
    std::printf("%-26s %9.4f %9.4f %9.3f %9.3f %8.1f%% %9.0f\n", fields[f]->name(), t.off_m[n / 2],
                t.off_m[n * 95 / 100], t.off_deg[n / 2], t.off_deg[n * 95 / 100],
                100.0 * t.good / static_cast<double>(n), 1e6 * t.cpu_s / static_cast<double>(n));
  }
}

}  // namespace
}  // namespace smokemap::bench

int main(int argc, char** argv) {
  const int seeds = smokemap::bench::seeds_option(argc, argv, 3, "Fields that a scan may be refined on");
  for (const auto& [sigma_m, sigma_rad] : {std::pair{0.02, 0.01}, {0.10, 0.05}, {0.20, 0.10}})
    smokemap::bench::compare(seeds, sigma_m, sigma_rad);
}
