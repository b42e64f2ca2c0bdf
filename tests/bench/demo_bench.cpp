// The demo's mission over many seeds: ./run bench demo [--seeds N] [--read]
// --read takes the plan from the picture by the layout reader, as the server does; without it a perfect reader is used.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "layout/read_layout.hpp"
#include "tests/support/mission.hpp"

int main(int argc, char** argv) {
  int seeds = 20;
  bool read = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--read") == 0) read = true;
    if (std::strcmp(argv[i], "--seeds") == 0 && i + 1 < argc) seeds = std::atoi(argv[++i]);
  }
  std::printf(
      "seed  goal       after s  error m  plan corners before -> after (seen, count)   pose m  bumps  CPU s  reason\n");
  int reached = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto demo = smokemap::make_demo(static_cast<std::uint64_t>(seed));
    if (!demo) {
      std::printf("%4d  no scenario: %s\n", seed, demo.error().message.c_str());
      continue;
    }
    smokemap::test::MissionParams params;
    if (read) {
      smokemap::LayoutOptions options;
      options.metres_per_pixel = demo->picture.metres_per_pixel;
      auto reading = smokemap::read_layout(demo->picture.sheet, options);
      if (reading) params.layout = reading->layout;
    }
    const std::clock_t begin = std::clock();
    const auto r = smokemap::test::run_mission(*demo, params);
    reached += r.goal == smokemap::GoalState::kArrived && r.goal_error_m < 1.0;
    std::printf("%4d  %-9s  %7.1f  %7.2f  %6.2f -> %.2f m (%.2f, %d of %d)  %19.2f  %5d  %5.1f  %s\n", seed,
                to_string(r.goal), r.time_s, r.goal_error_m, r.before_median_m, r.after_median_m, r.after_seen_median_m,
                r.seen, r.corners, r.pose_error_m, r.bumps, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC,
                r.reason.c_str());
    std::fflush(stdout);
  }
  std::printf("reached: %d of %d (place true within 1 m)\n", reached, seeds);
}
