// Rays per second of the simulator's world, one thread, CPU time, sine and cosine of every ray included.
// Data: random two-wing buildings side by side up to the wanted number of segments; rays start inside.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "simulation/segment_world.hpp"
#include "tests/bench/bench_options.hpp"

namespace {

using namespace smokemap;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Town {
  SegmentWorld world;
  std::vector<Point2> origins;  ///< in rooms and corridors, 0.3 m or more from walls
};

/// Buildings in rows of four until there are about `segments`.
Town build_town(std::size_t segments, int furniture) {
  std::mt19937_64 random(1);
  RandomBuildingParams params;
  params.furniture = furniture;
  std::vector<WorldSegment> all;
  std::vector<Point2> origins;
  for (int tile = 0; all.size() < segments; ++tile) {
    const auto plan = random_building(params, random);
    const SegmentWorld building = build_world(*plan);
    const Point2 shift(32.0 * (tile % 4), 22.0 * (tile / 4));
    for (WorldSegment segment : building.segments()) {
      segment.line = {segment.line.a + shift, segment.line.b + shift};
      all.push_back(segment);
    }
    for (int i = 0; i < 400; ++i) {
      const Point2 p(uniform(random, 0, 30), uniform(random, 0, 20));
      if (plan->room_at(p) >= 0 && building.clearance_m(p, 0.3) >= 0.3) origins.push_back(p + shift);
    }
  }
  for (std::size_t i = origins.size(); i > 1; --i) std::swap(origins[i - 1], origins[uniform_index(random, i)]);
  origins.resize(std::min<std::size_t>(origins.size(), 400));
  return {SegmentWorld(all), origins};
}

void measure(const char* name, const Town& town) {
  constexpr int kBeams = 1080;
  double sum = 0, seconds = 0;
  std::size_t rays = 0;
  const double begin = cpu_seconds();
  do {
    for (const Point2& origin : town.origins)
      for (int beam = 0; beam < kBeams; ++beam) {
        const auto hit = town.world.cast(origin, 2 * kPi * beam / kBeams, 30.0);
        sum += hit ? hit->range_m : 30.0;
      }
    rays += town.origins.size() * kBeams;
    seconds = cpu_seconds() - begin;
  } while (seconds < 1.0);
  std::printf("%-26s %8zu segments  %6.2f million rays/s  mean range %.2f m\n", name, town.world.segments().size(),
              1e-6 * static_cast<double>(rays) / seconds, sum / static_cast<double>(rays));
}

}  // namespace

int main(int argc, char** argv) {
  smokemap::bench::BenchOptions("Rays per second of the simulated world").read(argc, argv);
  std::printf("raycast: 400 places in rooms, 1080 beams a turn, 30 m, one thread, CPU time, seed 1\n");
  measure("one building", build_town(1, 0));
  measure("one building, furnished", build_town(1, 60));
  measure("a block", build_town(15000, 40));
  measure("a town", build_town(150000, 40));
}
