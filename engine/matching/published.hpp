#pragma once

#include <Eigen/Core>
#include <vector>

#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// The two published matchers, for comparison. They give pairs without confidence (0.5 each), know no taps and no n:m.

struct UrsimParams {
  double threshold = 0.125;  ///< descriptors nearer than this are of the same region; the best fixed one on KTH
  double unique_from = 1;    ///< standard deviations from the mean of size or elongation
};

/// What URSIM knows about the regions of one map: attributes, descriptor.
struct UrsimRegions {
  Eigen::VectorXd size, elongation;     ///< size standardised; elongation 1 - (short / long axis)^2, raw
  Eigen::VectorXd standard_elongation;  ///< standardised
  std::vector<int> unique;              ///< regions, by label - 1
};
UrsimRegions ursim_regions(const Segmentation& map, const UrsimParams& params = {});

/// Heat that has come from the anchors to each region: rows regions, columns times 0, 0.2, ..., 3.
Eigen::MatrixXd anchor_heat(const Segmentation& map, const std::vector<int>& anchors);

/// URSIM: unique regions are paired as anchors, heat spreads from them over the weighted region graphs, regions of like
/// heat are labels for the planar matcher.
/// Source: Mielle et al., "URSIM: unique regions for sketch map interpretation and matching", Robotics 8(2):43, 2019;
/// differs: regions weigh by their relative size as the paper says (the program computes it and does not use it);
/// regions are those given, not MAORIS's.
std::vector<RegionPair> match_ursim(const Segmentation& a, const Segmentation& b, const UrsimParams& params = {});

/// Junctions and dead ends of the trimmed Voronoi graphs are matched; regions that hold matched vertices are pairs.
/// Source: Mielle et al., "Using sketch-maps for robot navigation: interpretation and matching", SSRR 2016; differs:
/// the graphs are those of topology/voronoi_graph.hpp, and a region goes to the one that most of its vertices go to.
std::vector<RegionPair> match_voronoi(const Segmentation& a, const Segmentation& b);

}  // namespace smokemap
