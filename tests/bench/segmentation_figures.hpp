#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "core/result.hpp"

namespace smokemap::bench {

/// The measure that goals are stated in: regions and true rooms paired one to one such that the sum of their Matthews
/// correlations is largest; what stays alone on either side counts 0; pixels without a region are misses.
/// @param labels, truth  CV_16UC1, same size, 0 = none; only pixels with a true room count
double strict_score(const cv::Mat& labels, const cv::Mat& truth);

/// Truth drawn as lines over white free space -> CV_16UC1: what is left white after a 3x3 erosion, part by part, grown
/// back.
cv::Mat rooms_of_drawing(const cv::Mat& gray);

/// Random office plans with known rooms, clean, with chairs, with a pixel of noise on the walls, and turned: rooms
/// found are those of which one region covers the room by more than half of their union. Ours beside MAORIS.
void print_generated_segmentation();

/// FOLDER/<set>/<map>/{map.png, map_furnitures.png, gt*.png}: strict score and CPU time, one line a set and method.
Result<Ok> print_judged_segmentation(const std::string& folder, bool every_map);

}  // namespace smokemap::bench
