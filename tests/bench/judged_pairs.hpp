#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "geometry/pose2.hpp"
#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"

namespace smokemap::bench {

/// How free space is split into regions: the default of matching, unless a benchmark compares several.
using Segmenter = std::function<Result<Segmentation>(const cv::Mat&)>;

/// What one person (or the generator) says is one place on both maps.
struct JudgedGroup {
  std::vector<Point2> clicks_a, clicks_b;
  std::vector<int> labels_a, labels_b;  ///< in the label images of the truth
};

/// Two maps and one person's truth about them.
struct JudgedPair {
  std::string set, name, annotator;
  Segmentation a, b;         ///< our own reading of both maps
  cv::Mat truth_a, truth_b;  ///< CV_16UC1: the true rooms
  cv::Mat truth_b_a;         ///< CV_32FC2: where every pixel of a lies on b; empty if nobody knows exactly
  std::vector<JudgedGroup> groups;
  double segment_ms = 0;  ///< CPU time of both segmentations
};

/// DIR/<set>/gt/*.json with label images, as in the folder's README.
Result<std::vector<JudgedPair>> read_judged_pairs(const std::string& folder, const std::string& set,
                                                  const Segmenter& segmenter);

/// How the maps of generated pairs look.
enum class Wear {
  kNone,  ///< empty rooms, clean walls
  kStubs  ///< stubs of walls and pillars in both maps, each its own, that split rooms when they are read
};

/// Sketches made from random buildings the way people draw, with exact truth, one for each seed from `first_seed` on;
/// the set is called "generated", or "stubs".
std::vector<JudgedPair> generated_pairs(int count, std::uint64_t first_seed, const Segmenter& segmenter,
                                        Wear wear = Wear::kNone);

/// The best that can be said of our regions: those that mostly lie in rooms of one group are pairs, all sure.
Matching true_matching(const JudgedPair& pair);

/// All pixels whose label is one of `members`.
std::vector<Point2> pixels_of(const cv::Mat& labels, const std::vector<int>& members);

/// Rotation (no mirror image) that best lays `from` over `to`, point by point.
Eigen::Matrix2d best_rotation(const std::vector<Point2>& from, const std::vector<Point2>& to);

}  // namespace smokemap::bench
