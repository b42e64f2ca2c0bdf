#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acg/auto_complete_graph.hpp"
#include "core/result.hpp"
#include "maps/layout_map.hpp"
#include "maps/merged_map.hpp"

namespace smokemap::app {

/// `anchors.json`: {"start": {"layout_px": [x,y], "heading_rad": h, "sigma_m": s, "sigma_rad": r}} and / or
/// {"pairs": [{"layout_px": [x,y], "map": [x,y]}, …]}.
struct Anchors {
  std::optional<PlanStart> start;
  struct Pair {
    Point2 p_layout_px = Point2::Zero();
    Point2 p_map = Point2::Zero();
  };
  std::vector<Pair> pairs;
};

/// kCorrupt names the field. `layout` gives the scale of the start.
Result<Anchors> anchors_from_json(const std::string& text, const LayoutMap& layout);
/// {"points": [[x,y], …]} in layout_px.
Result<std::vector<Point2>> points_from_json(const std::string& text);
/// `merged.json`: walls, corners, points, fit (docs of `smokemap merge`); a point outside the plan has "map": null.
std::string merged_to_json(const MergedMap& merged, const LayoutMap& layout, const std::vector<Point2>& points_px);

}  // namespace smokemap::app
