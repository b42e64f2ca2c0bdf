#include "recording/trajectory_tum.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/engine/recording/bag_file.hpp"
#include "tests/support/near.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

TEST(TrajectoryTum, GoesThereAndBackWithEveryNanosecond) {
  std::mt19937_64 random(5);
  Trajectory trajectory;
  for (int i = 0; i < 200; ++i)
    trajectory.push_back({976'052'857'348'896'001 + i * 1'234'567,
                          Pose2(uniform(random, -100, 100), uniform(random, -100, 100), uniform(random, -kPi, kPi)),
                          Eigen::Matrix3d::Zero()});
  trajectory.push_back({-1'500'000'001, Pose2(), Eigen::Matrix3d::Zero()});
  const test::ScratchFolder folder;
  ASSERT_THAT(write_tum(trajectory, folder / "t.tum"), test::IsOk());
  const auto read = read_tum(folder / "t.tum");
  ASSERT_THAT(read, test::IsOk());
  ASSERT_EQ(read->size(), trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ((*read)[i].stamp, trajectory[i].stamp);
    EXPECT_THAT((*read)[i].T_map_robot, test::IsNear(trajectory[i].T_map_robot, 1e-6, 1e-8));
  }
}

TEST(TrajectoryTum, IsTheLineOtherToolsExpect) {
  EXPECT_EQ(to_tum({{1'500'000'000, Pose2(1, -2, 0), Eigen::Matrix3d::Zero()}}),
            "1.500000000 1.000000 -2.000000 0 0 0 0.000000000 1.000000000\n");
}

TEST(TrajectoryTum, APlaceFarOutsideOfThisWorldDoesNotWriteBeyondTheLine) {
  const std::string text = to_tum({{0, Pose2(1e308, -1e308, 1), Eigen::Matrix3d::Zero()}});
  EXPECT_THAT(text, testing::EndsWith("0 0 0 0.479425539 0.877582562\n"));
  const auto read = from_tum(text);
  ASSERT_THAT(read, test::IsOk());
  EXPECT_EQ((*read)[0].T_map_robot.x(), 1e308);
}

TEST(TrajectoryTum, SkipsCommentsAndNamesTheFirstBadLine) {
  const auto good = from_tum("# t x y z qx qy qz qw\n\n1e3 1 2 0 0 0 0 1\r\n");
  ASSERT_THAT(good, test::IsOk());
  EXPECT_EQ((*good)[0].stamp, 1'000'000'000'000);
  for (const char* bad : {"# c\n1 2 3\n", "# c\n1 2 3 0 0 0 0 0\n", "# c\n1 2 3 0 0 0 nan 1\n",
                          "# c\n1 2 3 0 0 0 0 1 9\n", "# c\n1e300 2 3 0 0 0 0 1\n"}) {
    const auto read = from_tum(bad);
    ASSERT_THAT(read, test::Fails(Errc::kCorrupt)) << bad;
    EXPECT_THAT(read.error().message, testing::StartsWith("line 2 "));
  }
  EXPECT_THAT(read_tum("/nowhere/t.tum"), test::Fails(Errc::kIo));
}

}  // namespace
}  // namespace smokemap
