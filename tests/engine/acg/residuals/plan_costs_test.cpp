#include "acg/residuals/drawn_line_cost.hpp"
#include "acg/residuals/neighbour_stretch_cost.hpp"
#include "acg/residuals/prior_value_cost.hpp"
#include "acg/residuals/strip_stretch_cost.hpp"
#include "core/random.hpp"
#include "geometry/pose2.hpp"
#include "tests/engine/acg/residuals/residual_check.hpp"

namespace smokemap {
namespace {

using test::residuals_of;
using OwnedCost = std::unique_ptr<ceres::CostFunction>;

TEST(DrawnLineCost, IsZeroOnTheLineAndInStandardDeviationsOff) {
  auto random = random_stream(3, 1);
  for (int i = 0; i < 100; ++i) {
    const double axis = uniform(random, -3, 3), turn = uniform(random, -3, 3), at = uniform(random, -20, 20);
    const Pose2 along(0, 0, axis + turn);
    const Point2 on = along * Point2(at, uniform(random, -9, 9)),
                 off = along * Point2(at + 0.1, uniform(random, -9, 9));
    const OwnedCost cost(DrawnLineCost::Create(axis, 0, 0.05));
    EXPECT_NEAR(residuals_of(*cost, {{on.x(), on.y()}, {turn}, {at}, {0.3}})[0], 0, 1e-9);
    EXPECT_NEAR(residuals_of(*cost, {{off.x(), off.y()}, {turn}, {at}, {0.3}})[0], 2, 1e-9);
    test::expect_jacobian_is_numeric(*cost, {{off.x(), off.y()}, {turn}, {at}, {0.3}});
  }
}

TEST(DrawnLineCost, ExpectsACornerAsFarOffAsItIsDrawnAtThePlansScale) {
  const OwnedCost cost(DrawnLineCost::Create(0, 0.08, 0.05));
  EXPECT_NEAR(residuals_of(*cost, {{5.12, 3}, {0}, {5}, {std::log(1.5)}})[0], 0, 1e-9);
  EXPECT_NEAR(residuals_of(*cost, {{5, 3}, {0}, {5}, {std::log(1.5)}})[0], -2.4, 1e-9);
  test::expect_jacobian_is_numeric(*cost, {{5.1, 3}, {0.2}, {5}, {0.1}});
}

TEST(StripStretchCost, IsZeroAtThePlansScaleAndInShares) {
  const OwnedCost cost(StripStretchCost::Create(2, 0.1));
  EXPECT_NEAR(residuals_of(*cost, {{5}, {5 + 2 * std::exp(0.2)}, {0.2}})[0], 0, 1e-9);
  EXPECT_NEAR(residuals_of(*cost, {{5}, {7.4}, {0}})[0], 2, 1e-9);
  test::expect_jacobian_is_numeric(*cost, {{5}, {7.4}, {0.1}});
}

TEST(StripStretchCost, IgnoresACommonShift) {
  const OwnedCost cost(StripStretchCost::Create(2, 0.1));
  EXPECT_NEAR(residuals_of(*cost, {{1}, {3.3}, {0.1}})[0], residuals_of(*cost, {{11}, {13.3}, {0.1}})[0], 1e-9);
}

TEST(NeighbourStretchCost, IsZeroWhenTheStretchFadesAsItShould) {
  const double correlation = 0.6;
  const OwnedCost cost(NeighbourStretchCost::Create(2, 3, correlation, 0.05));
  // First strip 10 % too wide, second one 6 %.
  EXPECT_NEAR(residuals_of(*cost, {{0}, {2.2}, {2.2 + 3 * 1.06}, {0}})[0], 0, 1e-9);
  EXPECT_NEAR(residuals_of(*cost, {{0}, {2.2}, {2.2 + 3 * 1.16}, {0}})[0], 2, 1e-9);
  test::expect_jacobian_is_numeric(*cost, {{0}, {2.1}, {5.4}, {0.05}});
}

TEST(PriorValueCost, IsTheDistanceInStandardDeviations) {
  const OwnedCost cost(PriorValueCost::Create(1, 0.5));
  EXPECT_NEAR(residuals_of(*cost, {{2}})[0], 2, 1e-12);
  test::expect_jacobian_is_numeric(*cost, {{2}});
}

}  // namespace
}  // namespace smokemap
