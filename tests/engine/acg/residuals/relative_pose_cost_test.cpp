#include "acg/residuals/relative_pose_cost.hpp"

#include "core/random.hpp"
#include "tests/engine/acg/residuals/residual_check.hpp"

namespace smokemap {
namespace {

using test::residuals_of;
using CostPtr = std::unique_ptr<ceres::CostFunction>;

std::vector<double> pose_block(const Pose2& p) { return {p.x(), p.y(), p.heading()}; }
Pose2 random_pose(std::mt19937_64& random) {
  return {uniform(random, -10, 10), uniform(random, -10, 10), uniform(random, -kPi, kPi)};
}

TEST(AcgRelativePoseCost, IsZeroAtTheTruth) {
  auto random = random_stream(1, 1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random);
    const CostPtr cost(RelativePoseCost::Create(a.inverse() * b, Eigen::Matrix3d::Identity() * 20));
    for (const double r : residuals_of(*cost, {pose_block(a), pose_block(b)})) EXPECT_NEAR(r, 0, 1e-9);
  }
}

TEST(AcgRelativePoseCost, IsInStandardDeviations) {
  const CostPtr cost(
      RelativePoseCost::Create(Pose2(1, 0, 0), Eigen::Vector3d(1 / 0.1, 1 / 0.2, 1 / 0.05).asDiagonal()));
  const auto r = residuals_of(*cost, {{0, 0, 0}, {1.2, 0.2, 0.15}});
  EXPECT_NEAR(r[0], 2, 1e-9);
  EXPECT_NEAR(r[1], 1, 1e-9);
  EXPECT_NEAR(r[2], 3, 1e-9);
}

TEST(AcgRelativePoseCost, IgnoresACommonRigidMotion) {
  auto random = random_stream(1, 2);
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = random_pose(random), b = random_pose(random), move = random_pose(random);
    const CostPtr cost(RelativePoseCost::Create(random_pose(random), Eigen::Matrix3d::Identity()));
    const auto before = residuals_of(*cost, {pose_block(a), pose_block(b)});
    const auto after = residuals_of(*cost, {pose_block(move * a), pose_block(move * b)});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(before[k], after[k], 1e-9);
  }
}

TEST(AcgRelativePoseCost, HasTheNumericJacobian) {
  auto random = random_stream(1, 3);
  for (int i = 0; i < 50; ++i) {
    const Pose2 a = random_pose(random), b = a * Pose2(0.5, 0.1, 0.2);
    const CostPtr cost(RelativePoseCost::Create(Pose2(0.4, 0, 0.1), Eigen::Matrix3d::Identity() * 10));
    test::expect_jacobian_is_numeric(*cost, {pose_block(a), pose_block(b)});
  }
}

}  // namespace
}  // namespace smokemap
