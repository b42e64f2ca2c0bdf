// Idea: a disc, or a block with a pattern, has no direction of its own, so strokes run through it every way. Walls,
// posts and stubs around a corner are longer than thick.
#include <algorithm>

#include "layout/drawings.hpp"
#include "layout/wall_strokes.hpp"

namespace smokemap {
namespace {

constexpr double kChunky = 3;       ///< times its thickness: a shorter stroke may run through a disc
constexpr double kLargestBlot = 4;  ///< times the walls' thickness

}  // namespace

std::vector<InkStroke> without_discs(const std::vector<InkStroke>& strokes, double thickness_px, double side_px) {
  std::vector<bool> blot(strokes.size(), false);
  for (const auto& region : connected_regions(strokes, 0, side_px)) {
    if ((region.high - region.low).maxCoeff() > kLargestBlot * thickness_px) continue;
    const double heading = strokes[region.members.front()].axis.heading();
    const bool every_way = std::any_of(region.members.begin(), region.members.end(), [&](std::size_t m) {
      return line_angle_between(strokes[m].axis.heading(), heading) > radians(20);
    });
    const bool chunky = std::all_of(region.members.begin(), region.members.end(), [&](std::size_t m) {
      return strokes[m].length() < kChunky * strokes[m].thickness_px;
    });
    for (const std::size_t m : region.members) blot[m] = every_way && chunky;
  }
  std::vector<InkStroke> kept;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!blot[i]) kept.push_back(strokes[i]);
  return kept;
}

}  // namespace smokemap
