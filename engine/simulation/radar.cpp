#include "simulation/radar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.hpp"
#include "core/expect.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

struct Surface {
  double echo;          ///< relative to metal
  double shine;         ///< exponent of the cosine of incidence: high = mirror-like
  double transmission;  ///< through one face, both ways
  bool mirror;
};

Surface surface_of(Material material, double wall_transmission) {
  const double face = std::sqrt(wall_transmission);  // a wall has two
  switch (material) {
    case Material::kBrick:
      return {0.3, 4, 0, true};
    case Material::kWood:
      return {0.1, 4, face, false};
    case Material::kGlass:
      return {0.1, 20, face, true};
    case Material::kMetal:
      return {1.0, 20, 0, true};
  }
  return {0.3, 4, 0, false};
}

double power_of(double db) { return std::pow(10.0, db / 10); }

/// One azimuth: collects mean power per bin.
class BeamPainter {
 public:
  BeamPainter(const SegmentWorld& world, const RadarSimParams& params) : world_(world), params_(params) {
    const Surface brick = surface_of(Material::kBrick, params.transmission);
    gain_ = power_of(params.snr_db) * std::pow(5.0, 3) / (brick.echo * (1 + params.diffuse));
    echo_.resize(static_cast<std::size_t>(params.bins));
  }

  void clear() { std::fill(echo_.begin(), echo_.end(), 0.0); }
  double power(std::size_t bin) const { return echo_[bin]; }

  /// Follows a ray through walls that let some power pass; `travelled_m` lies before its origin (a mirror's other leg).
  void follow(const Point2& origin, const Point2& direction, double travelled_m, double weight, bool with_ghost) {
    const double reach = params_.bins * params_.bin_m;
    double passed = 0;
    for (int face = 0; face < 8 && weight > 1e-5; ++face) {
      const auto hit = world_.cast(origin + passed * direction, direction, reach - travelled_m - passed);
      if (!hit) return;
      const double way = passed + hit->range_m, total = travelled_m + way;
      const WorldSegment& segment = world_.segments()[static_cast<std::size_t>(hit->segment)];
      const Surface surface = surface_of(segment.material, params_.transmission);
      const double answer = surface.echo * (std::pow(hit->cos_incidence, surface.shine) + params_.diffuse);
      paint(total, gain_ * weight * answer / std::pow(std::max(total, 0.3), 3));
      if (with_ghost && face == 0 && surface.mirror && hit->cos_incidence < 0.95) {
        const Point2 normal = segment.line.normal();
        const Point2 mirrored = direction - 2 * normal.dot(direction) * normal;
        const Point2 bounce = origin + way * direction;
        follow(bounce + 1e-4 * mirrored, mirrored, total, weight * power_of(params_.ghost_db), false);
      }
      weight *= surface.transmission;
      passed = way + 1e-4;
    }
  }

 private:
  /// Hann-windowed point spread: main lobe of about 1.5 bins.
  void paint(double range_m, double power) {
    const double at = range_m / params_.bin_m;
    const int center = static_cast<int>(std::floor(at));
    for (int bin = center - 1; bin <= center + 2; ++bin) {
      if (bin < 0 || bin >= params_.bins) continue;
      const double off = (bin - at) / 2;
      if (std::abs(off) < 1) echo_[static_cast<std::size_t>(bin)] += power * std::pow(std::cos(off * kPi / 2), 4);
    }
  }

  const SegmentWorld& world_;
  const RadarSimParams& params_;
  double gain_ = 1;
  std::vector<double> echo_;
};

struct SubRay {
  double angle_rad;
  double weight;
};

/// Rays across the Gaussian beam, and one on either side for the side lobes.
std::vector<SubRay> sub_rays(const RadarSimParams& params) {
  std::vector<SubRay> rays;
  const double sigma = params.beam_width_rad / 2.355 / std::sqrt(2.0);  // two-way pattern
  double sum = 0;
  for (int i = -3; i <= 3; ++i) {
    const double angle = i * params.beam_width_rad * 0.35;
    rays.push_back({angle, std::exp(-0.5 * angle * angle / (sigma * sigma))});
    sum += rays.back().weight;
  }
  for (SubRay& ray : rays) ray.weight /= sum;
  for (const double side : {-2.2, 2.2}) rays.push_back({side * params.beam_width_rad, power_of(params.side_lobe_db)});
  return rays;
}

}  // namespace

Result<Ok> RadarSimParams::validate() const {
  return ParamCheck("RadarSimParams")
      .in_range("azimuths", azimuths, 1, 4000)
      .in_range("bins", bins, 8, 8000)
      .in_range("bin_m", bin_m, 0.005, 2)
      .in_range("turn_s", turn_s, 0.01, 10)
      .in_range("beam_width_rad", beam_width_rad, 0.001, 0.3)
      .in_range("side_lobe_db", side_lobe_db, -80, 0)
      .in_range("snr_db", snr_db, 0, 80)
      .in_range("diffuse", diffuse, 0, 1)
      .in_range("transmission", transmission, 0, 1)
      .in_range("ghost_share", ghost_share, 0, 1)
      .in_range("ghost_db", ghost_db, -80, 0)
      .in_range("saturation_db", saturation_db, 10, 100)
      .in_range("blind_m", blind_m, 0, 10)
      .result();
}

RadarSweep simulate_sweep(const SegmentWorld& world, const Pose2& T_world_start, const Pose2& T_world_end, Stamp stamp,
                          const RadarSimParams& params, std::mt19937_64& random) {
  ENGINE_EXPECT(params.validate().ok());
  RadarSweep sweep;
  sweep.stamp = stamp;
  sweep.duration_s = params.turn_s;
  sweep.azimuth_min_rad = -kPi;
  sweep.azimuth_increment_rad = 2 * kPi / params.azimuths;
  sweep.range_resolution_m = params.bin_m;
  sweep.azimuths = params.azimuths;
  sweep.bins = params.bins;
  sweep.T_robot_radar = params.T_robot_radar;
  sweep.power.reserve(static_cast<std::size_t>(params.azimuths) * static_cast<std::size_t>(params.bins));

  BeamPainter painter(world, params);
  const std::vector<SubRay> rays = sub_rays(params);
  const double ceiling = power_of(params.saturation_db);
  const auto blind = static_cast<std::size_t>(params.blind_m / params.bin_m);
  for (int i = 0; i < params.azimuths; ++i) {
    const Pose2 T_world_radar =
        interpolate(T_world_start, T_world_end, static_cast<double>(i) / params.azimuths) * params.T_robot_radar;
    const double azimuth = T_world_radar.heading() + sweep.azimuth_min_rad + i * sweep.azimuth_increment_rad;
    const bool ghost = uniform01(random) < params.ghost_share;
    painter.clear();
    for (const SubRay& ray : rays) {
      const Point2 direction(std::cos(azimuth + ray.angle_rad), std::sin(azimuth + ray.angle_rad));
      painter.follow(T_world_radar.translation(), direction, 0, ray.weight, ghost);
    }
    for (std::size_t bin = 0; bin < static_cast<std::size_t>(params.bins); ++bin) {
      const double mean = 1 + (bin < blind ? 0 : painter.power(bin));
      sweep.power.push_back(static_cast<float>(std::min(mean * exponential(random), ceiling)));
    }
  }
  return sweep;
}

LaserScan strongest_returns(const RadarSweep& sweep, double floor_db) {
  LaserScan scan;
  scan.stamp = sweep.stamp;
  scan.robot = sweep.robot;
  scan.angle_min_rad = sweep.azimuth_min_rad;
  scan.angle_increment_rad = sweep.azimuth_increment_rad;
  scan.time_increment_s = sweep.azimuths > 0 ? sweep.duration_s / sweep.azimuths : 0;
  scan.range_min_m = sweep.range_min_m;
  scan.range_max_m = sweep.range_min_m + sweep.bins * sweep.range_resolution_m;
  scan.T_robot_laser = sweep.T_robot_radar;
  const auto bins = static_cast<std::size_t>(sweep.bins);
  for (std::size_t row = 0; row < static_cast<std::size_t>(sweep.azimuths); ++row) {
    const auto begin = sweep.power.begin() + static_cast<std::ptrdiff_t>(row * bins);
    const auto best = std::max_element(begin, begin + static_cast<std::ptrdiff_t>(bins));
    const bool found = bins > 0 && *best >= power_of(floor_db);
    scan.ranges_m.push_back(
        found ? static_cast<float>(sweep.range_min_m + static_cast<double>(best - begin) * sweep.range_resolution_m)
              : std::numeric_limits<float>::infinity());
    scan.intensities.push_back(found ? *best : 0.0F);
  }
  return scan;
}

}  // namespace smokemap
