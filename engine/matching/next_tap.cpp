#include "matching/next_tap.hpp"

#include <algorithm>
#include <map>

namespace smokemap {
namespace {

/// Share of a that is right if every region gets the partner that most of the answers say, times their weight.
double right_share(const std::vector<const WeighedAnswer*>& answers, const Eigen::VectorXd& importance) {
  double sum = 0;
  for (Eigen::Index i = 0; i < importance.size(); ++i) {
    std::map<int, double> votes;
    double most = 0;
    for (const WeighedAnswer* answer : answers)
      most = std::max(most, votes[answer->partner[static_cast<size_t>(i)]] += answer->weight);
    sum += importance(i) * most;
  }
  return sum;
}

}  // namespace

Eigen::VectorXd expected_gains(const std::vector<WeighedAnswer>& answers, const Eigen::VectorXd& importance,
                               const Eigen::VectorXd& confidence) {
  double total = 0;
  std::vector<const WeighedAnswer*> all;
  for (const WeighedAnswer& answer : answers) total += answer.weight, all.push_back(&answer);
  Eigen::VectorXd gains = Eigen::VectorXd::Zero(importance.size());
  if (total <= 0) return gains;
  const double now = right_share(all, importance);
  for (Eigen::Index i = 0; i < importance.size(); ++i) {
    std::map<int, std::vector<const WeighedAnswer*>> told;
    for (const WeighedAnswer* answer : all) told[answer->partner[static_cast<size_t>(i)]].push_back(answer);
    double then = 0;
    for (const auto& [partner, left] : told) then += right_share(left, importance);
    gains(i) = (then - now) / total + importance(i) * (1 - confidence(i));
  }
  return gains;
}

std::optional<int> next_tap(const std::vector<WeighedAnswer>& answers, const Eigen::VectorXd& importance,
                            const Eigen::VectorXd& confidence, const std::vector<bool>& bound) {
  const Eigen::VectorXd gains = expected_gains(answers, importance, confidence);
  std::optional<int> found;
  double most = 1e-9;
  for (Eigen::Index i = 0; i < gains.size(); ++i)
    if (!bound[static_cast<size_t>(i)] && gains(i) > most) most = gains(i), found = static_cast<int>(i);
  return found;
}

}  // namespace smokemap
