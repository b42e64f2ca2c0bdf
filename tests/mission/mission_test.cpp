// The main job from end to end without a browser: explore, correct the plan, reach a room that no robot has seen.
#include "tests/support/mission.hpp"

#include <gtest/gtest.h>

#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

TEST(Mission, TheRobotReachesARoomNobodySawAndThePlanGetsBetter) {
  const auto demo = make_demo();
  ASSERT_THAT(demo, test::IsOk());
  const test::MissionResult r = test::run_mission(*demo, {});
  EXPECT_EQ(r.goal, GoalState::kArrived) << r.reason;
  EXPECT_LT(r.goal_error_m, 1.0) << "metres from the place meant, in truth";
  EXPECT_LT(r.after_seen_median_m, 0.5 * r.before_median_m);
  EXPECT_LT(r.after_median_m, r.before_median_m);
  EXPECT_LT(r.pose_error_m, 0.3);
  EXPECT_EQ(r.bumps, 0);
}

}  // namespace
}  // namespace smokemap
