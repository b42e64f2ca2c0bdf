// Goals in smoke: ./run bench smoke [--seeds N] [--first N] [--rooms N] [--room NAME] [--read] [--pictures FOLDER]
// [--trace]. The demo's robot is sent to the rooms with the thickest smoke, while it spreads. Counts what the map says
// that is not so: cells called occupied where nothing stands (by the smoke there), and free where no beam of a lidar
// that passed no wall could have been.
#include "tests/bench/mission_figures.hpp"

int main(int argc, char** argv) {
  using namespace smokemap;
  const bench::MissionOptions options =
      bench::mission_options(argc, argv, 6, "Goals in the rooms with the thickest smoke");
  bench::MissionTable table(options);
  table.print_head();
  for (int seed = options.first; seed < options.first + options.seeds; ++seed) {
    auto demo = make_demo(static_cast<std::uint64_t>(seed));
    if (!demo) continue;
    int tried = 0;
    for (const int room : bench::smoky_rooms(*demo)) {
      const bool chosen = options.room.empty()
                              ? tried < options.rooms
                              : demo->building.rooms[static_cast<std::size_t>(room)].name == options.room;
      if (!chosen || !bench::send_to(*demo, room)) continue;
      ++tried;
      test::MissionParams params;
      params.smoke_spreads = true;
      table.fly(std::to_string(seed), *demo, params);
    }
  }
  table.print_summary();
}
