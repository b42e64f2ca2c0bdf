#include "simulation/wall_witness.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kPieceM = 0.15, kReachM = 0.25, kSpareM = 0.3;

std::size_t piece_at(double share, std::size_t pieces) {
  const auto last = static_cast<double>(pieces - 1);
  return static_cast<std::size_t>(std::clamp(std::floor(share * static_cast<double>(pieces)), 0.0, last));
}

}  // namespace

WallWitness::WallWitness(const std::vector<Segment2>& walls) {
  for (const Segment2& line : walls) {
    const auto pieces = static_cast<std::size_t>(std::max(1.0, std::round(line.length() / kPieceM)));
    const Point2 reach(kReachM, kReachM);
    walls_.push_back({line, line.a.cwiseMin(line.b) - reach, line.a.cwiseMax(line.b) + reach, std::vector<int>(pieces),
                      std::vector<int>(pieces)});
  }
}

void WallWitness::add(const LaserScan& scan, const Pose2& T_world_start, const Pose2& T_world_end) {
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (classify(scan.ranges_m[i], scan, {}) != BeamKind::kHit) continue;
    const double share = static_cast<double>(i) / static_cast<double>(scan.ranges_m.size());
    const Pose2 T_world_laser = interpolate(T_world_start, T_world_end, share) * scan.T_robot_laser;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
    const Point2 p_laser = static_cast<double>(scan.ranges_m[i]) * Point2(std::cos(angle), std::sin(angle));
    const Point2 p_world = T_world_laser * p_laser;
    add_echo(p_world);
    add_beam(T_world_laser.translation(), p_world);
  }
}

void WallWitness::add_echo(const Point2& p) {
  for (Tally& wall : walls_) {
    if (p.x() < wall.low.x() || p.y() < wall.low.y() || p.x() > wall.high.x() || p.y() > wall.high.y()) continue;
    const double at = along(wall.line, p);
    if (at < 0 || at > 1 || distance(wall.line, p) > kReachM) continue;
    ++wall.echoes[piece_at(at, wall.echoes.size())];
  }
}

void WallWitness::add_beam(const Point2& from, const Point2& to) {
  for (Tally& wall : walls_) {
    const double side_from = signed_line_distance(wall.line, from), side_to = signed_line_distance(wall.line, to);
    if (side_from * side_to >= 0 || std::min(std::abs(side_from), std::abs(side_to)) < kSpareM) continue;
    const double at = along(wall.line, from + side_from / (side_from - side_to) * (to - from));
    if (at >= 0 && at <= 1) ++wall.crossings[piece_at(at, wall.crossings.size())];
  }
}

double WallWitness::share(const std::vector<int>& counts, int least) {
  const auto enough = std::count_if(counts.begin(), counts.end(), [&](int count) { return count >= least; });
  return static_cast<double>(enough) / static_cast<double>(counts.size());
}

double WallWitness::seen(int wall, int least) const {
  return share(walls_[static_cast<std::size_t>(wall)].echoes, least);
}
double WallWitness::crossed(int wall, int least) const {
  return share(walls_[static_cast<std::size_t>(wall)].crossings, least);
}

std::vector<Segment2> WallWitness::seen_parts(int wall, int least) const {
  const Tally& tally = walls_[static_cast<std::size_t>(wall)];
  const auto at = [&](std::size_t piece) -> Point2 {
    return tally.line.a +
           static_cast<double>(piece) / static_cast<double>(tally.echoes.size()) * (tally.line.b - tally.line.a);
  };
  std::vector<Segment2> parts;
  bool before = false;
  for (std::size_t i = 0; i < tally.echoes.size(); ++i) {
    const bool here = tally.echoes[i] >= least;
    if (here && !before) parts.push_back({at(i), at(i + 1)});
    if (here && before) parts.back().b = at(i + 1);
    before = here;
  }
  return parts;
}

int WallWitness::echoes_near(int wall, const Point2& p_world, double radius_m) const {
  const Tally& tally = walls_[static_cast<std::size_t>(wall)];
  int sum = 0;
  for (std::size_t i = 0; i < tally.echoes.size(); ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(tally.echoes.size());
    if ((tally.line.a + at * (tally.line.b - tally.line.a) - p_world).norm() <= radius_m) sum += tally.echoes[i];
  }
  return sum;
}

}  // namespace smokemap
