#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "maps/correspondence.hpp"
#include "matching/raster.hpp"

namespace smokemap {

/// One way of laying map a over map b as a whole.
struct MapAlignment {
  Eigen::Affine2d T_b_a_px = Eigen::Affine2d::Identity();  ///< pixel of a -> pixel of b
  double score = 0;  ///< likeness of the two depth images under it, 0..1, less what the pins cost
};

/// Candidate alignments, best first, different from each other: the walls of both maps are made parallel, then the four
/// quarter turns (eight with mirror images), a range of scales along both wall directions and all shifts are compared.
/// Cost: one Fourier transform a candidate, 15..30 ms altogether.
std::vector<MapAlignment> find_alignments(const MapRaster& a, const MapRaster& b, const std::vector<Pin>& pins,
                                          bool allow_mirror, int count);

}  // namespace smokemap
