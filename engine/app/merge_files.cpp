#include "app/merge_files.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace smokemap::app {
namespace {

using nlohmann::json;

/// The document, or why it is none.
Result<json> parse_object(const std::string& text, const char* what) {
  json document = json::parse(text, nullptr, false);
  if (document.is_discarded() || !document.is_object())
    return fail(Errc::kCorrupt, std::string(what) + ": not a JSON object");
  return document;
}

bool read_number(const json& object, const char* field, double& out) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_number()) return false;
  out = found->get<double>();
  return std::isfinite(out);
}

bool read_place(const json& value, Point2& out) {
  if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number()) return false;
  out = {value[0].get<double>(), value[1].get<double>()};
  return out.allFinite();
}

bool read_place(const json& object, const char* field, Point2& out) {
  const auto found = object.is_object() ? object.find(field) : object.end();
  return found != object.end() && read_place(*found, out);
}

double rounded(double value) { return std::round(value * 1e4) / 1e4; }
json to_json(const Point2& p) { return {rounded(p.x()), rounded(p.y())}; }

/// Points far outside the drawing have no place.
bool on_sheet(const Point2& p_px, const LayoutMap& layout) {
  return p_px.x() >= -1 && p_px.y() >= -1 && p_px.x() <= layout.width_px && p_px.y() <= layout.height_px;
}

}  // namespace

Result<Anchors> anchors_from_json(const std::string& text, const LayoutMap& layout) {
  const auto document = parse_object(text, "anchors");
  if (!document) return document.error();
  Anchors out;
  if (const auto start = document->find("start"); start != document->end() && !start->is_null()) {
    Point2 p_px;
    double heading = 0;
    PlanStart plan_start;
    if (!start->is_object() || !read_place(*start, "layout_px", p_px) || !read_number(*start, "heading_rad", heading))
      return fail(Errc::kCorrupt, "anchors: start needs layout_px [x, y] and heading_rad");
    if (start->contains("sigma_m") && (!read_number(*start, "sigma_m", plan_start.sigma_m) || plan_start.sigma_m < 0))
      return fail(Errc::kCorrupt, "anchors: start.sigma_m is not a length");
    if (start->contains("sigma_rad") &&
        (!read_number(*start, "sigma_rad", plan_start.sigma_rad) || plan_start.sigma_rad < 0))
      return fail(Errc::kCorrupt, "anchors: start.sigma_rad is not an angle");
    plan_start.T_layout_robot = Pose2(layout.frame().to_metres(p_px), heading);
    out.start = plan_start;
  }
  if (const auto pairs = document->find("pairs"); pairs != document->end() && !pairs->is_null()) {
    if (!pairs->is_array()) return fail(Errc::kCorrupt, "anchors: pairs is not a list");
    for (const json& entry : *pairs) {
      Anchors::Pair pair;
      if (!read_place(entry, "layout_px", pair.p_layout_px) || !read_place(entry, "map", pair.p_map))
        return fail(Errc::kCorrupt,
                    "anchors: pair " + std::to_string(out.pairs.size()) + " needs layout_px [x, y] and map [x, y]");
      out.pairs.push_back(pair);
    }
  }
  return out;
}

Result<std::vector<Point2>> points_from_json(const std::string& text) {
  const auto document = parse_object(text, "points");
  if (!document) return document.error();
  const auto list = document->find("points");
  if (list == document->end() || !list->is_array()) return fail(Errc::kCorrupt, "points: no list of points");
  std::vector<Point2> out;
  for (const json& entry : *list) {
    Point2 p;
    if (!read_place(entry, p))
      return fail(Errc::kCorrupt, "points: entry " + std::to_string(out.size()) + " is not [x, y]");
    out.push_back(p);
  }
  return out;
}

std::string merged_to_json(const MergedMap& merged, const LayoutMap& layout, const std::vector<Point2>& points_px) {
  json out = {{"walls", json::array()}, {"corners", json::array()}, {"points", json::array()}};
  for (const MergedWall& w : merged.walls)
    out["walls"].push_back({{"layout_wall", w.layout_wall ? json(*w.layout_wall) : json()},
                            {"a", to_json(w.segment_map.a)},
                            {"b", to_json(w.segment_map.b)},
                            {"state", to_string(w.state)},
                            {"confidence", rounded(w.confidence)},
                            {"moved_m", rounded(w.displacement_m)}});
  for (const MergedCorner& c : merged.corners)
    out["corners"].push_back({{"layout_px", to_json(c.p_layout_px)},
                              {"map", to_json(c.p_map)},
                              {"sigma_m", rounded(c.sigma_m)},
                              {"seen", c.seen}});
  for (const Point2& p_px : points_px) {
    const Point2 p_layout = layout.frame().to_metres(p_px);
    const bool known = !merged.corners.empty() && on_sheet(p_px, layout);
    out["points"].push_back({{"layout_px", to_json(p_px)},
                             {"map", known ? to_json(merged.layout_to_map(p_layout)) : json()},
                             {"sigma_m", known ? json(rounded(merged.layout_to_map.sigma_m(p_layout))) : json()}});
  }
  out["pairs"] = json::array();
  for (const MergedAnchor& a : merged.anchors)
    out["pairs"].push_back({{"id", a.id}, {"residual_m", rounded(a.residual_m)}, {"outlier", a.outlier}});
  out["fit"] = {{"score", rounded(merged.fit.score)}, {"verdict", merged.fit.verdict}};
  return out.dump();
}

}  // namespace smokemap::app
