#include "maps/goal.hpp"

namespace smokemap {

const char* to_string(GoalState state) {
  switch (state) {
    case GoalState::kQueued:
      return "queued";
    case GoalState::kSent:
      return "sent";
    case GoalState::kDriving:
      return "driving";
    case GoalState::kArrived:
      return "arrived";
    case GoalState::kRefused:
      return "refused";
    case GoalState::kCancelled:
      return "cancelled";
    case GoalState::kFailed:
      return "failed";
  }
  return "failed";
}

bool is_final(GoalState state) {
  return state == GoalState::kArrived || state == GoalState::kRefused || state == GoalState::kCancelled ||
         state == GoalState::kFailed;
}

}  // namespace smokemap
