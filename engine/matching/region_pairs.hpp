#pragma once

#include <Eigen/Core>
#include <vector>

#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"
#include "matching/raster.hpp"
#include "matching/warp.hpp"

namespace smokemap {

/// What people have said about pairs, as matrices over (region of a, region of b); regions by label - 1.
struct PairRules {
  Eigen::MatrixXi forced;     ///< 1: confirmed by a verdict or bound by a pin
  Eigen::MatrixXi forbidden;  ///< 1: rejected
};

/// How alike two regions are once a has been laid over b: where they lie, how large they are, who their neighbours are.
struct PairScores {
  Eigen::MatrixXd likeness;    ///< 0..1
  Eigen::MatrixXd share_of_a;  ///< share of the region of a that lands in the region of b
  Eigen::MatrixXd share_of_b;  ///< share of the region of b that the region of a covers
};

PairScores score_pairs(const Segmentation& a, const Segmentation& b, const MapRaster& raster_a,
                       const MapRaster& raster_b, const Warp& warp, const PairRules& rules);

/// The best one-to-one pairs, then, if asked for, the left-over regions that lie almost wholly in a matched one.
/// Confidence is that of the pair under this warp alone.
std::vector<RegionPair> choose_pairs(const PairScores& scores, const PairRules& rules, bool many_to_many);

}  // namespace smokemap
