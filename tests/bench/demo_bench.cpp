// The demo's mission over many seeds, in simulated time: ./run bench demo [--seeds N] [--first N] [--read]
// [--pictures FOLDER] [--trace]. The robot explores, then gets a goal on the plan in a room that it never saw.
// --read takes the plan from the picture by the layout reader, as the server does; without it a perfect reader is used.
#include <cstdio>

#include "tests/bench/mission_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  const bench::MissionOptions options = bench::mission_options(argc, argv, 20, "The demo from start to goal");
  bench::MissionTable table(options);
  table.print_head();
  for (int seed = options.first; seed < options.first + options.seeds; ++seed)
    if (const auto demo = make_demo(static_cast<std::uint64_t>(seed)))
      table.fly(std::to_string(seed), *demo, {});
    else
      std::printf("%d: no scenario: %s\n", seed, demo.error().message.c_str());
  table.print_summary();
}
