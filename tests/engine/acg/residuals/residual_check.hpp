#pragma once

#include <ceres/cost_function.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace smokemap::test {

using Blocks = std::vector<std::vector<double>>;

inline std::vector<double> residuals_of(const ceres::CostFunction& cost, const Blocks& blocks) {
  std::vector<const double*> pointers;
  for (const auto& b : blocks) pointers.push_back(b.data());
  std::vector<double> out(static_cast<std::size_t>(cost.num_residuals()));
  EXPECT_TRUE(cost.Evaluate(pointers.data(), out.data(), nullptr));
  return out;
}

/// Every entry of every block's Jacobian against the central difference.
inline void expect_jacobian_is_numeric(const ceres::CostFunction& cost, Blocks blocks, double tolerance = 1e-5) {
  const auto rows = static_cast<std::size_t>(cost.num_residuals());
  std::vector<std::vector<double>> jacobians;
  std::vector<double*> jacobian_pointers;
  std::vector<const double*> pointers;
  for (const auto& b : blocks) {
    jacobians.emplace_back(rows * b.size());
    pointers.push_back(b.data());
  }
  for (auto& j : jacobians) jacobian_pointers.push_back(j.data());
  std::vector<double> residuals(rows);
  ASSERT_TRUE(cost.Evaluate(pointers.data(), residuals.data(), jacobian_pointers.data()));
  constexpr double kStep = 1e-6;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::size_t k = 0; k < blocks[b].size(); ++k) {
      const double before = blocks[b][k];
      blocks[b][k] = before + kStep;
      const auto high = residuals_of(cost, blocks);
      blocks[b][k] = before - kStep;
      const auto low = residuals_of(cost, blocks);
      blocks[b][k] = before;
      for (std::size_t r = 0; r < rows; ++r) {
        const double numeric = (high[r] - low[r]) / (2 * kStep), ours = jacobians[b][r * blocks[b].size() + k];
        EXPECT_NEAR(ours, numeric, tolerance * (1 + std::abs(numeric)))
            << "block " << b << " value " << k << " residual " << r;
      }
    }
}

}  // namespace smokemap::test
