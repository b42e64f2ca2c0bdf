#include "server/http/exports.hpp"

#include <cstdio>

#include "grids/occupancy_grid.hpp"

namespace smokemap::server {
namespace {

/// As map_server draws it: 254 free, 0 occupied, 205 unknown; row 0 is the highest y.
std::string pgm_of(const OccupancyGrid& grid) {
  const GridFrame& frame = grid.frame();
  const auto image = to_image(grid);
  std::string pgm = "P5\n" + std::to_string(frame.width_cells) + " " + std::to_string(frame.height_cells) + "\n255\n";
  pgm.append(image.ptr<char>(), frame.cell_count());  // whole rows without gaps
  return pgm;
}

std::string yaml_of(const OccupancyGrid& grid) {
  char text[256];
  std::snprintf(text, sizeof text,
                "image: map.pgm\nresolution: %.6f\norigin: [%.6f, %.6f, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
                "free_thresh: 0.196\n",
                grid.frame().resolution_m, grid.frame().origin.x(), grid.frame().origin.y());
  return text;
}

std::string geojson_of(const Snapshot& snapshot) {
  Json features = Json::array();
  for (const MergedWall& wall : snapshot.merged->walls)
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "LineString"}, {"coordinates", {point_json(wall.segment_map.a), point_json(wall.segment_map.b)}}}},
         {"properties",
          {{"state", to_string(wall.state)},
           {"confidence", rounded(wall.confidence, 0.001)},
           {"moved_m", rounded_m(wall.displacement_m)},
           {"layout_wall", wall.layout_wall ? Json(*wall.layout_wall) : Json(nullptr)}}}});
  return to_text({{"type", "FeatureCollection"},
                  {"note", "coordinates are metres in the merged map, not longitude and latitude"},
                  {"features", std::move(features)}});
}

}  // namespace

Json merged_document(const Snapshot& snapshot) {
  const MergedMap& merged = *snapshot.merged;
  Json walls = Json::array(), corners = Json::array(), points = Json::array();
  for (const MergedWall& wall : merged.walls)
    walls.push_back({{"layout_wall", wall.layout_wall ? Json(*wall.layout_wall) : Json(nullptr)},
                     {"a", point_json(wall.segment_map.a)},
                     {"b", point_json(wall.segment_map.b)},
                     {"state", to_string(wall.state)},
                     {"confidence", rounded(wall.confidence, 0.001)}});
  for (const MergedCorner& corner : merged.corners)
    corners.push_back({{"layout_px", point_json(corner.p_layout_px)},
                       {"map", point_json(corner.p_map)},
                       {"sigma_m", rounded_m(corner.sigma_m)},
                       {"seen", corner.seen}});
  for (const PoiView& view : snapshot.pois)
    if (view.poi.place.frame == PlaceFrame::kLayoutPx && !view.poi.removed)
      points.push_back({{"layout_px", point_json(view.poi.place.p)},
                        {"map", view.in_map.p ? point_json(*view.in_map.p) : Json(nullptr)},
                        {"sigma_m", rounded_m(view.in_map.sigma)},
                        {"kind", to_string(view.poi.kind)},
                        {"label", view.poi.label}});
  return {{"walls", std::move(walls)},
          {"corners", std::move(corners)},
          {"points", std::move(points)},
          {"fit", {{"score", rounded(merged.fit.score, 0.001)}, {"verdict", merged.fit.verdict}}}};
}

Response export_file(const std::string& name, const Snapshot& snapshot) {
  const bool has_grid = snapshot.sensed && !snapshot.sensed->empty();
  if ((name == "map.pgm" || name == "map.yaml") && !has_grid)
    return error_response(404, "not_found", "nothing has been seen yet");
  if (name == "map.pgm") return bytes_response(pgm_of(*snapshot.sensed), "image/x-portable-graymap");
  if (name == "map.yaml") return bytes_response(yaml_of(*snapshot.sensed), "text/yaml; charset=utf-8");
  if (name == "walls.geojson") return bytes_response(geojson_of(snapshot), "application/geo+json");
  if (name == "merged.json") return bytes_response(to_text(merged_document(snapshot)), "application/json");
  return error_response(404, "not_found", "there is no such export");
}

}  // namespace smokemap::server
