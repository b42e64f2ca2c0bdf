#pragma once

#include <Eigen/Core>
#include <vector>

namespace smokemap {

/// One-to-one assignment of rows to columns with the largest sum of gains; gains of zero or less are not taken.
/// @return for each row its column, or -1. Cost O(n^3). Ties go to smaller indices.
/// Source: Kuhn 1955 in the shortest-augmenting-path form of Jonker and Volgenant 1987.
std::vector<int> best_assignment(const Eigen::MatrixXd& gain);

}  // namespace smokemap
