#include "matching/structure_match.hpp"

#include <algorithm>
#include <cmath>

#include "matching/assignment.hpp"
#include "matching/structure_terms.hpp"

namespace smokemap {
namespace {

constexpr int kRounds = 24;
constexpr double kFirstSharpness = 4, kLastSharpness = 25;  ///< inverse temperature of the soft assignment
constexpr int kSinkhornRounds = 4;
constexpr int kMaxSweeps = 20;
constexpr int kExactRegions = 9;
constexpr int kExactNodes = 60000;

/// Soft assignment: likeness and the structure that the others' soft partners speak for.
Eigen::MatrixXd soft_assignment(const StructureTerms& terms) {
  const int n = terms.rows(), m = terms.cols();
  Eigen::MatrixXd soft = Eigen::MatrixXd::Zero(n, m);
  for (int i = 0; i < n; ++i)
    for (const int j : terms.candidates(i)) soft(i, j) = std::max(0.0, terms.likeness(i, j));
  for (int round = 0; round < kRounds; ++round) {
    const double sharpness = kFirstSharpness * std::pow(kLastSharpness / kFirstSharpness, round / (kRounds - 1.0));
    Eigen::MatrixXd next = Eigen::MatrixXd::Zero(n, m);
    for (int i = 0; i < n; ++i)
      for (const int j : terms.candidates(i))
        next(i, j) = std::exp(std::min(50.0, sharpness * terms.soft_gain(i, j, soft)));
    for (int k = 0; k < kSinkhornRounds; ++k) {  // the slack of weight 1 on both sides takes what has no partner
      for (int i = 0; i < n; ++i)
        next.row(i) /= (k == 0 ? 1.0 : 1e-9) + std::max(next.row(i).sum(), k == 0 ? 0.0 : 1.0);
      for (int j = 0; j < m; ++j) next.col(j) /= std::max(1.0, next.col(j).sum());
    }
    soft = next;
  }
  return soft;
}

class LocalSearch {
 public:
  LocalSearch(const StructureTerms& terms, std::vector<int> partner) : terms_(terms), partner_(std::move(partner)) {}

  std::vector<int> run() {
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep)
      if (!moves() && !swaps()) break;
    return partner_;
  }

 private:
  bool moves() {
    bool moved = false;
    for (int i = 0; i < terms_.rows(); ++i) {
      const int before = at(i);
      double best = terms_.gain_of(i, before, partner_);
      int found = before;
      std::vector<int> options = terms_.candidates(i);
      if (!terms_.is_forced(i)) options.push_back(-1);
      for (const int j : options) {
        if (j == before || !terms_.allowed(i, j, partner_)) continue;
        const double gain = terms_.gain_of(i, j, partner_);
        if (gain > best + 1e-12) best = gain, found = j;
      }
      if (found != before) at(i) = found, moved = true;
    }
    return moved;
  }

  bool swaps() {
    bool swapped = false;
    for (int i = 0; i < terms_.rows(); ++i)
      for (int k = i + 1; k < terms_.rows(); ++k) {
        const int of_i = at(i), of_k = at(k);
        if (of_i == of_k || !terms_.possible(i, of_k) || !terms_.possible(k, of_i)) continue;
        const double before = terms_.gain_of(i, of_i, partner_) + terms_.gain_of_without(k, of_k, partner_, i);
        at(i) = -1, at(k) = -1;
        if (terms_.allowed(i, of_k, partner_)) {
          at(i) = of_k;
          if (terms_.allowed(k, of_i, partner_)) {
            at(k) = of_i;
            const double after = terms_.gain_of(i, of_k, partner_) + terms_.gain_of_without(k, of_i, partner_, i);
            if (after > before + 1e-12) {
              swapped = true;
              continue;
            }
          }
        }
        at(i) = of_i, at(k) = of_k;
      }
    return swapped;
  }

  int& at(int i) { return partner_[static_cast<size_t>(i)]; }

  const StructureTerms& terms_;
  std::vector<int> partner_;
};

/// Depth-first over all regions of a, most important first; stops when it has looked at too much.
class BranchAndBound {
 public:
  BranchAndBound(const StructureTerms& terms, std::vector<int> incumbent)
      : terms_(terms), best_(std::move(incumbent)), best_energy_(terms.energy(best_)) {
    for (int i = 0; i < terms.rows(); ++i) order_.push_back(i);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](int one, int two) { return terms.importance(one) > terms.importance(two); });
  }

  bool run() {
    std::vector<int> partner(best_.size(), -1);
    descend(0, 0, partner);
    return nodes_ <= kExactNodes;
  }
  const std::vector<int>& best() const { return best_; }

 private:
  void descend(size_t depth, double energy, std::vector<int>& partner) {
    if (++nodes_ > kExactNodes) return;
    if (depth == order_.size()) {
      if (energy > best_energy_ + 1e-12) best_energy_ = energy, best_ = partner;
      return;
    }
    if (energy + bound(depth, partner) <= best_energy_ + 1e-12) return;
    const int i = order_[depth];
    std::vector<std::pair<double, int>> options;
    for (const int j : terms_.candidates(i))
      if (terms_.allowed(i, j, partner)) options.emplace_back(terms_.gain_of(i, j, partner), j);
    if (!terms_.is_forced(i)) options.emplace_back(0.0, -1);
    std::stable_sort(options.begin(), options.end(),
                     [](const auto& one, const auto& two) { return one.first > two.first; });
    for (const auto& [gain, j] : options) {
      partner[static_cast<size_t>(i)] = j;
      descend(depth + 1, energy + gain, partner);
      partner[static_cast<size_t>(i)] = -1;
    }
  }

  /// Each region still open: its best partner given those decided, and full agreement with all other open ones.
  double bound(size_t depth, const std::vector<int>& partner) const {
    double sum = 0;
    for (size_t d = depth; d < order_.size(); ++d) {
      const int i = order_[d];
      double best = terms_.is_forced(i) ? -1e9 : 0.0;
      double open = 0;
      for (size_t e = depth; e < order_.size(); ++e)
        if (e != d) open += 0.5 * terms_.pair_weight(i, order_[e]);
      for (const int j : terms_.candidates(i)) best = std::max(best, terms_.gain_of(i, j, partner) + open);
      sum += best;
    }
    return sum;
  }

  const StructureTerms& terms_;
  std::vector<int> order_, best_;
  double best_energy_;
  int nodes_ = 0;
};

}  // namespace

StructureMatch match_structure(const StructureProblem& problem) {
  const StructureTerms terms(problem);
  StructureMatch result;
  result.certainty = soft_assignment(terms);
  Eigen::MatrixXd gain = result.certainty.array() - 0.02;
  for (int i = 0; i < terms.rows(); ++i)
    for (int j = 0; j < terms.cols(); ++j)
      if (!terms.possible(i, j)) gain(i, j) = -1;
  for (int i = 0; i < terms.rows(); ++i)
    if (terms.is_forced(i))
      for (const int j : terms.candidates(i)) gain(i, j) = 100;
  std::vector<int> start = best_assignment(gain);
  for (int i = 0; i < terms.rows(); ++i)  // two regions bound to one: both are, though an assignment takes one only
    if (terms.is_forced(i) && start[static_cast<size_t>(i)] < 0)
      start[static_cast<size_t>(i)] = terms.candidates(i).front();
  result.partner = LocalSearch(terms, start).run();
  if (terms.rows() <= kExactRegions) {
    BranchAndBound search(terms, result.partner);
    result.exact = search.run();
    result.partner = search.best();
  }
  result.energy = terms.energy(result.partner);
  result.support = Eigen::VectorXd::Zero(terms.rows());
  for (int i = 0; i < terms.rows(); ++i) result.support(i) = terms.support(i, result.partner);
  return result;
}

double structure_energy(const StructureProblem& problem, const std::vector<int>& partner) {
  const StructureTerms terms(problem);
  return terms.permits(partner) ? terms.energy(partner) : -1e9;
}

}  // namespace smokemap
