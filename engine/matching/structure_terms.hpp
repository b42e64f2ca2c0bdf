#pragma once

#include <Eigen/Core>
#include <vector>

#include "matching/structure_match.hpp"

namespace smokemap {

/// The terms of the energy of structure_match.hpp, tabulated for quick differences.
class StructureTerms {
 public:
  explicit StructureTerms(const StructureProblem& problem);

  int rows() const { return static_cast<int>(candidates_.size()); }
  int cols() const { return static_cast<int>(problem_.likeness.cols()); }
  double likeness(int i, int j) const { return problem_.likeness(i, j); }
  double importance(int i) const { return problem_.a->importance(i); }
  /// Regions of b that i may go to, sorted by label; just one if a person bound it.
  const std::vector<int>& candidates(int i) const { return candidates_[static_cast<size_t>(i)]; }
  bool is_forced(int i) const { return forced_[static_cast<size_t>(i)]; }
  /// Is j (or none, -1) among what i may go to?
  bool possible(int i, int j) const;
  /// May i go to j beside those that already go there? They must touch i.
  bool allowed(int i, int j, const std::vector<int>& partner) const;

  /// Does a whole assignment keep to what people said, to the candidates and to who touches whom?
  bool permits(const std::vector<int>& partner) const;

  /// What i going to j adds to the energy, the others as given; 0 for none.
  double gain_of(int i, int j, const std::vector<int>& partner) const { return gain_of_without(i, j, partner, i); }
  /// The same without the terms between i and `left_out`.
  double gain_of_without(int i, int j, const std::vector<int>& partner, int left_out) const;
  /// Gain per importance with soft partners.
  double soft_gain(int i, int j, const Eigen::MatrixXd& soft) const;
  double energy(const std::vector<int>& partner) const;
  double support(int i, const std::vector<int>& partner) const;
  /// Weight of P(i, k) and P(k, i) together.
  double pair_weight(int i, int k) const { return weight_(i, k) * importance(i) + weight_(k, i) * importance(k); }

 private:
  /// P: -1..1, symmetric in (i, j) against (k, l).
  double agreement(int i, int k, int j, int l) const;
  void tabulate_agreements();
  /// P of i going to j and k, which is around it, going to each of its candidates.
  const double* agreements(int i, int k, int j) const;

  const StructureProblem& problem_;
  std::vector<std::vector<int>> candidates_, around_;  ///< around: regions with weight, sorted
  std::vector<bool> forced_;
  Eigen::MatrixXd weight_;                   ///< structure_weight * w_ik
  Eigen::MatrixXd ax_, ay_, bx_, by_;        ///< unit vectors from region to region, a's turned into b
  Eigen::MatrixXd log_walk_a_, log_walk_b_;  ///< of the way on foot
  Eigen::MatrixXi place_;                    ///< of j among the candidates of i, or -1
  Eigen::MatrixXi block_;                    ///< of (i, k): where its part of the table begins, or -1
  std::vector<double> agreements_;           ///< blocks of candidates of i times candidates of k
};

}  // namespace smokemap
