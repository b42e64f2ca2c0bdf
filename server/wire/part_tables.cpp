#include <algorithm>
#include <cmath>
#include <optional>

#include "server/wire/parts.hpp"
#include "server/wire/words.hpp"

namespace smokemap::server {
namespace {

constexpr int kMeshSteps = 12;
/// What is only drawn, and moves by millimetres with every merge, is told no finer: or all of it would be sent again
/// every second.
constexpr double kDrawn_m = 0.01;
constexpr double kLinkPlace_m = 0.05;  ///< links of a corner that lie nearer are one place

double to_ms(Stamp stamp) { return std::floor(static_cast<double>(stamp) * 1e-6); }
Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }
Json four(const Segment2& s, double step) {
  return Json::array({rounded(s.a.x(), step), rounded(s.a.y(), step), rounded(s.b.x(), step), rounded(s.b.y(), step)});
}
Json in_map(const Transferred& place) { return place.p ? point_json(*place.p) : Json(nullptr); }

/// Nodes evenly over the picture, row by row.
std::vector<Point2> mesh_nodes_px(const LayoutMap& layout) {
  std::vector<Point2> nodes;
  for (int row = 0; row <= kMeshSteps; ++row)
    for (int column = 0; column <= kMeshSteps; ++column)
      nodes.emplace_back((layout.width_px - 1.0) * column / kMeshSteps, (layout.height_px - 1.0) * row / kMeshSteps);
  return nodes;
}

/// The picture as a mesh of triangles, to draw it deformed. Where its nodes lie is told apart: that changes with every
/// merge, this never.
Json plan_mesh(const LayoutMap& layout) {
  Json triangles = Json::array();
  for (int row = 0; row < kMeshSteps; ++row)
    for (int column = 0; column < kMeshSteps; ++column) {
      const int i = row * (kMeshSteps + 1) + column, below = i + kMeshSteps + 1;
      triangles.push_back({i, i + 1, below + 1});
      triangles.push_back({i, below + 1, below});
    }
  return {{"px", points_json(mesh_nodes_px(layout), 0.01)}, {"triangles", std::move(triangles)}};
}

Json plan_nodes(const LayoutMap& layout, const Deformation& layout_to_map) {
  Json map = Json::array();
  for (const Point2& p_px : mesh_nodes_px(layout))
    map.push_back(point_json(layout_to_map(layout.frame().to_metres(p_px)), kDrawn_m));
  return {{"map", std::move(map)}};
}

Json floor_json(const Snapshot& s, const ServerView& view) {
  const LayoutMap* layout = s.layout ? &s.layout->layout : nullptr;
  const GridFrame frame = s.sensed ? s.sensed->frame() : GridFrame{};
  const double right = frame.origin.x() + frame.width_cells * frame.resolution_m;
  const double top = frame.origin.y() + frame.height_cells * frame.resolution_m;
  const bool empty = !s.sensed || s.sensed->empty();
  Json floor = {{"plan_id", s.layout ? text_or_null(s.layout->plan_id) : Json(nullptr)},
                {"picture", s.layout ? text_or_null(view.plan_picture) : Json(nullptr)},
                {"size", layout ? Json{layout->width_px, layout->height_px} : Json(nullptr)},
                {"metres_per_pixel", layout && layout->scale ? Json(layout->scale->metres_per_pixel) : Json(nullptr)},
                {"fit",
                 {{"score", s.merged ? rounded(s.merged->fit.score, 0.001) : 0},
                  {"verdict", s.merged ? s.merged->fit.verdict : "unknown"}}},
                {"revision", s.merged ? s.merged->revision : 0},
                {"grid_bounds", empty ? Json(nullptr)
                                      : Json{rounded_m(frame.origin.x()), rounded_m(frame.origin.y()), rounded_m(right),
                                             rounded_m(top)}},
                {"exploring", std::any_of(s.robots.begin(), s.robots.end(), [](const auto& r) { return r.exploring; })},
                {"stopped", std::any_of(s.robots.begin(), s.robots.end(), [](const auto& r) { return r.stopped; })}};
  return floor;
}

PartTable info_table(const Snapshot& s, const ServerView& view) {
  PartTable table;
  table["floor"] = to_text(floor_json(s, view));
  if (s.layout && s.merged) {
    table["plan_mesh"] = to_text(plan_mesh(s.layout->layout));
    table["plan_nodes"] = to_text(plan_nodes(s.layout->layout, s.merged->layout_to_map));
  }
  if (s.sketch)
    table["sketch"] =
        to_text({{"size", {s.sketch->sketch.width_px, s.sketch->sketch.height_px}}, {"warning", s.sketch->warning}});
  return table;
}

PartTable layout_wall_table(const Snapshot& s) {
  PartTable table;
  if (!s.layout) return table;
  const LayoutMap& layout = s.layout->layout;
  for (std::size_t i = 0; i < layout.walls.size(); ++i)
    table[std::to_string(i)] = to_text({{"px", four(layout.wall_px(static_cast<int>(i)), 0.01)},
                                        {"confidence", rounded(layout.walls[i].confidence, 0.01)},
                                        {"by_person", layout.walls[i].by_person}});
  return table;
}

PartTable wall_table(const Snapshot& s) {
  PartTable table;
  int fresh = 0;
  if (!s.merged) return table;
  for (const MergedWall& wall : s.merged->walls)
    table[wall.layout_wall ? "w" + std::to_string(*wall.layout_wall) : "n" + std::to_string(fresh++)] =
        to_text({{"a", point_json(wall.segment_map.a, kDrawn_m)},
                 {"b", point_json(wall.segment_map.b, kDrawn_m)},
                 {"state", to_string(wall.state)},
                 {"confidence", rounded(wall.confidence, 0.01)},
                 {"moved_m", rounded(wall.displacement_m, kDrawn_m)}});
  return table;
}

/// A robot that drives on sees the same corner from hundreds of places: told are the places where it was seen. The id
/// is what is told, so that nothing is sent again while nothing changes.
PartTable link_table(const Snapshot& s) {
  PartTable table;
  if (!s.merged) return table;
  for (const MapLink& link : s.merged->links) {
    const std::string state = word_of(kLinkWords, link.state);
    const Json p = point_json(link.p_map, kLinkPlace_m);
    table[std::to_string(link.layout_corner) + " " + state + " " + to_text(p)] =
        to_text({{"p", p}, {"corner", link.layout_corner}, {"state", state}});
  }
  return table;
}

PartTable robot_table(const Snapshot& s) {
  PartTable table;
  for (const RobotStatus& r : s.robots)
    table[r.id] = to_text({{"x", rounded_m(r.T_map_robot.x())},
                           {"y", rounded_m(r.T_map_robot.y())},
                           {"heading", rounded_rad(r.T_map_robot.heading())},
                           {"sigma_m", rounded_m(r.sigma_m)},
                           {"sigma_rad", rounded_rad(r.sigma_rad)},
                           {"localized", r.localized},
                           {"link", word_of(kLinkQualityWords, r.link)},
                           {"heard_ms", to_ms(r.last_heard)},
                           {"speed", rounded(r.speed_mps, 0.01)},
                           {"stopped", r.stopped},
                           {"exploring", r.exploring},
                           {"goal", text_or_null(r.goal_id)},
                           {"path", points_json(r.path_map, 0.01)},
                           {"note", r.note}});
  return table;
}

PartTable poi_table(const Snapshot& s) {
  PartTable table;
  for (const PoiView& view : s.pois)
    table[view.poi.id] = to_text({{"kind", to_string(view.poi.kind)},
                                  {"label", view.poi.label},
                                  {"author", view.poi.author},
                                  {"created_ms", to_ms(view.poi.created)},
                                  {"frame", word_of(kFrameWords, view.poi.place.frame)},
                                  {"p", point_json(view.poi.place.p)},
                                  {"map", in_map(view.in_map)},
                                  {"sigma_m", rounded_m(view.in_map.sigma)},
                                  {"confidence", rounded(view.in_map.confidence, 0.01)},
                                  {"reason", view.in_map.reason},
                                  {"removed", view.poi.removed}});
  return table;
}

PartTable goal_table(const Snapshot& s) {
  PartTable table;
  for (const GoalView& view : s.goals) {
    const Goal& goal = view.goal;
    table[goal.id] = to_text({{"robot", goal.robot},
                              {"author", goal.author},
                              {"created_ms", to_ms(goal.created)},
                              {"frame", word_of(kFrameWords, goal.place.frame)},
                              {"p", point_json(goal.place.p)},
                              {"heading", goal.heading_rad ? Json(rounded_rad(*goal.heading_rad)) : Json(nullptr)},
                              {"map", in_map(view.in_map)},
                              {"sigma_m", rounded_m(view.in_map.sigma)},
                              {"state", to_string(goal.state)},
                              {"reason", goal.reason.empty() ? view.in_map.reason : goal.reason},
                              {"remaining_m", rounded(view.remaining_m, 0.01)},
                              {"eta_s", rounded(view.eta_s, 0.1)}});
  }
  return table;
}

PartTable stroke_table(const Snapshot& s) {
  PartTable table;
  if (!s.sketch) return table;
  for (const Stroke& stroke : s.sketch->sketch.strokes)
    table[stroke.id] = to_text({{"kind", word_of(kStrokeWords, stroke.kind)},
                                {"author", stroke.author},
                                {"width", rounded(stroke.width_px, 0.01)},
                                {"points", points_json(stroke.points_px, 0.01)}});
  return table;
}

PartTable sketch_region_table(const Snapshot& s) {
  PartTable table;
  if (!s.sketch) return table;
  for (const RegionView& region : s.sketch->regions) {
    const RegionPair* pair = nullptr;
    if (s.match)
      for (const RegionPair& candidate : s.match->matching.pairs)
        if (candidate.label_a == region.label && candidate.verdict != Verdict::kRejected) pair = &candidate;
    table[std::to_string(region.label)] = to_text({{"outline", points_json(region.outline_px, 0.1)},
                                                   {"kind", word_of(kRegionWords, region.kind)},
                                                   {"pair", pair ? Json(pair->label_b) : Json(nullptr)},
                                                   {"confidence", pair ? rounded(pair->confidence, 0.01) : 0}});
  }
  return table;
}

PartTable sketch_gap_table(const Snapshot& s) {
  PartTable table;
  if (!s.sketch) return table;
  for (std::size_t i = 0; i < s.sketch->gaps.size(); ++i) {
    const SketchGap& gap = s.sketch->gaps[i];
    table[std::to_string(i)] = to_text(
        {{"a", point_json(gap.gap_px.a, 0.1)}, {"b", point_json(gap.gap_px.b, 0.1)}, {"closed", gap.closed_by_us}});
  }
  return table;
}

PartTable plan_region_table(const Snapshot& s) {
  PartTable table;
  if (!s.match) return table;
  for (const RegionView& region : s.match->map_regions)
    table[std::to_string(region.label)] =
        to_text({{"outline", points_json(region.outline_px, 0.1)}, {"kind", word_of(kRegionWords, region.kind)}});
  return table;
}

PartTable pair_table(const Snapshot& s) {
  PartTable table;
  if (!s.match) return table;
  for (const RegionPair& pair : s.match->matching.pairs)
    table[std::to_string(pair.label_a) + "-" + std::to_string(pair.label_b)] =
        to_text({{"sketch", pair.label_a},
                 {"plan", pair.label_b},
                 {"confidence", rounded(pair.confidence, 0.01)},
                 {"verdict", word_of(kVerdictWords, pair.verdict)}});
  return table;
}

PartTable match_table(const Snapshot& s) {
  PartTable table;
  if (!s.match) return table;
  const Matching& matching = s.match->matching;
  table["match"] =
      to_text({{"doubtful", matching.doubtful},
               {"margin", rounded(matching.margin, 0.01)},
               {"next_pin", matching.next_pin_label_a ? Json(*matching.next_pin_label_a) : Json(nullptr)}});
  return table;
}

PartTable alert_table(const Snapshot& s) {
  PartTable table;
  for (const Alert& alert : s.alerts) table[alert.id] = to_text({{"text", alert.text}, {"urgent", alert.urgent}});
  return table;
}

PartTable anchor_table(const Snapshot& s, const ServerView& view) {
  PartTable table;
  for (const auto& [id, pair] : view.anchors) {
    Json anchor{{"px", point_json(pair.first)}, {"map", point_json(pair.second)}};
    if (s.merged)
      for (const MergedAnchor& merged : s.merged->anchors)
        if (merged.id == id) anchor["outlier"] = merged.outlier, anchor["off_m"] = rounded_m(merged.residual_m);
    table[id] = to_text(anchor);
  }
  return table;
}

}  // namespace

PartTable part_table(Part part, const Snapshot& snapshot, const ServerView& view) {
  switch (part) {
    case Part::kInfo:
      return info_table(snapshot, view);
    case Part::kLayoutWalls:
      return layout_wall_table(snapshot);
    case Part::kWalls:
      return wall_table(snapshot);
    case Part::kLinks:
      return link_table(snapshot);
    case Part::kRobots:
      return robot_table(snapshot);
    case Part::kPois:
      return poi_table(snapshot);
    case Part::kGoals:
      return goal_table(snapshot);
    case Part::kStrokes:
      return stroke_table(snapshot);
    case Part::kSketchRegions:
      return sketch_region_table(snapshot);
    case Part::kSketchGaps:
      return sketch_gap_table(snapshot);
    case Part::kPlanRegions:
      return plan_region_table(snapshot);
    case Part::kPairs:
      return pair_table(snapshot);
    case Part::kMatch:
      return match_table(snapshot);
    case Part::kPeople:
      return {};
    case Part::kAlerts:
      return alert_table(snapshot);
    case Part::kAnchors:
      return anchor_table(snapshot, view);
  }
  return {};
}

PartTable people_table(const std::map<std::string, Person>& people) {
  PartTable table;
  for (const auto& [device, person] : people)
    table[device] = to_text({{"name", person.name},
                             {"role", person.role},
                             {"mode", person.mode},
                             {"p", person.p_map ? point_json(*person.p_map, 0.01) : Json(nullptr)},
                             {"seen_ms", person.seen_ms}});
  return table;
}

}  // namespace smokemap::server
