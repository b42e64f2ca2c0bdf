// smoke_beams_bench [--seeds N]: how surely a lidar echo of smoke is told from a wall, by its range.
//
// In burning buildings (smoke as it has spread after some minutes) a robot drives through places where there is smoke,
// lidar and radar turning; what slam/smoke says about each echo is compared with what truly ended the beam. Printed a
// ring of ranges: echoes of smoke and how many were found; echoes of walls and how many were called smoke; and which
// share of what was called smoke is smoke.
#include <algorithm>
#include <array>
#include <cstdio>

#include "core/random.hpp"
#include "simulation/demo_scenario.hpp"
#include "simulation/lidar.hpp"
#include "simulation/radar.hpp"
#include "slam/smoke.hpp"
#include "tests/bench/bench_options.hpp"

namespace smokemap::bench {
namespace {

constexpr int kPlaces = 40;      ///< a building
constexpr int kScansBefore = 4;  ///< driven before the one that is judged
constexpr double kSpeed_mps = 0.5, kTurn_radps = 0.4, kScan_s = 0.1;
constexpr double kSmoky = 0.05;  ///< extinction at the robot, 1/m
constexpr std::array<double, 8> kRings_m{0, 0.5, 1, 2, 3, 4, 6, 15};

struct Ring {
  int smoke = 0, wall = 0;
  std::array<int, 2> found{}, mistaken{};  ///< by the scan alone, and with the scans before it
};
using Tally = std::array<Ring, kRings_m.size() - 1>;

void count(const SimulatedScan& scan, const std::array<SmokeView, 2>& views, Tally& tally) {
  for (std::size_t i = 0; i < scan.fate.size(); ++i) {
    if (scan.fate[i] == BeamFate::kLost) continue;
    const auto range = static_cast<double>(scan.scan.ranges_m[i]);
    const auto above = std::upper_bound(kRings_m.begin() + 1, kRings_m.end() - 1, range);
    Ring& ring = tally[static_cast<std::size_t>(above - kRings_m.begin() - 1)];
    const bool is_smoke = scan.fate[i] == BeamFate::kSmoke;
    ++(is_smoke ? ring.smoke : ring.wall);
    for (std::size_t v = 0; v < views.size(); ++v) (is_smoke ? ring.found : ring.mistaken)[v] += views[v].beams[i];
  }
}

/// One drive of a few scans; the last one is judged.
void drive(const SegmentWorld& walls, const SmokeField& smoke, const Pose2& T_world_start, std::mt19937_64& random,
           Tally& tally) {
  const Twist2 twist{{uniform(random, 0.0, kSpeed_mps), 0}, uniform(random, -kTurn_radps, kTurn_radps)};
  const RadarSweep sweep = simulate_sweep(walls, T_world_start, T_world_start * twist.after(0.4), 0, {}, random);
  ScanMemory memory;
  for (int k = 0; k <= kScansBefore; ++k) {
    const Pose2 T_start_now = twist.after(k * kScan_s);
    const SimulatedScan scan =
        simulate_scan(walls, smoke, T_world_start * T_start_now, T_world_start * twist.after((k + 1) * kScan_s),
                      from_seconds(k * kScan_s), {}, random);
    if (k == kScansBefore)
      count(scan,
            {look_for_smoke(scan.scan, {}, sweep, T_start_now.inverse(), {}),
             look_for_smoke(scan.scan, {}, sweep, T_start_now.inverse(), {}, {&memory, T_start_now})},
            tally);
    memory.remember(scan.scan, {}, T_start_now);
  }
}

void print(const char* name, const Tally& tally) {
  std::printf("\n%s\n%-12s %7s %7s | %-30s | %s\n%-12s %7s %7s | %9s %9s %10s | %9s %9s %10s\n", name, "", "", "",
              "the scan alone", "with the scans before", "range m", "smoke", "walls", "found", "mistaken", "precision",
              "found", "mistaken", "precision");
  for (std::size_t i = 0; i < tally.size(); ++i) {
    const Ring& r = tally[i];
    std::printf("%4.1f - %4.1f  %7d %7d", kRings_m[i], kRings_m[i + 1], r.smoke, r.wall);
    for (const std::size_t v : {0UL, 1UL}) {
      const int called = r.found[v] + r.mistaken[v];
      std::printf(" | %8.1f%% %8.2f%% %9.1f%%", 100.0 * r.found[v] / std::max(1, r.smoke),
                  100.0 * r.mistaken[v] / std::max(1, r.wall), called > 0 ? 100.0 * r.found[v] / called : 100.0);
    }
    std::printf("\n");
  }
}

/// Smoke of one thickness everywhere: in haze lidar echoes come from farther away.
SmokeField haze(const SegmentWorld& walls, double extinction_per_m) {
  SmokeField smoke(walls, {});
  const GridFrame& frame = smoke.frame();
  Cell cell;
  for (cell.y = 0; cell.y < frame.height_cells; ++cell.y)
    for (cell.x = 0; cell.x < frame.width_cells; ++cell.x)
      smoke.set_extinction(frame.center_of(cell), extinction_per_m);
  return smoke;
}

void run(int seeds) {
  Tally smoky{}, clear{}, hazy{};
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto demo = make_demo(static_cast<std::uint64_t>(seed));
    if (!demo) continue;
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const SegmentWorld& walls = demo->world.walls;
    const SmokeField thin = haze(walls, seed % 2 ? 0.1 : 0.3);
    int in_smoke = 0, in_clear = 0;
    for (int tries = 0; tries < 100 * kPlaces && (in_smoke < kPlaces || in_clear < kPlaces / 4); ++tries) {
      const Pose2 at(uniform(random, walls.low().x(), walls.high().x()),
                     uniform(random, walls.low().y(), walls.high().y()), uniform(random, -kPi, kPi));
      if (demo->building.room_at(at.translation()) < 0 || walls.clearance_m(at.translation(), 1) < 0.5) continue;
      const double extinction = demo->world.smoke.extinction_at(at.translation());
      if (extinction > kSmoky && in_smoke < kPlaces) ++in_smoke, drive(walls, demo->world.smoke, at, random, smoky);
      if (extinction < 1e-3 && in_clear < kPlaces / 4) {
        ++in_clear;
        drive(walls, demo->world.smoke, at, random, clear);
        drive(walls, thin, at, random, hazy);
      }
    }
  }
  print("in smoke", smoky);
  print("in haze everywhere (0.1 or 0.3 a metre)", hazy);
  print("in clear air, or nearly", clear);
}

}  // namespace
}  // namespace smokemap::bench

int main(int argc, char** argv) {
  smokemap::bench::run(smokemap::bench::seeds_option(
      argc, argv, 20, "How surely a lidar echo of smoke is told from a wall, by its range"));
}
