#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace smokemap {

/// One possible answer: the partner of every region of a (by label - 1, -1 = none), and how likely it is beside the
/// others.
struct WeighedAnswer {
  std::vector<int> partner;
  double weight = 0;
};

/// What a tap on each region of a is expected to bring, as a share of map a (by importance) that is then right.
///
/// A tap tells the region's partner, which rules out the answers that say otherwise: what is right then is what most of
/// the rest say. Where all answers agree, it still makes the region itself sure.
/// @param confidence  of the best pair of each region, 0..1
/// Cost: O(regions^2 * answers^2).
Eigen::VectorXd expected_gains(const std::vector<WeighedAnswer>& answers, const Eigen::VectorXd& importance,
                               const Eigen::VectorXd& confidence);

/// The region (by label - 1) whose tap brings most, not one of those already bound; none if no tap brings anything.
std::optional<int> next_tap(const std::vector<WeighedAnswer>& answers, const Eigen::VectorXd& importance,
                            const Eigen::VectorXd& confidence, const std::vector<bool>& bound);

}  // namespace smokemap
