#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "maps/segmentation.hpp"
#include "tests/bench/judged_pairs.hpp"

namespace smokemap::bench {

/// How sure matching is of drawings laid over their own building, over others, over the mirror image of their own, and
/// what taps change: the right ones, and those of somebody who confirms whatever is shown on the wrong map. Below it
/// what came true of all that was said, own and other buildings counting alike.
///
/// @param pairs   of one set only their first annotator; sets of one building begin alike up to '_'; pairs of the sets
///                "generated" and "stubs" are all of different buildings
/// @param others  further maps of other buildings
void print_foreign_figures(const std::vector<JudgedPair>& pairs, const std::vector<Segmentation>& others);

/// DIR/robot_maps/*/map.png, read for matching, every second one.
Result<std::vector<Segmentation>> read_robot_maps(const std::string& folder, const Segmenter& segmenter);

}  // namespace smokemap::bench
