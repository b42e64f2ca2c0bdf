#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// Ratios and counts only: nothing is tied to a resolution, because sketches have none.
struct ConstrictionParams {
  double pinch_ratio = 0.78;      ///< a passage narrower than this share of the rooms on both its sides is a door
  double step_ratio = 0.70;       ///< where the thickness falls below this share of a room's, the room ends
  double niche_depth = 0.30;      ///< what is shallower than this many widths of its opening belongs to its neighbour
  double door_depth = 1.0;        ///< the same for a passage between two wider places: what is longer is a corridor
  double open_ratio = 0.85;       ///< an opening at least this share as wide as the room is no boundary
  double min_room_ratio = 0.50;   ///< smallest room, in squares of the usual clearance
  double min_clearance_px = 1.5;  ///< free space narrower than this has no room of its own
  double crumb_ratio = 0;         ///< a region smaller than this share of the mean one joins the nearest
  double clutter_ratio = 1.0;     ///< islands smaller than this many typical clearances are furniture

  Result<Ok> validate() const;
};

/// The parameters for maps that are to be matched, the same for both: small rooms stay, because people draw them and
/// matching tells them apart by what lies around them. Crumbs do not: robots see dents in walls and gaps behind doors
/// that no two maps share, and each would count as a neighbour of its room like the corridor does.
ConstrictionParams matching_segmentation_params();

/// Splits free space where it grows narrow. The regions that matching was made on and measured with.
///
/// Why matching does not use the default method (segment.hpp), which tells more rooms right (robot maps 0.93 against
/// 0.82): points are carried region by region, so a region that spans two rooms puts half of them into the wrong one,
/// however well regions are matched. With the true pairs given, room hit is at most 0.77 on KTH and 0.82 / 0.90 on E5
/// with these regions, at most 0.73 and 0.50 / 0.71 with the default ones, which join the rough corridors of robot maps
/// with what lies beside them (10 regions for 22). And KTH's open plan has no doors to cut at: the default method parts
/// its clean map finer (12) than the sketches of it (9), this one both alike (9 and 8), so that fewer regions have a
/// partner (room hit found 0.74 against 0.63).
///
/// The same promises, errors and cost as segment(); borders and regions do not say how sure they are.
/// Source: local thickness and its steps are those of MAORIS (Mielle, Magnusson, Lilienthal, ICRA 2018); differs:
/// thickness is not scaled by the largest open space, rooms are peeled from basins instead of merged by chains of
/// contacts, what is a niche is told by depth over width, borders are the shortest straight cuts, and isolated regions
/// are kept.
Result<Segmentation> segment_by_constrictions(const cv::Mat& free_space, const ConstrictionParams& params = {});

}  // namespace smokemap
