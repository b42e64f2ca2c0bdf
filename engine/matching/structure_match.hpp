#pragma once

#include <Eigen/Core>
#include <vector>

#include "matching/region_graph.hpp"

namespace smokemap {

/// Assignment of the regions of a to those of b, by how alike they are and how well the structure around them agrees:
/// a quadratic assignment with regions left out and several regions on one allowed.
///
///   E(f) = sum_i m_i (U(i, f(i)) - threshold) + structure_weight * sum_{i != k} m_i w_ik P(i, k, f(i), f(k))
///
/// over matched i, k. m: importance; w: share of k in the surroundings of i (falls with hops, sums to 1); P in [-1, 1]:
/// do k and f(k) lie in the same direction and as far on foot from i and f(i).
struct StructureProblem {
  const RegionGraph* a = nullptr;
  const RegionGraph* b = nullptr;
  Eigen::Matrix2d turn_b_a = Eigen::Matrix2d::Identity();  ///< how directions on a are turned (or mirrored) into b
  double scale_b_a = 1;                                    ///< pixels of b for one of a
  Eigen::MatrixXd likeness;                                ///< U, 0..1
  Eigen::MatrixXi forced, forbidden;                       ///< 1 where a person has spoken
  double threshold = 0.25;  ///< likeness from which a region rather has a partner than none
  double structure_weight = 1.0;
  bool many_to_one = true;
};

struct StructureMatch {
  std::vector<int> partner;   ///< of each region of a; -1 = none
  Eigen::MatrixXd certainty;  ///< share of each pair among its alternatives when all are weighed together, 0..1
  Eigen::VectorXd support;    ///< of each region of a: weighted mean of P over its surroundings, -1..1; 0 if none
  double energy = 0;
  bool exact = false;  ///< proved best among one-to-one and many-to-one assignments over the candidates
};

/// Soft assignment (entropic partial fused Gromov-Wasserstein, solved by graduated assignment with slack), then made
/// discrete, then improved by moves and swaps; small graphs are finished by branch and bound.
/// Cost: O(regions * neighbours * candidates^2) a round. Deterministic.
/// Source: Gold and Rangarajan 1996 (softassign); Vayer et al. 2019 and Chapel et al. 2020 (fused, partial GW).
StructureMatch match_structure(const StructureProblem& problem);

/// E of an assignment, whatever made it; -1e9 if it breaks what people said or maps two regions that do not touch on
/// one (or any two, if many_to_one is off).
double structure_energy(const StructureProblem& problem, const std::vector<int>& partner);

}  // namespace smokemap
