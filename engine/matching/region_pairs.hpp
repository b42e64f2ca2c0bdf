#pragma once

#include <Eigen/Core>
#include <vector>

#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"
#include "matching/raster.hpp"
#include "matching/warp.hpp"

namespace smokemap {

/// How alike two regions are once a has been laid over b: where they lie and how large they are.
struct PairScores {
  Eigen::MatrixXd likeness;    ///< 0..1
  Eigen::MatrixXd share_of_a;  ///< share of the region of a that lands in the region of b
  Eigen::MatrixXd share_of_b;  ///< share of the region of b that the region of a covers
};

PairScores score_pairs(const Segmentation& a, const Segmentation& b, const MapRaster& raster_a,
                       const MapRaster& raster_b, const Warp& warp);

/// The partners, and with them the regions of b that nobody has and that lie almost wholly under one of a.
std::vector<RegionPair> joined_pairs(const std::vector<int>& partner, const PairScores& scores,
                                     const Eigen::MatrixXi& forbidden);

}  // namespace smokemap
