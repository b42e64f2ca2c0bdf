#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace smokemap {

/// A graph drawn in the plane: for every vertex its neighbours in the order in which they lie around it.
struct PlanarGraph {
  std::vector<std::vector<int>> around;

  int size() const { return static_cast<int>(around.size()); }
  int edges() const;  ///< each counted once
};

struct PlanarMatch {
  std::vector<std::pair<int, int>> pairs;  ///< vertex of a, vertex of b; one to one; sorted
  int edit_distance = 0;                   ///< vertices without partner, their edges, and the difference of the rest
};

/// Neighbours of two vertices put side by side: the cheapest edit script between the two strings, as index pairs of
/// the letters that stand against each other ('same' and 'substituted').
/// @param alike  alike(x, y): are letter x of the first and letter y of the second string the same
/// @return cost (insertions, deletions and substitutions, one each) and pairs
std::pair<int, std::vector<std::pair<int, int>>> edit_script(const Eigen::MatrixXi& alike);

/// Error-tolerant matching of planar graphs: from every pair of like vertices the neighbourhoods are compared as cyclic
/// strings and pairs spread along; the hypothesis with the smallest graph edit distance wins.
///
/// @param alike  1 where a vertex of a and one of b have the same label
/// Cost: O(like pairs * edges * degree^3). Deterministic.
/// Source: Neuhaus and Bunke 2004 as used in Mielle et al., SSRR 2016, sect. IV; differs: the rotation with the least
/// distance is taken as is (the published program rounds distances down to whole numbers, so that the first below one
/// wins).
PlanarMatch match_planar(const PlanarGraph& a, const PlanarGraph& b, const Eigen::MatrixXi& alike);

}  // namespace smokemap
