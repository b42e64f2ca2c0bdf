#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "maps/merged_map.hpp"
#include "simulation/recorded_run.hpp"

namespace smokemap::bench {

/// A row of the benchmark: what is wrong with the plan, the start and the wheels.
struct AcgScenario {
  std::string name;
  double noise = 0.1;  ///< of the wheels: share of each step's way and turn, the sign holds for two metres (Paper V)
  double stretch = 0.10;
  double missing_share = 0.10, phantom_share = 0.10;  ///< of the inner walls of two metres or more
  double spurious_share = 0;                          ///< corners that are none, of those a scan shows
  double start_m = 0.3, start_deg = 2;                ///< how far the start hint is off, exactly
  bool online = false;                                ///< updates after every node; slow
};

enum class AcgMethod { kOurs, k2017, k2019 };

/// A wall of the plan that bends more than any other.
struct TurnedWall {
  double turned_deg = 0;
  int layout_wall = -1;
  double length_m = 0;
  WallState state = WallState::kUnseen;
  double plan_turned_deg = 0;  ///< the plan as a whole, from where it truly lies
  std::size_t nodes = 0;       ///< of the graph when it did
};

struct AcgScore {
  double pose_before_m = 0, pose_m = 0, yaw_rad = 0;
  double before_m = 0, seen_m = 0, never_before_m = 0, never_m = 0;
  double within_seen = 0, within_never = 0;  ///< share of errors within two sigma
  double links_right = 0, links_found = 0;
  double missing_right = 1, missing_found = 1, new_right = 1, new_found = 1;
  double fit = 0;
  double update_s = 0, slowest_s = 0;          ///< CPU of one update; of the only one unless online
  double turned_deg = 0, plan_turned_deg = 0;  ///< the most in any update, if online
  TurnedWall turned;
  int never = 0;  ///< corners no echo came near
  bool success = false;
};

/// A problem and what the robot's sensors said in it. Costly; rows that differ in the wheels or the start share it.
struct AcgProblem {
  DemoScenario demo;
  RecordedRun run;
};
Result<AcgProblem> make_acg_problem(const AcgScenario& scenario, std::uint64_t seed);

/// The real front end (SLAM) and the real alignment, no true pose anywhere.
Result<AcgScore> run_acg(const AcgScenario& scenario, const AcgProblem& problem, std::uint64_t seed, AcgMethod method);

double cpu_now_s();  ///< of this thread
double median_of(std::vector<double> values);

}  // namespace smokemap::bench
