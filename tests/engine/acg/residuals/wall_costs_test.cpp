#include "acg/residuals/piece_to_wall_cost.hpp"
#include "acg/residuals/wall_end_cost.hpp"
#include "acg/residuals/wall_shape_cost.hpp"
#include "core/random.hpp"
#include "tests/engine/acg/residuals/residual_check.hpp"

namespace smokemap {
namespace {

using test::residuals_of;
using CostOwner = std::unique_ptr<ceres::CostFunction>;

std::vector<double> place(const Point2& p) { return {p.x(), p.y()}; }
std::vector<double> standing(const Pose2& p) { return {p.x(), p.y(), p.heading()}; }
Point2 any_place(std::mt19937_64& random) { return {uniform(random, -10, 10), uniform(random, -10, 10)}; }
Pose2 any_pose(std::mt19937_64& random) { return {any_place(random), uniform(random, -kPi, kPi)}; }

TEST(WallShapeCost, IsZeroForATurnedScaledAndShiftedPlan) {
  auto random = random_stream(2, 1);
  for (int i = 0; i < 100; ++i) {
    const Point2 a = any_place(random), b = any_place(random), shift = any_place(random);
    const double turn = uniform(random, -3, 3), log_scale = uniform(random, -0.3, 0.3);
    const Pose2 rotation(0, 0, turn);
    const CostOwner cost(WallShapeCost::Create((b - a).norm(), std::atan2((b - a).y(), (b - a).x()), 0.1, 0.05));
    const auto r = residuals_of(*cost, {place(shift + std::exp(log_scale) * (rotation * a)),
                                        place(shift + std::exp(log_scale) * (rotation * b)),
                                        {turn},
                                        {log_scale}});
    EXPECT_NEAR(r[0], 0, 1e-9);
    EXPECT_NEAR(r[1], 0, 1e-9);
  }
}

TEST(WallShapeCost, IsInStandardDeviationsAlongAndAcross) {
  const CostOwner cost(WallShapeCost::Create(4, 0, 0.4, 0.1));
  const auto r = residuals_of(*cost, {{0, 0}, {4.8, 0.3}, {0}, {0}});
  EXPECT_NEAR(r[0], 2, 1e-9);
  EXPECT_NEAR(r[1], 3, 1e-9);
}

TEST(WallShapeCost, HasTheNumericJacobian) {
  auto random = random_stream(2, 2);
  for (int i = 0; i < 50; ++i) {
    const CostOwner cost(WallShapeCost::Create(uniform(random, 0.2, 8), uniform(random, -3, 3), 0.3, 0.1));
    test::expect_jacobian_is_numeric(
        *cost, {place(any_place(random)), place(any_place(random)), {uniform(random, -3, 3)}, {0.1}});
  }
}

TEST(PieceToWallCost, IsZeroOnTheFaceThatTheRobotSees) {
  auto random = random_stream(2, 3);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = any_pose(random), wall = any_pose(random);
    const double half = uniform(random, 0.03, 0.2), side = i % 2 == 0 ? 1 : -1;
    const Segment2 face{wall * Point2(0.5, side * half), wall * Point2(2.5, side * half)};
    const CostOwner cost(PieceToWallCost::Create({pose.inverse() * face.a, pose.inverse() * face.b}, side, half, 0.03));
    for (const double r : residuals_of(*cost, {standing(pose), place(wall * Point2(0, 0)), place(wall * Point2(4, 0))}))
      EXPECT_NEAR(r, 0, 1e-9);
  }
}

TEST(PieceToWallCost, IsInStandardDeviationsAcrossTheWallOnly) {
  const CostOwner cost(PieceToWallCost::Create({{1, 0.1}, {2, 0.16}}, 1, 0.1, 0.03));
  auto r = residuals_of(*cost, {{0, 0, 0}, {0, 0}, {5, 0}});
  EXPECT_NEAR(r[0], 0, 1e-6);
  EXPECT_NEAR(r[1], 2, 1e-6);
  r = residuals_of(*cost, {{1.5, 0, 0}, {0, 0}, {5, 0}});
  EXPECT_NEAR(r[0], 0, 1e-6);
  EXPECT_NEAR(r[1], 2, 1e-6);
}

TEST(PieceToWallCost, IgnoresACommonRigidMotion) {
  auto random = random_stream(2, 4);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = any_pose(random), move = any_pose(random);
    const Point2 a = any_place(random), b = any_place(random);
    const CostOwner cost(PieceToWallCost::Create({any_place(random), any_place(random)}, 1, 0.1, 0.03));
    const auto before = residuals_of(*cost, {standing(pose), place(a), place(b)});
    const auto after = residuals_of(*cost, {standing(move * pose), place(move * a), place(move * b)});
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(before[k], after[k], 1e-6);
  }
}

TEST(PieceToWallCost, HasTheNumericJacobianForPoseAndBothCorners) {
  auto random = random_stream(2, 5);
  for (int i = 0; i < 50; ++i) {
    const CostOwner cost(PieceToWallCost::Create({any_place(random), any_place(random)}, -1, 0.1, 0.5));
    test::expect_jacobian_is_numeric(
        *cost, {standing(any_pose(random)), place(any_place(random)), place(any_place(random))}, 1e-4);
  }
}

TEST(WallEndCost, IsZeroWhereTheEndWasSeenAndCountsAlongTheWallOnly) {
  const CostOwner cost(WallEndCost::Create({3, 0.05}, 0.05));
  EXPECT_NEAR(residuals_of(*cost, {{0, 0, 0}, {3, 0}, {0, 0}})[0], 0, 1e-6);
  EXPECT_NEAR(residuals_of(*cost, {{0, 0, 0}, {3.1, 0}, {0, 0}})[0], 2, 1e-6);
  EXPECT_NEAR(residuals_of(*cost, {{0, 0.4, 0}, {3, 0}, {0, 0}})[0], 0, 1e-6);
}

TEST(WallEndCost, IgnoresACommonRigidMotionAndHasTheNumericJacobian) {
  auto random = random_stream(2, 6);
  for (int i = 0; i < 50; ++i) {
    const Pose2 pose = any_pose(random), move = any_pose(random);
    const Point2 a = any_place(random), b = any_place(random);
    const CostOwner cost(WallEndCost::Create(any_place(random), 0.2));
    EXPECT_NEAR(residuals_of(*cost, {standing(pose), place(a), place(b)})[0],
                residuals_of(*cost, {standing(move * pose), place(move * a), place(move * b)})[0], 1e-6);
    test::expect_jacobian_is_numeric(*cost, {standing(pose), place(a), place(b)}, 1e-4);
  }
}

}  // namespace
}  // namespace smokemap
