#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

enum class SegmentationMethod {
  kConstriction,  ///< our own (default): rooms are peaks of the distance image, doors are its narrow saddles
  kMaoris,        ///< as published: Mielle, Magnusson, Lilienthal, "MAORIS", ICRA 2018
};

/// Ratios and counts only: nothing is tied to a resolution, because sketches have none.
struct SegmentationParams {
  SegmentationMethod method = SegmentationMethod::kConstriction;

  // kConstriction
  double door_ratio = 0.70;       ///< where the thickness falls below this share of a room's, the room ends
  double niche_depth = 0.30;      ///< what is shallower than this many widths of its opening belongs to its neighbour
  double door_contact = 0.50;     ///< a piece between others that touches them with this share of its outline is a door
  double min_room_ratio = 0.02;   ///< smallest room, in squares of the typical clearance
  double min_clearance_px = 1.5;  ///< free space narrower than this has no room of its own
  double clutter_ratio = 1.0;     ///< islands smaller than this many typical clearances are furniture

  // kMaoris (thresholds of the paper; door_merge is 40..50 for robot maps, 60 for sketches)
  double maoris_door_drop = 0.30;    ///< t: relative drop of the thickness at a door
  double maoris_margin = 0.10;       ///< m: extra drop allowed where another neighbour agrees
  double maoris_ripple_percent = 40; ///< R: contact with one neighbour that makes a zone a ripple of it
  double maoris_door_percent = 40;   ///< D: contact with all neighbours that makes a zone a door

  Result<Ok> validate() const;
};

/// The parameters for a kind of map. The same for every kind, except the door contact that MAORIS publishes for sketches.
SegmentationParams segmentation_params(MapKind kind, SegmentationMethod method = SegmentationMethod::kConstriction);

/// Splits free space into regions (rooms, corridors).
///
/// Every free pixel gets exactly one region, isolated rooms stay, and each region is connected (8 neighbours). The result
/// does not depend on the largest open space of the map, and a turn of the picture by 90 degrees turns the result.
///
/// @param free_space  CV_8UC1, 255 = free, anything else = not free; untouched
/// @return regions in descending area (ties: topmost, then leftmost pixel). kDegenerate if there is no free cell,
///         kInvalidArgument for another pixel type or parameters out of range, kTooLarge over 64 megapixels or
///         over 65535 regions.
/// Cost: O(pixels log pixels); a megapixel takes about a tenth of a second and 60 MB. Deterministic.
Result<Segmentation> segment(const cv::Mat& free_space, const SegmentationParams& params = {});

/// Rebuilds regions and borders from a label image alone (CV_16UC1, any labels; they are renumbered in descending area).
/// For label images made elsewhere: by hand, by another program, read back from disk.
Result<Segmentation> segmentation_from_labels(const cv::Mat& labels);

/// 255 where a gray or colour picture of a map is brighter than `threshold` (as everywhere in the field), else 0.
/// kInvalidArgument for an empty picture or a depth other than 8 or 16 bit.
Result<cv::Mat> free_space_of_picture(const cv::Mat& picture, int threshold = 250);

}  // namespace smokemap
