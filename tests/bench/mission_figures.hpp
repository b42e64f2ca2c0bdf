#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "simulation/demo_scenario.hpp"
#include "tests/bench/plan_building_figures.hpp"
#include "tests/support/mission.hpp"

namespace smokemap::bench {

/// The command line that the mission benchmarks share.
struct MissionOptions {
  int seeds = 20, first = 1;
  int rooms = 3;         ///< of each building
  std::string room;      ///< only this one
  std::string data;      ///< folder of data sets
  std::string pictures;  ///< folder
  bool read = false;     ///< the plan as the layout reader reads its picture
  bool trace = false;    ///< a line a second
};
/// @param seeds  if the command line does not say how many
MissionOptions mission_options(int argc, char** argv, int seeds, const std::string& about);

/// A mission in the building that a real plan shows: the robot starts in the middle of some room from which others can
/// be reached, out of the smoke if there is any such room. kDegenerate if there is none.
Result<DemoScenario> mission_in(const RealPlan& plan, const std::string& data, std::uint64_t seed);

/// Rooms by their smoke a minute after the robot came, thickest first; those beside its start and those that it cannot
/// enter are left out.
std::vector<int> smoky_rooms(const DemoScenario& demo);

/// The goal is this room now. False: no way leads there.
bool send_to(DemoScenario& demo, int room);

/// Cells of the map that say what is not so, by the smoke there.
struct FalseCells {
  int occupied_clear = 0, occupied_smoke = 0;  ///< called occupied, and nothing stands within 30 cm
  int free = 0;                                ///< called free, and hidden from everywhere that the robot was
  double wall_free_m = 0;                      ///< length of what stands there and is called free all around
};
FalseCells count_false(const DemoScenario& demo, const test::MissionResult& result);

/// Flies missions and prints them, one line each.
class MissionTable {
 public:
  explicit MissionTable(MissionOptions options) : options_(std::move(options)) {}

  void print_head() const;
  /// With options.pictures: the sensed map (smoke red, false free cells magenta) and the merged walls on it, confirmed
  /// and moved green, unseen blue, missing red, new orange; true walls thin black, the way grey, bumps as crosses.
  void fly(const std::string& name, const DemoScenario& demo, test::MissionParams params);
  /// How the missions ended, and why those that did not arrive.
  void print_summary() const;
  /// Every goal was reached, or refused with a reason, and nothing was touched.
  bool faultless() const;

 private:
  MissionOptions options_;
  int missions_ = 0, reached_ = 0, refused_ = 0, wrong_ = 0, waiting_ = 0, bumps_ = 0, within_two_sigma_ = 0;
  int false_walls_ = 0, false_free_ = 0;
  double wall_free_m_ = 0;
  std::vector<double> pose_errors_m_, cpu_s_;
  std::map<std::string, int> reasons_;
};

}  // namespace smokemap::bench
