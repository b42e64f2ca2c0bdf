#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// Ratios and counts only: nothing is tied to a resolution, because sketches have none.
struct SegmentationParams {
  double pinch_ratio = 0.78;      ///< a passage narrower than this share of the rooms on both its sides is a door
  double step_ratio = 0.70;       ///< where the thickness falls below this share of a room's, the room ends
  double niche_depth = 0.30;      ///< what is shallower than this many widths of its opening belongs to its neighbour
  double door_depth = 1.0;        ///< the same for a passage between two wider places: what is longer is a corridor
  double open_ratio = 0.85;       ///< an opening at least this share as wide as the room is no boundary
  double min_room_ratio = 0.50;   ///< smallest room, in squares of the usual clearance
  double min_clearance_px = 1.5;  ///< free space narrower than this has no room of its own
  double clutter_ratio = 1.0;     ///< islands smaller than this many typical clearances are furniture

  Result<Ok> validate() const;
};

/// The parameters for a kind of map. They differ for sketches, which have no furniture and name small niches.
SegmentationParams segmentation_params(MapKind kind);

/// The parameters for maps that are to be matched, the same for both: small rooms stay, because people draw them and
/// matching tells them apart by what lies around them.
SegmentationParams matching_segmentation_params();

/// Splits free space into regions (rooms, corridors).
///
/// Every free pixel gets exactly one region and isolated rooms stay. A region is connected (4 neighbours), but for
/// crumbs of free space too small for a room and cut off from all, which take the label of the nearest region. The
/// result does not depend on the largest open space of the map; a turn by 90 degrees turns it, but for ties.
///
/// @param free_space  CV_8UC1, 255 = free, anything else = not free; untouched
/// @return regions in descending area (ties: topmost, then leftmost pixel). kDegenerate if there is no free cell,
///         kInvalidArgument for another pixel type or parameters out of range, kTooLarge over 64 megapixels or
///         over 65535 regions.
/// Cost: a megapixel takes a few tenths of a second and about 60 MB. Deterministic.
/// Source: local thickness and its steps are those of MAORIS (Mielle, Magnusson, Lilienthal, ICRA 2018); differs:
/// thickness is not scaled by the largest open space, rooms are peeled from basins instead of merged by chains of
/// contacts, what is a niche is told by depth over width, borders are the shortest straight cuts, and isolated regions
/// are kept.
Result<Segmentation> segment(const cv::Mat& free_space, const SegmentationParams& params = {});

/// Rebuilds regions and borders from a label image alone (CV_16UC1, any labels; they are renumbered in descending
/// area). For label images made elsewhere: by hand, by another program, read back from disk.
Result<Segmentation> segmentation_from_labels(const cv::Mat& labels);

/// 255 where a gray or colour picture of a map is brighter than `threshold` (as everywhere in the field), else 0.
/// kInvalidArgument for an empty picture or a depth other than 8 or 16 bit.
Result<cv::Mat> free_space_of_picture(const cv::Mat& picture, int threshold = 250);

}  // namespace smokemap
