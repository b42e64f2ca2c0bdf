#include "slam/radar_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "slam/principal_line.hpp"

namespace smokemap {
namespace {

constexpr double kApart_m = 0.5;  ///< echoes of one azimuth this far apart are two surfaces

/// Echoes by cells of the neighbourhood's size.
class EchoGrid {
 public:
  EchoGrid(const std::vector<RadarEcho>& echoes, double cell_m) : echoes_(echoes), cell_m_(cell_m) {
    for (std::size_t i = 0; i < echoes.size(); ++i)
      cells_[key(column(echoes[i].p.x()), column(echoes[i].p.y()))].push_back(i);
  }
  template <typename Visit>
  void around(const Point2& p, double radius_m, Visit&& visit) const {
    const int reach = static_cast<int>(std::ceil(radius_m / cell_m_));
    for (int y = column(p.y()) - reach; y <= column(p.y()) + reach; ++y)
      for (int x = column(p.x()) - reach; x <= column(p.x()) + reach; ++x) {
        const auto cell = cells_.find(key(x, y));
        if (cell == cells_.end()) continue;
        for (const std::size_t i : cell->second)
          if ((echoes_[i].p - p).norm() <= radius_m) visit(echoes_[i]);
      }
  }

 private:
  int column(double v) const { return static_cast<int>(std::floor(v / cell_m_)); }
  static std::int64_t key(int x, int y) { return (static_cast<std::int64_t>(x) << 32) ^ static_cast<std::uint32_t>(y); }
  const std::vector<RadarEcho>& echoes_;
  double cell_m_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

SurfacePoint surface_around(const EchoGrid& grid, const RadarEcho& echo, double radius_m, const Point2& p_sensor) {
  PrincipalLine line;
  double weight = 0;
  grid.around(echo.p, radius_m, [&](const RadarEcho& other) {
    line.add(other.p, other.weight);
    weight += other.weight;
  });
  SurfacePoint point{echo.p, Point2::Zero(), std::log1p(weight)};
  if (line.count() < 4) return point;
  const PrincipalLine::Fit fit = line.fit();
  point.p = fit.mean;
  if (fit.rms_along_m < 2.0 * fit.rms_across_m) return point;
  point.normal = fit.normal.dot(p_sensor - fit.mean) < 0 ? Point2(-fit.normal) : fit.normal;
  return point;
}

/// Of each azimuth the nearest echo that others lie beside.
std::vector<const RadarEcho*> nearest_on_surfaces(const std::vector<RadarEcho>& echoes, int azimuths,
                                                  const RadarParams& params) {
  const EchoGrid crowded(echoes, params.spacing_m);
  std::vector<bool> found(static_cast<std::size_t>(azimuths), false);
  std::vector<const RadarEcho*> nearest;
  for (const RadarEcho& echo : echoes) {
    int support = 0;
    crowded.around(echo.p, params.spacing_m, [&](const RadarEcho&) { ++support; });
    if (support < 3 || found[static_cast<std::size_t>(echo.azimuth)]) continue;
    found[static_cast<std::size_t>(echo.azimuth)] = true;
    nearest.push_back(&echo);
  }
  return nearest;
}

}  // namespace

std::vector<RadarEcho> strongest_echoes(const RadarSweep& sweep, const Twist2& twist, const RadarParams& params) {
  std::vector<RadarEcho> echoes;
  std::vector<int> peaks;
  for (int a = 0; a < sweep.azimuths; ++a) {
    const float* power = &sweep.power[static_cast<std::size_t>(a) * static_cast<std::size_t>(sweep.bins)];
    peaks.clear();
    for (int b = 1; b + 1 < sweep.bins; ++b) {
      const double range = sweep.range_min_m + b * sweep.range_resolution_m;
      if (range < params.nearest_m || range > params.farthest_m) continue;
      if (std::isfinite(power[b]) && power[b] >= params.least_power && power[b] >= power[b - 1] &&
          power[b] > power[b + 1])
        peaks.push_back(b);
    }
    std::stable_sort(peaks.begin(), peaks.end(), [&](int i, int j) { return power[i] > power[j]; });
    peaks.resize(std::min(peaks.size(), static_cast<std::size_t>(params.strongest)));
    std::sort(peaks.begin(), peaks.end());  // near to far
    const Pose2 T_start_now = twist.after(sweep.duration_s * a / sweep.azimuths);
    const double angle = sweep.azimuth_min_rad + a * sweep.azimuth_increment_rad;
    double behind = 1, last_range = -kApart_m;
    for (const int b : peaks) {
      const double range = sweep.range_min_m + b * sweep.range_resolution_m;
      if (range - last_range > kApart_m && last_range > 0) behind *= params.behind_share;
      last_range = range;
      const Point2 p = T_start_now * (sweep.T_robot_radar * Point2(range * std::cos(angle), range * std::sin(angle)));
      echoes.push_back({p, a, range, behind * std::log(static_cast<double>(power[b]))});
    }
  }
  return echoes;
}

LaserScan nearest_surfaces(const RadarSweep& sweep, const RadarParams& params) {
  LaserScan scan;
  scan.stamp = sweep.stamp;
  scan.robot = sweep.robot;
  scan.angle_min_rad = sweep.azimuth_min_rad;
  scan.angle_increment_rad = sweep.azimuth_increment_rad;
  scan.range_min_m = params.nearest_m;
  scan.range_max_m = params.farthest_m;
  scan.T_robot_laser = sweep.T_robot_radar;
  scan.ranges_m.assign(static_cast<std::size_t>(sweep.azimuths), std::numeric_limits<float>::infinity());
  const std::vector<RadarEcho> echoes = strongest_echoes(sweep, {}, params);
  for (const RadarEcho* echo : nearest_on_surfaces(echoes, sweep.azimuths, params))
    scan.ranges_m[static_cast<std::size_t>(echo->azimuth)] = static_cast<float>(echo->range_m);
  return scan;
}

ScanPoints surface_points(const RadarSweep& sweep, const Twist2& twist, const RadarParams& radar,
                          const PointParams& points, const std::vector<double>& left_out_m) {
  std::vector<RadarEcho> echoes = strongest_echoes(sweep, twist, radar);
  std::erase_if(echoes, [&](const RadarEcho& echo) {
    const auto azimuth = static_cast<std::size_t>(echo.azimuth);
    return azimuth < left_out_m.size() && left_out_m[azimuth] > 0 &&
           std::abs(echo.range_m - left_out_m[azimuth]) < kApart_m;
  });
  const EchoGrid near(echoes, radar.surface_radius_m);
  const Point2 p_sensor = sweep.T_robot_radar.translation();
  ScanPoints out;
  out.by_radar = true;
  std::vector<Point2> hits;
  std::vector<const RadarEcho*> kept, by_weight;
  for (const RadarEcho& echo : echoes) by_weight.push_back(&echo);
  std::stable_sort(by_weight.begin(), by_weight.end(),
                   [](const RadarEcho* a, const RadarEcho* b) { return a->weight > b->weight; });
  for (const RadarEcho* echo : by_weight) {
    const bool close = std::any_of(kept.begin(), kept.end(),
                                   [&](const RadarEcho* k) { return (k->p - echo->p).norm() < radar.spacing_m; });
    if (!close) kept.push_back(echo);
  }
  for (const RadarEcho* echo : kept) {
    if (out.surface.size() == static_cast<std::size_t>(points.most_points)) break;
    const double radius_m = std::max(radar.surface_radius_m,
                                     radar.surface_azimuths * echo->range_m * std::abs(sweep.azimuth_increment_rad));
    out.surface.push_back(surface_around(near, *echo, radius_m, p_sensor));
  }
  for (const RadarEcho* echo : nearest_on_surfaces(echoes, sweep.azimuths, radar)) hits.push_back(echo->p);
  out.hits_robot = std::make_shared<const std::vector<Point2>>(std::move(hits));
  out.free_ends_robot = std::make_shared<const std::vector<Point2>>();
  return out;
}

}  // namespace smokemap
