#include "matching/structure_terms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace smokemap {
namespace {

constexpr int kMaxCandidates = 14;
constexpr double kWeightPerHop = 0.45;  ///< a region one hop farther speaks this much less
constexpr int kMaxHops = 3;
constexpr double kRightAngleHalf = 0.7;  ///< cosine from which directions agree rather than not
constexpr double kWalkSpread = 0.9;      ///< logarithm of the ratio of ways at which neither agrees nor disagrees
constexpr double kShortestWalk =
    0.15;  ///< of the side of the smaller map, added to both ways: short ones are drawn as it comes
constexpr double kDirectionShare = 0.6;
constexpr double kSamePlace = 0.1;  ///< agreement of two touching regions that go to one

void directions(const std::vector<Point2>& middles, const Eigen::Matrix2d& turn, Eigen::MatrixXd& x,
                Eigen::MatrixXd& y) {
  const auto n = static_cast<Eigen::Index>(middles.size());
  x = y = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) {
      const Point2 way = turn * (middles[static_cast<size_t>(k)] - middles[static_cast<size_t>(i)]);
      if (way.norm() > 1e-9) x(i, k) = way.x() / way.norm(), y(i, k) = way.y() / way.norm();
    }
}

}  // namespace

StructureTerms::StructureTerms(const StructureProblem& problem) : problem_(problem) {
  const RegionGraph &a = *problem.a, &b = *problem.b;
  const int n = a.size(), m = b.size();
  candidates_.resize(static_cast<size_t>(n));
  around_.resize(static_cast<size_t>(n));
  forced_.assign(static_cast<size_t>(n), false);
  weight_ = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    std::vector<int>& list = candidates_[static_cast<size_t>(i)];
    for (int j = 0; j < m; ++j)
      if (problem.forced(i, j) && list.empty()) list.push_back(j), forced_[static_cast<size_t>(i)] = true;
    if (list.empty()) {
      for (int j = 0; j < m; ++j)
        if (!problem.forbidden(i, j) && problem.likeness(i, j) > 0.01) list.push_back(j);
      std::stable_sort(list.begin(), list.end(),
                       [&](int one, int two) { return problem.likeness(i, one) > problem.likeness(i, two); });
      if (static_cast<int>(list.size()) > kMaxCandidates) list.resize(kMaxCandidates);
      std::sort(list.begin(), list.end());
    }
    for (int k = 0; k < n; ++k)
      if (k != i && a.hops(i, k) <= kMaxHops) weight_(i, k) = std::pow(kWeightPerHop, a.hops(i, k) - 1);
    if (const double sum = weight_.row(i).sum(); sum > 0) weight_.row(i) *= problem.structure_weight / sum;
  }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      if (weight_(i, k) > 0 || weight_(k, i) > 0) around_[static_cast<size_t>(i)].push_back(k);
  directions(a.middles_px, problem.turn_b_a, ax_, ay_);
  directions(b.middles_px, Eigen::Matrix2d::Identity(), bx_, by_);
  const double short_px = kShortestWalk * std::min(b.side_px, problem.scale_b_a * a.side_px);
  log_walk_a_ = (problem.scale_b_a * a.walk.array() + short_px).log();
  log_walk_b_ = (b.walk.array() + short_px).log();
  tabulate_agreements();
}

void StructureTerms::tabulate_agreements() {
  const auto n = static_cast<Eigen::Index>(rows());
  place_ = Eigen::MatrixXi::Constant(n, cols(), -1);
  block_ = Eigen::MatrixXi::Constant(n, n, -1);
  size_t size = 0;
  for (int i = 0; i < n; ++i) {
    for (size_t c = 0; c < candidates(i).size(); ++c) place_(i, candidates(i)[c]) = static_cast<int>(c);
    for (const int k : around_[static_cast<size_t>(i)]) {
      block_(i, k) = static_cast<int>(size);
      size += candidates(i).size() * candidates(k).size();
    }
  }
  agreements_.reserve(size);
  for (int i = 0; i < n; ++i)
    for (const int k : around_[static_cast<size_t>(i)])
      for (const int j : candidates(i))
        for (const int l : candidates(k)) agreements_.push_back(agreement(i, k, j, l));
}

const double* StructureTerms::agreements(int i, int k, int j) const {
  const size_t row = static_cast<size_t>(place_(i, j)) * candidates(k).size();
  return agreements_.data() + static_cast<size_t>(block_(i, k)) + row;
}

bool StructureTerms::possible(int i, int j) const {
  if (j < 0) return !is_forced(i);
  return std::binary_search(candidates(i).begin(), candidates(i).end(), j);
}

bool StructureTerms::allowed(int i, int j, const std::vector<int>& partner) const {
  if (j < 0) return true;
  for (int k = 0; k < rows(); ++k) {
    if (k == i || partner[static_cast<size_t>(k)] != j || (is_forced(i) && is_forced(k))) continue;
    if (!problem_.many_to_one || problem_.a->hops(i, k) != 1) return false;
  }
  return true;
}

bool StructureTerms::permits(const std::vector<int>& partner) const {
  std::vector<int> so_far(partner.size(), -1);
  for (int i = 0; i < rows(); ++i) {
    const int j = partner[static_cast<size_t>(i)];
    if (!possible(i, j) || !allowed(i, j, so_far)) return false;
    so_far[static_cast<size_t>(i)] = j;
  }
  return true;
}

double StructureTerms::agreement(int i, int k, int j, int l) const {
  if (j == l) return problem_.a->hops(i, k) == 1 ? kSamePlace : -1;
  const double cosine = ax_(i, k) * bx_(j, l) + ay_(i, k) * by_(j, l) - kRightAngleHalf;
  const double direction = cosine > 0 ? cosine / (1 - kRightAngleHalf) : std::max(-1.0, cosine / kRightAngleHalf);
  const double walk = std::max(-1.0, 1 - std::abs(log_walk_a_(i, k) - log_walk_b_(j, l)) / kWalkSpread);
  return kDirectionShare * direction + (1 - kDirectionShare) * walk;
}

double StructureTerms::gain_of_without(int i, int j, const std::vector<int>& partner, int left_out) const {
  if (j < 0) return 0;
  double gain = importance(i) * (likeness(i, j) - problem_.threshold);
  for (const int k : around_[static_cast<size_t>(i)]) {
    const int l = partner[static_cast<size_t>(k)];
    if (k == i || k == left_out || l < 0) continue;
    gain += pair_weight(i, k) * agreements(i, k, j)[place_(k, l)];
  }
  return gain;
}

double StructureTerms::soft_gain(int i, int j, const Eigen::MatrixXd& soft) const {
  double gain = importance(i) * (likeness(i, j) - problem_.threshold);
  for (const int k : around_[static_cast<size_t>(i)]) {
    double sum = 0;
    const double* agreement = agreements(i, k, j);
    for (const int l : candidates(k)) sum += soft(k, l) * *agreement++;
    gain += pair_weight(i, k) * sum;
  }
  return gain / importance(i);
}

double StructureTerms::energy(const std::vector<int>& partner) const {
  double sum = 0;
  std::vector<int> so_far(partner.size(), -1);
  for (int i = 0; i < rows(); ++i) {
    sum += gain_of(i, partner[static_cast<size_t>(i)], so_far);
    so_far[static_cast<size_t>(i)] = partner[static_cast<size_t>(i)];
  }
  return sum;
}

double StructureTerms::support(int i, const std::vector<int>& partner) const {
  const int j = partner[static_cast<size_t>(i)];
  if (j < 0) return 0;
  double sum = 0, total = 0;
  for (const int k : around_[static_cast<size_t>(i)]) {
    const int l = partner[static_cast<size_t>(k)];
    if (weight_(i, k) <= 0 || l < 0) continue;
    sum += weight_(i, k) * agreements(i, k, j)[place_(k, l)];
    total += weight_(i, k);
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace smokemap
