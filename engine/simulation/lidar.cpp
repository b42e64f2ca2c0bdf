#include "simulation/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/check.hpp"
#include "core/expect.hpp"
#include "core/random.hpp"

namespace smokemap {
namespace {

constexpr double kGlassShare = 0.15;  ///< of beams that a pane sends back unless it is met square on

float no_echo_value(const LidarParams& params) {
  switch (params.no_echo) {
    case NoEcho::kInfinity:
      return std::numeric_limits<float>::infinity();
    case NoEcho::kZero:
      return 0;
    case NoEcho::kNan:
      return std::numeric_limits<float>::quiet_NaN();
    case NoEcho::kMaxPlusOne:
      break;
  }
  return static_cast<float>(params.range_max_m + 1);
}

/// The surface that answers: panes let most light through.
std::optional<RayHit> first_answer(const SegmentWorld& world, const Point2& origin, const Point2& direction,
                                   double limit_m, std::mt19937_64& random) {
  double passed = 0;
  for (int pane = 0; pane < 8; ++pane) {
    auto hit = world.cast(origin + passed * direction, direction, limit_m - passed);
    if (!hit) return std::nullopt;
    hit->range_m += passed;
    const Material material = world.segments()[static_cast<std::size_t>(hit->segment)].material;
    if (material != Material::kGlass || hit->cos_incidence > 0.99 || uniform01(random) < kGlassShare) return hit;
    passed = hit->range_m + 1e-4;
  }
  return std::nullopt;
}

/// A place on the ray drawn with density alpha(s) exp(-2 integral) / max(s, 0.5)^2.
double draw_smoke_range(const std::vector<SmokePiece>& pieces, std::mt19937_64& random) {
  constexpr double kStep = 0.05;
  double depth = 0, total = 0;
  std::vector<std::pair<double, double>> cumulated;  // range, weight up to there
  for (const SmokePiece& piece : pieces)
    for (double s = piece.from_m; s < piece.to_m; s += kStep) {
      const double width = std::min(kStep, piece.to_m - s), middle = s + width / 2;
      depth += piece.extinction_per_m * width;
      total += width * piece.extinction_per_m * std::exp(-2 * depth) / std::pow(std::max(middle, 0.5), 2);
      cumulated.emplace_back(middle, total);
    }
  const double wanted = uniform01(random) * total;
  const auto found = std::lower_bound(cumulated.begin(), cumulated.end(), wanted,
                                      [](const auto& entry, double value) { return entry.second < value; });
  const double range = found == cumulated.end() ? cumulated.back().first : found->first;
  return range + normal(random, 0.1);
}

struct Beam {
  BeamFate fate = BeamFate::kLost;
  double range_m = 0;
  double intensity = 0;
};

Beam shoot(const SegmentWorld& world, const SmokeField& smoke, const Point2& origin, double angle,
           const LidarParams& params, std::vector<SmokePiece>& pieces, std::mt19937_64& random) {
  // The echo comes from one part of the beam: at an edge sometimes from the near side, sometimes from the far one.
  angle += params.beam_width_rad * (uniform01(random) - 0.5);
  const Point2 direction(std::cos(angle), std::sin(angle));
  const auto hit = first_answer(world, origin, direction, params.range_max_m, random);
  const double reach = hit ? hit->range_m : params.range_max_m;
  double depth = 0;
  if (!smoke.empty()) {
    smoke.trace(origin, direction, reach, pieces);
    for (const SmokePiece& piece : pieces) depth += (piece.to_m - piece.from_m) * piece.extinction_per_m;
    if (depth > 0 && uniform01(random) < 1 - std::exp(-params.smoke_echo * depth)) {
      const double range = draw_smoke_range(pieces, random);
      if (range >= params.range_min_m && range < reach) return {BeamFate::kSmoke, range, 0.1 * std::exp(-2 * depth)};
      return {};
    }
  }
  if (!hit) return {};
  const double answer = reflectance(world.segments()[static_cast<std::size_t>(hit->segment)].material);
  const double margin = params.margin_db - 20 * std::log10(std::max(reach, 0.1)) - 8.686 * depth +
                        10 * std::log10(std::max(answer * hit->cos_incidence, 1e-6) / 0.1);
  if (margin + normal(random, params.sigma_margin_db) <= 0 || uniform01(random) < params.dropout) return {};
  const double range = reach + normal(random, params.sigma_range_m);
  if (range < params.range_min_m || range > params.range_max_m) return {};
  return {BeamFate::kWall, range, answer * hit->cos_incidence * std::exp(-2 * depth)};
}

}  // namespace

Result<Ok> LidarParams::validate() const {
  return ParamCheck("LidarParams")
      .in_range("beams", beams, 1, 20000)
      .in_range("angle_min_rad", angle_min_rad, -2 * kPi, 2 * kPi)
      .in_range("field_of_view_rad", field_of_view_rad, 0.01, 2 * kPi + 1e-9)
      .in_range("range_min_m", range_min_m, 0, 5)
      .in_range("range_max_m", range_max_m, range_min_m + 0.1, 1000)
      .in_range("turn_s", turn_s, 0, 10)
      .in_range("sigma_range_m", sigma_range_m, 0, 1)
      .in_range("dropout", dropout, 0, 1)
      .in_range("beam_width_rad", beam_width_rad, 0, 0.1)
      .in_range("margin_db", margin_db, 0, 120)
      .in_range("sigma_margin_db", sigma_margin_db, 0, 20)
      .in_range("smoke_echo", smoke_echo, 0, 10)
      .result();
}

double reflectance(Material material) {
  switch (material) {
    case Material::kBrick:
      return 0.4;
    case Material::kWood:
      return 0.5;
    case Material::kGlass:
      return 0.1;
    case Material::kMetal:
      return 0.3;
  }
  return 0.4;
}

SimulatedScan simulate_scan(const SegmentWorld& world, const SmokeField& smoke, const Pose2& T_world_start,
                            const Pose2& T_world_end, Stamp stamp, const LidarParams& params, std::mt19937_64& random) {
  ENGINE_EXPECT(params.validate().ok());
  SimulatedScan out;
  LaserScan& scan = out.scan;
  scan.stamp = stamp;
  scan.angle_min_rad = params.angle_min_rad;
  scan.angle_increment_rad = params.field_of_view_rad / params.beams;
  scan.time_increment_s = params.skew ? params.turn_s / params.beams : 0.0;
  scan.range_min_m = params.range_min_m;
  scan.range_max_m = params.range_max_m;
  scan.T_robot_laser = params.T_robot_laser;
  const float nothing = no_echo_value(params);
  std::vector<SmokePiece> pieces;
  for (int i = 0; i < params.beams; ++i) {
    const double share = params.skew ? static_cast<double>(i) / params.beams : 0.0;
    const Pose2 T_world_laser = interpolate(T_world_start, T_world_end, share) * params.T_robot_laser;
    const double angle = T_world_laser.heading() + scan.angle_min_rad + i * scan.angle_increment_rad;
    const Beam beam = shoot(world, smoke, T_world_laser.translation(), angle, params, pieces, random);
    out.fate.push_back(beam.fate);
    scan.ranges_m.push_back(beam.fate == BeamFate::kLost ? nothing : static_cast<float>(beam.range_m));
    scan.intensities.push_back(static_cast<float>(beam.intensity));
  }
  return out;
}

}  // namespace smokemap
