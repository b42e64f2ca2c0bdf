#include "acg/residuals/anchor_cost.hpp"
#include "acg/residuals/corner_cost.hpp"
#include "acg/residuals/pin_cost.hpp"
#include "acg/residuals/start_cost.hpp"
#include "acg/residuals/wall_length_cost.hpp"
#include "core/random.hpp"
#include "tests/engine/acg/residuals/residual_check.hpp"

namespace smokemap {
namespace {

using test::residuals_of;
using OwnedCost = std::unique_ptr<ceres::CostFunction>;

Point2 some_place(std::mt19937_64& random) { return {uniform(random, -10, 10), uniform(random, -10, 10)}; }
std::vector<double> block_of(const Point2& p) { return {p.x(), p.y()}; }
std::vector<double> block_of(const Pose2& p) { return {p.x(), p.y(), p.heading()}; }

TEST(PinCost, IsZeroAtThePinAndInStandardDeviationsBesideIt) {
  const OwnedCost cost(PinCost::Create({3, -2}, 0.02));
  EXPECT_EQ(residuals_of(*cost, {{3, -2}}), (std::vector<double>{0, 0}));
  const auto r = residuals_of(*cost, {{3.04, -2.06}});
  EXPECT_NEAR(r[0], 2, 1e-9);
  EXPECT_NEAR(r[1], -3, 1e-9);
  test::expect_jacobian_is_numeric(*cost, {{1, 2}});
}

TEST(AnchorCost, OnlyLeansWithinAFingersBreadthAndWinsBeyondIt) {
  auto random = random_stream(4, 5);
  const AnchorCost::Finger finger{0.05, 0.05, 0.001};
  for (int i = 0; i < 100; ++i) {
    const Point2 a = some_place(random), b = some_place(random), c = some_place(random);
    const Eigen::Vector3d shares(0.2, 0.5, 0.3);
    const Point2 here = 0.2 * a + 0.5 * b + 0.3 * c;
    const double where = uniform(random, -kPi, kPi);
    const Point2 way(std::cos(where), std::sin(where));
    const auto at = [&](double off) {
      const OwnedCost cost(AnchorCost::Create(shares, here + off * way, finger));
      test::expect_jacobian_is_numeric(*cost, {block_of(a), block_of(b), block_of(c)}, 1e-3);
      return residuals_of(*cost, {block_of(a), block_of(b), block_of(c)});
    };
    for (const double r : at(0)) EXPECT_NEAR(r, 0, 1e-6);
    const auto inside = at(0.04), outside = at(0.25);
    EXPECT_NEAR(std::hypot(inside[0], inside[1]), 0.8, 1e-6);
    EXPECT_EQ(inside[2], 0);
    EXPECT_NEAR(outside[2], 200, 1e-3);
  }
}

TEST(StartCost, IsZeroWhereTheStartLiesBetweenItsLinesAsDrawnAndInStandardDeviationsBesideIt) {
  auto random = random_stream(4, 6);
  for (int i = 0; i < 100; ++i) {
    const double axis = uniform(random, -3, 3), turn = uniform(random, -3, 3), share = uniform(random, -0.5, 1.5);
    const double line = uniform(random, -9, 9), next = line + uniform(random, 0.5, 6);
    const Pose2 along(0, 0, axis + turn);
    const auto at = [&](double off) {
      const Point2 p = along * Point2(line + share * (next - line) + off, uniform(random, -9, 9));
      const OwnedCost cost(StartCost::Create(axis, share, p, 0.3));
      test::expect_jacobian_is_numeric(*cost, {{turn}, {line}, {next}});
      return residuals_of(*cost, {{turn}, {line}, {next}})[0];
    };
    EXPECT_NEAR(at(0), 0, 1e-9);
    EXPECT_NEAR(at(-0.6), 2, 1e-9);
  }
}

TEST(WallLengthCost, IgnoresWhereTheWallLiesAndHowItIsTurned) {
  auto random = random_stream(4, 1);
  for (int i = 0; i < 100; ++i) {
    const double length = uniform(random, 0.5, 9);
    const Pose2 wall(some_place(random), uniform(random, -kPi, kPi));
    const OwnedCost cost(WallLengthCost::Create(length, 0.02));
    const auto at = [&](double s) { return block_of(wall * Point2(s, 0)); };
    EXPECT_NEAR(residuals_of(*cost, {at(0), at(length)})[0], 0, 1e-6);
    EXPECT_NEAR(residuals_of(*cost, {at(0), at(length + 0.04)})[0], 2, 1e-6);
    EXPECT_NEAR(residuals_of(*cost, {at(length - 0.04), at(0)})[0], -2, 1e-6);
  }
}

TEST(WallLengthCost, HasTheNumericJacobian) {
  auto random = random_stream(4, 2);
  for (int i = 0; i < 50; ++i) {
    const OwnedCost cost(WallLengthCost::Create(uniform(random, 0.5, 9), 0.02));
    test::expect_jacobian_is_numeric(*cost, {block_of(some_place(random)), block_of(some_place(random))}, 1e-4);
  }
}

TEST(CornerCost, IsZeroWhereTheFacesWereSeenToMeetWhateverTheRobotsPose) {
  auto random = random_stream(4, 3);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose(some_place(random), uniform(random, -kPi, kPi));
    const Point2 corner = some_place(random), offset(-0.1, 0.06);
    const OwnedCost cost(CornerCost::Create(pose.inverse() * Point2(corner - offset), offset, 0.08));
    for (const double r : residuals_of(*cost, {block_of(pose), block_of(corner)})) EXPECT_NEAR(r, 0, 1e-9);
    const auto moved = residuals_of(*cost, {block_of(pose), block_of(Point2(corner + Point2(0.16, 0)))});
    EXPECT_NEAR(moved[0], -2, 1e-9);
    test::expect_jacobian_is_numeric(*cost, {block_of(pose), block_of(corner)});
  }
}

}  // namespace
}  // namespace smokemap
