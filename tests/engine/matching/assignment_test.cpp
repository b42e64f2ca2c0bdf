#include "matching/assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "core/random.hpp"

namespace smokemap {
namespace {

double gain_of(const Eigen::MatrixXd& gain, const std::vector<int>& columns) {
  double sum = 0;
  for (size_t row = 0; row < columns.size(); ++row)
    if (columns[row] >= 0) sum += gain(static_cast<Eigen::Index>(row), columns[row]);
  return sum;
}

/// Every assignment there is, each row to a free column or to none.
double best_by_trying_all(const Eigen::MatrixXd& gain, Eigen::Index row, std::set<Eigen::Index>& taken) {
  if (row == gain.rows()) return 0;
  double best = best_by_trying_all(gain, row + 1, taken);
  for (Eigen::Index column = 0; column < gain.cols(); ++column) {
    if (gain(row, column) <= 0 || !taken.insert(column).second) continue;
    best = std::max(best, gain(row, column) + best_by_trying_all(gain, row + 1, taken));
    taken.erase(column);
  }
  return best;
}

TEST(BestAssignment, IsAsGoodAsTryingAllOfThem) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const auto rows = 1 + static_cast<Eigen::Index>(uniform_index(random, 6)),
               cols = 1 + static_cast<Eigen::Index>(uniform_index(random, 6));
    Eigen::MatrixXd gain(rows, cols);
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < cols; ++j) gain(i, j) = uniform(random, -0.5, 1);
    std::set<Eigen::Index> taken;
    EXPECT_NEAR(gain_of(gain, best_assignment(gain)), best_by_trying_all(gain, 0, taken), 1e-9);
  }
}

TEST(BestAssignment, NeverGivesAColumnTwiceNorTakesALoss) {
  std::mt19937_64 random(2);
  Eigen::MatrixXd gain(40, 55);
  for (Eigen::Index i = 0; i < gain.rows(); ++i)
    for (Eigen::Index j = 0; j < gain.cols(); ++j) gain(i, j) = uniform(random, -1, 1);
  std::set<int> seen;
  const std::vector<int> columns = best_assignment(gain);
  for (size_t row = 0; row < columns.size(); ++row) {
    if (columns[row] < 0) continue;
    EXPECT_TRUE(seen.insert(columns[row]).second);
    EXPECT_GT(gain(static_cast<Eigen::Index>(row), columns[row]), 0);
  }
}

TEST(BestAssignment, LeavesRowsWithoutGainAlone) {
  EXPECT_EQ(best_assignment(Eigen::MatrixXd::Constant(3, 2, -1)), (std::vector<int>{-1, -1, -1}));
}

}  // namespace
}  // namespace smokemap
