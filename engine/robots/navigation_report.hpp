#pragma once

#include <cstdint>
#include <string>

namespace smokemap {

/// Where a robot's own navigator is with a goal.
enum class NavigationState {
  kSent,      ///< no answer yet
  kAccepted,  ///< will drive
  kDriving,
  kCancelling,  ///< asked to give it up, not yet done
  kArrived,     ///< final, as all below
  kCancelled,
  kFailed,    ///< the robot gave up
  kRefused,   ///< the robot will not drive there
  kNoAnswer,  ///< nothing came back within two seconds, or the navigator has gone
};

const char* to_string(NavigationState state);
bool is_final(NavigationState state);

struct NavigationReport {
  std::string robot;
  std::uint64_t goal = 0;  ///< number that send_goal gave
  NavigationState state = NavigationState::kSent;
  double remaining_m = 0;  ///< as the robot says; 0 before it said anything
  double eta_s = 0;
  int recoveries = 0;  ///< how often it had to free itself
};

}  // namespace smokemap
