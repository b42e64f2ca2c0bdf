#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// How freely boundaries without a door are drawn.
struct BoundaryStyle {
  double mouth_ratio = 0;     ///< a passage narrower than this share of the wider place it opens into is a boundary
  double mouth_support = 0;   ///< added to it for each end at which a wall runs on in the direction of the boundary
  double passage_depth = 0;   ///< a piece between boundaries shorter than this many widths of them is none of its own
  double min_room_ratio = 0;  ///< smallest room, in squares of the usual thickness
};

/// One set for all kinds of maps. Ratios only: nothing is tied to a resolution, because sketches have none.
struct SegmentationParams {
  double door_ratio = 0.6;    ///< an opening narrower than this share of the space on both its sides is a door
  double door_support = 0.1;  ///< added to it for each end at which a wall runs on in the direction of the opening
  double niche_depth = 0.3;   ///< what is shallower than this many widths of its opening belongs to its neighbour
  BoundaryStyle with_doors{0.3, 0, 1, 0.5};             ///< where a map shows doors, what has none is one room
  BoundaryStyle without_doors{0.87, 0.15, 0.38, 0.02};  ///< where it shows none, bends and widenings part rooms
  double clutter_ratio = 0.7;       ///< islands smaller than this many usual thicknesses are furniture
  double tolerance_ratio = 0.05;    ///< wobble of walls, in usual thicknesses
  double least_tolerance_px = 1.5;  ///< but at least this
  double longest_cut_ratio = 12;    ///< longest boundary, in usual thicknesses

  Result<Ok> validate() const;
};

/// Splits free space into regions (rooms, corridors).
///
/// Every free pixel gets exactly one region and isolated rooms stay. A region is connected (4 neighbours), but for
/// crumbs of free space too small for a room and cut off from all, which take the label of the nearest region. The
/// result does not depend on the largest open space of the map; a turn by 90 degrees turns it, but for ties. Every
/// border and region says how sure it is.
///
/// @param free_space  CV_8UC1, 255 = free, anything else = not free; untouched
/// @return regions in descending area (ties: topmost, then leftmost pixel). kDegenerate if there is no free cell,
///         kInvalidArgument for another pixel type or parameters out of range, kTooLarge over 64 megapixels or
///         over 65535 regions.
/// Cost: a megapixel takes two tenths of a second and about 60 MB. Deterministic.
/// Source: own. That rooms end where walls run on (ROSE2: Luperto et al. 2022) and the local thickness of MAORIS
/// (Mielle, Magnusson, Lilienthal, ICRA 2018; see maoris.hpp for it as published) gave the idea; differs from both:
/// boundaries are straight cuts between corners of walls, judged by how much wider the space behind them is.
Result<Segmentation> segment(const cv::Mat& free_space, const SegmentationParams& params = {});

/// Rebuilds regions and borders from a label image alone (CV_16UC1, any labels; they are renumbered in descending
/// area). For label images made elsewhere: by hand, by another program, read back from disk.
Result<Segmentation> segmentation_from_labels(const cv::Mat& labels);

/// 255 where a gray or colour picture of a map is brighter than `threshold` (as everywhere in the field), else 0.
/// kInvalidArgument for an empty picture or a depth other than 8 or 16 bit.
Result<cv::Mat> free_space_of_picture(const cv::Mat& picture, int threshold = 250);

}  // namespace smokemap
