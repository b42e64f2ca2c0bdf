#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// As published, in percent and relative to the largest open space of the map.
struct MaorisParams {
  double threshold = 0.30;     ///< zones whose values differ by less than this share are one room
  double margin = 0.10;        ///< up to this much more, if a third zone lies between them in value
  double ripple_share = 0.40;  ///< a zone with this share of its outline against another is a ripple of it
  double door_share = 0.40;    ///< a zone with more than this share of its outline against others is a door
  int least_zone_px = 10;      ///< before merging; smaller ones are noise
  int least_room_px = 100;     ///< after merging

  Result<Ok> validate() const;
};

/// The values with which the published results were made: they differ in `door_share`, 0.60 for sketches.
MaorisParams maoris_params(MapKind kind);

/// MAORIS, for comparison. The default method is `segment`, which see for arguments and errors.
///
/// Cost: a megapixel takes about a second.
/// Source: Mielle, Magnusson, Lilienthal: A method to segment maps from different modalities using free space layout,
/// ICRA 2018. Follows the authors' program where it leaves the paper: discs are painted a pixel off their centres,
/// fused zones' neighbours wait at the end of the queue, of equal zones the last comes first. Differs from it:
/// neighbours are visited in a stated order where theirs follows memory addresses, and rooms that touch no other, the
/// rim that discs miss, and crumbs are kept.
Result<Segmentation> segment_maoris(const cv::Mat& free_space, const MaorisParams& params = {});

}  // namespace smokemap
