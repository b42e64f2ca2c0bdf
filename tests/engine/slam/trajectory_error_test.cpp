#include "slam/trajectory_error.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;

StampedPose at(double seconds, const Pose2& pose) { return {from_seconds(seconds), pose, Eigen::Matrix3d::Zero()}; }

/// A winding way, one pose every half second.
Trajectory winding(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Trajectory poses;
  Pose2 pose;
  for (int i = 0; i < count; ++i) {
    poses.push_back(at(0.5 * i, pose));
    pose = pose * Pose2(0.3, 0, normal(random, 0.2));
  }
  return poses;
}

std::vector<PoseRelation> relations_of(const Trajectory& poses, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<PoseRelation> relations;
  for (int k = 0; k < 200; ++k) {
    const StampedPose &a = poses[uniform_index(random, poses.size())], &b = poses[uniform_index(random, poses.size())];
    relations.push_back({a.stamp, b.stamp, a.T_map_robot.inverse() * b.T_map_robot});
  }
  return relations;
}

Trajectory moved(const Pose2& T, Trajectory poses) {
  for (StampedPose& pose : poses) pose.T_map_robot = T * pose.T_map_robot;
  return poses;
}

TEST(RelationError, IsZeroForTheTruthHoweverItLies) {
  const Trajectory truth = winding(300, 1);
  const auto error = relation_error(moved({5, -3, 1.1}, truth), relations_of(truth, 2));
  ASSERT_TRUE(error);
  EXPECT_LT(error->translation_m.most, 1e-9);
  EXPECT_LT(error->rotation_rad.most, 1e-9);
  EXPECT_EQ(error->relations, 200u);
}

TEST(RelationError, IsWhatWasPlanted) {
  const Trajectory truth = winding(300, 3);
  auto relations = relations_of(truth, 4);
  for (PoseRelation& r : relations)
    r.T_from_to = {r.T_from_to.translation() + Point2(0.03, 0.04), r.T_from_to.heading() + 0.02};
  const auto error = relation_error(truth, relations);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->translation_m.mean, 0.05, 1e-9);
  EXPECT_NEAR(error->translation_m.stddev, 0, 1e-9);
  EXPECT_NEAR(error->rotation_rad.median, 0.02, 1e-9);
}

TEST(RelationError, FillsStampsBetweenScansByOdometry) {
  const Trajectory truth = winding(300, 5);
  Trajectory sparse;
  std::vector<Odometry> odometry;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    odometry.push_back({truth[i].stamp, "robot", Pose2(9, 9, 2) * truth[i].T_map_robot, 0, 0});
    if (i % 5 == 0) sparse.push_back(truth[i]);
  }
  const auto with = relation_error(sparse, relations_of(truth, 6), odometry),
             without = relation_error(sparse, relations_of(truth, 6));
  ASSERT_TRUE(with && without);
  EXPECT_LT(with->translation_m.most, 0.02);
  EXPECT_EQ(with->missing, 0u);
  EXPECT_GT(without->missing, 50u);
}

/// Bursts: after a pause, five readings of a moving robot within 4 ms. The relations' own stamps are as they should be.
TEST(RelationError, ToldApartIsWhatStampsOfABurstCannotSay) {
  const Trajectory truth = winding(300, 9);
  std::vector<Odometry> odometry;
  Trajectory stamped = truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i % 20 >= 15)
      stamped[i].stamp = truth[i / 20 * 20 + 19].stamp + from_seconds(0.001 * static_cast<double>(i % 5));
    odometry.push_back({stamped[i].stamp, "robot", truth[i].T_map_robot, 0, 0});
  }
  std::vector<PoseRelation> relations;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const bool burst = i % 20 == 17;  // the people's stamp names another reading of the burst, 0.6 m away
    relations.push_back({stamped[i - 1].stamp, stamped[burst ? i + 2 : i].stamp,
                         truth[i - 1].T_map_robot.inverse() * truth[i].T_map_robot});
  }
  const auto error = relation_error(stamped, relations, odometry);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->relations, relations.size());
  EXPECT_GT(error->translation_m.most, 0.5);         // though the trajectory is the truth itself
  EXPECT_LT(error->clear_translation_m.most, 1e-9);  // and this shows it
  EXPECT_GT(error->clear, 180u);
  EXPECT_LT(error->clear, 240u);
  const auto unknown = relation_error(stamped, relations);
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->clear, 0u);
}

/// A logger that stalled stamps ten readings of a driving robot alike; two of them carry scans. The estimate of a scan
/// was taken for that of all ten readings, and what lies beside them was moved on from half a metre off.
TEST(RelationError, AnEstimateIsNotThatOfOtherReadingsWithItsStamp) {
  const Trajectory truth = winding(300, 10);
  std::vector<Odometry> odometry;
  Trajectory estimate;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool burst = i % 30 >= 10 && i % 30 < 20;
    const Stamp stamp = burst ? truth[i / 30 * 30 + 10].stamp : truth[i].stamp;
    odometry.push_back({stamp, "robot", truth[i].T_map_robot, 0, 0});
    if (i % 30 == 5 || i % 30 == 14 || i % 30 == 18 || i % 30 == 25)
      estimate.push_back({stamp, truth[i].T_map_robot, Eigen::Matrix3d::Zero()});
  }
  std::vector<PoseRelation> relations;  // between readings whose stamps mean one place
  for (std::size_t i = 5; i + 30 < truth.size(); i += 30)
    for (const std::size_t j : {i + 3, i + 4, i + 16, i + 20})
      relations.push_back({truth[i].stamp, truth[j].stamp, truth[i].T_map_robot.inverse() * truth[j].T_map_robot});
  const auto error = relation_error(estimate, relations, odometry);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->missing, 0u);
  EXPECT_LT(error->translation_m.most, 1e-9);
}

TEST(RelationError, NeedsSomethingToCompare) {
  EXPECT_THAT(relation_error({}, {}), Fails(Errc::kDegenerate));
  EXPECT_THAT(relation_error(winding(5, 7), {{from_seconds(1e6), from_seconds(2e6), {}}}), Fails(Errc::kDegenerate));
}

TEST(AbsoluteError, ForgetsARigidMotionAndKnowsTheLever) {
  const Trajectory truth = winding(200, 8);
  Trajectory lever = truth;
  for (StampedPose& pose : lever) pose.T_map_robot = pose.T_map_robot * Pose2(0.7, 0.1, 0);
  const Trajectory estimate = moved({-4, 8, 2.5}, truth);
  const auto exact = absolute_error(estimate, truth), with = absolute_error(estimate, lever, {0.7, 0.1}),
             without = absolute_error(estimate, lever);
  ASSERT_TRUE(exact && with && without);
  EXPECT_LT(exact->rmse_m, 1e-9);
  EXPECT_LT(exact->rotation_rmse_rad, 1e-9);
  EXPECT_LT(with->rmse_m, 1e-9);
  EXPECT_GT(without->rmse_m, 0.1);
  EXPECT_NEAR(exact->path_m, 0.3 * 199, 1e-6);
  EXPECT_THAT(absolute_error(estimate, {}), Fails(Errc::kDegenerate));
}

TEST(DisplacementError, ComparesLengthsOfStepsAndWrapsTurnsByAFullCircle) {
  Trajectory truth, estimate;
  for (int i = 0; i < 10; ++i) {
    truth.push_back(at(i, {1.0 * i, 0, 0}));
    estimate.push_back(at(i + 0.1, {0, 1.1 * i, i % 2 ? 3.0 : -3.0}));  // turns of 6.0 and -6.0 rad
  }
  const auto error = displacement_error(estimate, truth);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->steps, 9u);
  EXPECT_NEAR(error->length_m.mean, 0.1, 1e-9);
  EXPECT_NEAR(error->heading_rad.mean, 2 * kPi - 6, 1e-9);
}

TEST(DisplacementError, UsesEveryTruePoseOnce) {
  const Trajectory truth{at(0, {0, 0, 0}), at(1, {1, 0, 0})};
  const Trajectory estimate{at(0, {0, 0, 0}), at(0.1, {5, 0, 0}), at(1, {1, 0, 0})};
  const auto error = displacement_error(estimate, truth);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->steps, 1u);
  EXPECT_NEAR(error->length_m.mean, 0, 1e-12);
}

}  // namespace
}  // namespace smokemap
