// Goals in rooms never visited: ./run bench missions [--data DIR] [--seeds N] [--first N] [--read] [--pictures FOLDER]
// [--trace]. Lidar and radar, a fire whose smoke spreads, a plan that is wrong as real ones are. With --data (the
// folder with acg/layouts) seeds 1 to N go in turn to the buildings that the plans of the published experiments show
// (Hannover, Dortmund, Oerebro) and to a generated building; without it to generated buildings only. Every other goal
// lies in the room with the thickest smoke that can be reached, the others in the farthest room whose way is hazy at
// most. Each mission is to be reached or refused with a reason, and nothing is to be touched: exit status 1 otherwise.
#include <cstdio>

#include "tests/bench/mission_figures.hpp"

namespace {

using namespace smokemap;

struct Site {
  std::string name;
  Result<DemoScenario> demo;
};

Site site_of(const std::string& data, int seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  const auto& plans = bench::real_plans();
  const std::size_t which = static_cast<std::size_t>(seed - 1) % (plans.size() + 1);
  if (data.empty() || which == plans.size()) return {"generated " + std::to_string(seed), make_demo(number)};
  return {plans[which].name + " " + std::to_string(seed), bench::mission_in(plans[which], data, number)};
}

}  // namespace

int main(int argc, char** argv) {
  const bench::MissionOptions options = bench::mission_options(
      argc, argv, 100, "Goals in rooms never visited, with a plan that is wrong as real ones are");
  bench::MissionTable table(options);
  table.print_head();
  for (int seed = options.first; seed < options.first + options.seeds; ++seed) {
    Site site = site_of(options.data, seed);
    if (!site.demo) {
      std::printf("%-14s no scenario: %s\n", site.name.c_str(), site.demo.error().message.c_str());
      continue;
    }
    const bool smokiest = (seed - 1) / static_cast<int>(bench::real_plans().size() + 1) % 2 == 1;
    if (smokiest)
      if (const auto rooms = bench::smoky_rooms(*site.demo); !rooms.empty()) bench::send_to(*site.demo, rooms.front());
    test::MissionParams params;
    params.smoke_spreads = true;
    params.explore_s = 5;  // a small house would be seen before the goal is given
    params.limit_s = 600;
    table.fly(site.name, *site.demo, params);
  }
  table.print_summary();
  return table.faultless() ? 0 : 1;
}
