// Rays per second of the simulator's world, one thread, CPU time, sine and cosine of every ray included.
// Data: random two-wing buildings side by side (seed 1) up to the wanted number of segments, and one building with boxes.
#include <cstdio>
#include <ctime>
#include <vector>

#include "core/random.hpp"
#include "simulation/random_building.hpp"
#include "simulation/segment_world.hpp"

namespace {

using namespace smokemap;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Buildings and boxes in a square of tiles until there are about `count` segments.
SegmentWorld town(std::size_t count, int furniture, std::mt19937_64& random) {
  std::vector<WorldSegment> all;
  RandomBuildingParams params;
  params.furniture = furniture;
  for (int tile = 0; all.size() < count; ++tile) {
    const auto plan = random_building(params, random);
    const Point2 shift(32.0 * (tile % 4), 22.0 * (tile / 4));
    const SegmentWorld building = build_world(*plan);
    for (WorldSegment segment : building.segments()) {
      segment.line = {segment.line.a + shift, segment.line.b + shift};
      all.push_back(segment);
    }
  }
  return SegmentWorld(all);
}

void measure(const char* name, const SegmentWorld& world, std::mt19937_64& random) {
  constexpr int kPoses = 400, kBeams = 1080;
  std::vector<Point2> origins;
  while (origins.size() < kPoses) {
    const Point2 p(uniform(random, world.low().x(), world.high().x()), uniform(random, world.low().y(), world.high().y()));
    if (world.clearance_m(p, 0.3) >= 0.3) origins.push_back(p);
  }
  double sum = 0, seconds = 0;
  std::size_t rays = 0;
  const double begin = cpu_seconds();
  do {
    for (const Point2& origin : origins)
      for (int beam = 0; beam < kBeams; ++beam) {
        const auto hit = world.cast(origin, 2 * kPi * beam / kBeams, 30.0);
        sum += hit ? hit->range_m : 30.0;
      }
    rays += kPoses * kBeams;
    seconds = cpu_seconds() - begin;
  } while (seconds < 1.0);
  std::printf("%-28s %8zu segments  %6.2f million rays/s  mean range %.2f m\n", name, world.segments().size(),
              1e-6 * static_cast<double>(rays) / seconds, sum / static_cast<double>(rays));
}

}  // namespace

int main() {
  std::printf("raycast: %d beams a turn, 400 poses, 30 m, one thread, CPU time, seed 1\n", 1080);
  std::mt19937_64 random(1);
  measure("one building", town(1, 0, random), random);
  measure("one building, furnished", town(1, 60, random), random);
  measure("a block", town(15000, 40, random), random);
  measure("a town", town(150000, 40, random), random);
}
