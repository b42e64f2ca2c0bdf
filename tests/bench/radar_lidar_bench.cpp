// radar_lidar_bench [--seeds N]: both sensors through the simulated twin of Paper VI's experiments (three runs of a
// truck in a hall, no odometry), and through a burning building.
//
// Printed a run and sensor: the paper's displacement measure (difference of step lengths, turn wrapped by a full
// circle), the relation error of the same steps, and the error of the whole trajectory. Then, a seed a line: ATE in a
// random building full of smoke with the radar alone, and in the burning one with lidar, radar and both.
#include <cstdio>

#include "tests/bench/bench_options.hpp"
#include "tests/bench/radar_figures.hpp"

namespace smokemap::bench {
namespace {

void twin() {
  std::printf("%-10s %-6s %8s %8s %10s %8s %9s %s\n", "run", "sensor", "paper m", "rad", "step m", "deg", "ATE m",
              "loops/lost");
  for (const TwinFigures& f : paper_twin())
    std::printf("%-10s %-6s %8.4f %8.4f %10.4f %8.3f %9.4f %6lld/%lld\n", f.run.c_str(),
                f.sensor == Use::kLidar ? "lidar" : "radar", f.paper.length_m.mean, f.paper.heading_rad.mean,
                f.step.translation_m.mean, degrees(f.step.rotation_rad.mean), f.whole.rmse_m,
                static_cast<long long>(f.counters.loops_closed), static_cast<long long>(f.counters.lost));
}

void print(const RunFigures& f) {
  std::printf(" %8.3f %8.3f %5lld", f.whole.rmse_m, f.whole.most_m, static_cast<long long>(f.counters.loops_closed));
  std::fflush(stdout);
}

void buildings(int seeds) {
  std::printf("\n%-5s %-23s | %-23s %-23s %-23s\n%-5s %8s %8s %5s   (the same for the others)\n", "seed",
              "dense smoke: radar", "fire: lidar", "radar", "both", "", "ATE m", "max m", "loops");
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto clear = building_run(seed, false);
    if (!clear) continue;
    std::printf("%-5d", seed);
    print(judged(*clear, Use::kRadar));
    if (const auto burning = seed <= 5 ? building_run(seed, true) : std::nullopt) {
      std::printf(" |");
      for (const Use use : {Use::kLidar, Use::kRadar, Use::kBoth}) print(judged(*burning, use));
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace smokemap::bench

int main(int argc, char** argv) {
  const int seeds = smokemap::bench::seeds_option(
      argc, argv, 20, "Radar and lidar through the twin of the published experiments and through smoke");
  smokemap::bench::twin();
  smokemap::bench::buildings(seeds);
}
