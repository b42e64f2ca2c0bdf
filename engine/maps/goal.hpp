#pragma once

#include <optional>
#include <string>

#include "core/time.hpp"
#include "maps/point_of_interest.hpp"

namespace smokemap {

enum class GoalState { kQueued, kSent, kDriving, kArrived, kRefused, kCancelled, kFailed };

const char* to_string(GoalState state);
bool is_final(GoalState state);

/// Where somebody wants a robot to be.
struct Goal {
  std::string id;  ///< made by the client
  std::string robot;
  Place place;
  std::optional<double> heading_rad;
  std::string author;
  Stamp created = 0;
  GoalState state = GoalState::kQueued;
  std::string reason;  ///< why refused or failed, for people
};

}  // namespace smokemap
