#include "recording/layout_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

namespace smokemap {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostEntries = 100'000;
constexpr int kMostPixels = 100'000;
constexpr double kSameCornerPx = 1.5;

/// Thrown and caught in this file only, like the exceptions of the JSON library.
struct BadField : std::runtime_error {
  BadField(Errc why, const std::string& text) : std::runtime_error(text), code(why) {}
  Errc code;
};

[[noreturn]] void bad(const std::string& field, const std::string& what) {
  throw BadField(Errc::kCorrupt, "layout document: " + field + " " + what);
}

// Hundredths of a pixel are more than any reader sees; they keep documents short.
double rounded(double value) { return std::round(value * 100) / 100; }
Json point_json(const Point2& p) { return {rounded(p.x()), rounded(p.y())}; }
Json segment_json(const Segment2& s) {
  return {rounded(s.a.x()), rounded(s.a.y()), rounded(s.b.x()), rounded(s.b.y())};
}

const char* door_kind(OpeningKind kind) {
  switch (kind) {
    case OpeningKind::kDoor:
      return "door";
    case OpeningKind::kWindow:
      return "window";
    case OpeningKind::kPassage:
      return "passage";
  }
  return "door";
}

/// Fields of one document, checked one by one.
class Fields {
 public:
  explicit Fields(const Json& document) : document_(document) {
    if (!document.is_object()) bad("it", "is no object");
  }

  const Json* find(const char* field) const {
    const auto found = document_.find(field);
    return found == document_.end() || found->is_null() ? nullptr : &*found;
  }

  /// The list, or an empty one; never longer than kMostEntries.
  const Json& list(const char* field) const {
    static const Json kNone = Json::array();
    const Json* found = find(field);
    if (!found) return kNone;
    if (!found->is_array()) bad(field, "is no list");
    if (found->size() > kMostEntries)
      throw BadField(Errc::kTooLarge, std::string("layout document: too many ") + field);
    return *found;
  }

  static std::vector<double> numbers(const Json& list, const char* field, std::size_t least, std::size_t most) {
    if (!list.is_array() || list.size() < least || list.size() > most) bad(field, "has an entry of a wrong length");
    std::vector<double> values;
    for (const Json& number : list) values.push_back(finite(number, field));
    return values;
  }

  static double finite(const Json& number, const char* field) {
    if (!number.is_number()) bad(field, "holds something that is no number");
    const double value = number.get<double>();
    if (!std::isfinite(value) || std::abs(value) > 1e7) bad(field, "holds a number out of range");
    return value;
  }

  static Point2 point(const Json& list, const char* field) {
    const auto xy = numbers(list, field, 2, 2);
    return {xy[0], xy[1]};
  }

  double confidence(const char* field, std::size_t index, double fallback) const {
    const Json& values = list(field);
    return index < values.size() ? std::clamp(finite(values[index], field), 0.0, 1.0) : fallback;
  }

  std::string text(const Json& value, const char* field) const {
    if (!value.is_string() || value.get_ref<const std::string&>().size() > 1000)
      bad(field, "holds something that is no short text");
    return value.get<std::string>();
  }

 private:
  const Json& document_;
};

int corner_at(LayoutMap& layout, const Point2& p) {
  for (std::size_t i = 0; i < layout.corners.size(); ++i)
    if ((layout.corners[i].p_px - p).norm() <= kSameCornerPx) return static_cast<int>(i);
  layout.corners.push_back({p, 0, 1});
  return static_cast<int>(layout.corners.size()) - 1;
}

void read_walls(const Fields& fields, LayoutMap& layout) {
  for (const Json& corner : fields.list("corners"))
    layout.corners.push_back(
        {Fields::point(corner, "corners"), 0, fields.confidence("corner_confidence", layout.corners.size(), 1)});
  if (!fields.find("walls")) bad("walls", "is missing");
  const Json& walls = fields.list("walls");
  const Json& ends = fields.list("wall_corners");
  if (!ends.empty() && ends.size() != walls.size()) bad("wall_corners", "is of another length than walls");
  if (ends.empty() && walls.size() > 10'000)
    throw BadField(Errc::kTooLarge, "layout document: too many walls without wall_corners");
  const Json& by_person = fields.list("wall_by_person");
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto n = Fields::numbers(walls[i], "walls", 4, 5);
    LayoutWall wall;
    if (ends.empty()) {
      wall.corner_a = corner_at(layout, {n[0], n[1]});
      wall.corner_b = corner_at(layout, {n[2], n[3]});
    } else {
      const auto ij = Fields::numbers(ends[i], "wall_corners", 2, 2);
      for (const double index : ij)
        if (index < 0 || index >= static_cast<double>(layout.corners.size()) || index != std::floor(index))
          bad("wall_corners", "names a corner that is not there");
      wall.corner_a = static_cast<int>(ij[0]), wall.corner_b = static_cast<int>(ij[1]);
    }
    if (wall.corner_a == wall.corner_b) {
      if (ends.empty()) continue;  // shorter than what counts as one corner
      bad("wall_corners", "has a wall from a corner to itself");
    }
    wall.thickness_px = n.size() > 4 ? std::max(0.0, n[4]) : 0;
    wall.confidence = fields.confidence("wall_confidence", i, 1);
    wall.by_person = i < by_person.size() && by_person[i].is_boolean() && by_person[i].get<bool>();
    layout.walls.push_back(wall);
  }
  for (const LayoutWall& wall : layout.walls)
    for (const int corner : {wall.corner_a, wall.corner_b}) ++layout.corners[static_cast<std::size_t>(corner)].degree;
}

void read_openings(const Fields& fields, LayoutMap& layout) {
  const Json& kinds = fields.list("door_kinds");
  for (const Json& door : fields.list("doors")) {
    const auto n = Fields::numbers(door, "doors", 4, 4);
    const std::size_t i = layout.openings.size();
    const std::string kind = i < kinds.size() ? fields.text(kinds[i], "door_kinds") : "door";
    layout.openings.push_back({Segment2{{n[0], n[1]}, {n[2], n[3]}},
                               kind == "window"    ? OpeningKind::kWindow
                               : kind == "passage" ? OpeningKind::kPassage
                                                   : OpeningKind::kDoor,
                               fields.confidence("door_confidence", i, 1)});
  }
}

void read_rooms_and_signs(const Fields& fields, LayoutMap& layout) {
  for (const Json& outline : fields.list("rooms")) {
    if (!outline.is_array() || outline.size() > kMostEntries) bad("rooms", "holds something that is no outline");
    Polygon room;
    for (const Json& p : outline) room.push_back(Fields::point(p, "rooms"));
    layout.rooms_px.push_back(std::move(room));
  }
  for (const Json& sign : fields.list("signs")) {
    const Fields of(sign);
    const auto number = [&](const char* field, double fallback) {
      const Json* found = of.find(field);
      return found ? Fields::finite(*found, "signs") : fallback;
    };
    const Json* colour = of.find("colour");
    layout.signs.push_back({Point2(number("x", 0), number("y", 0)), number("r", 0),
                            colour ? of.text(*colour, "signs") : "", std::clamp(number("confidence", 1), 0.0, 1.0)});
  }
  for (const Json& drawing : fields.list("drawings")) {
    const Fields of(drawing);
    const Json* box = of.find("box");
    if (!box) bad("drawings", "holds one without a box");
    const auto n = Fields::numbers(*box, "drawings", 4, 4);
    const Json* chosen = of.find("chosen");
    const Json* score = of.find("score");
    layout.drawings.push_back({Point2(n[0], n[1]), Point2(n[2], n[3]),
                               score ? std::clamp(Fields::finite(*score, "drawings"), 0.0, 1.0) : 1.0,
                               chosen && chosen->is_boolean() && chosen->get<bool>()});
  }
  if (const Json* here = fields.find("you_are_here")) layout.you_are_here_px = Fields::point(*here, "you_are_here");
  for (const Json& warning : fields.list("warnings")) layout.warnings.push_back(fields.text(warning, "warnings"));
}

void read_scale(const Fields& fields, LayoutMap& layout) {
  const Json* scale = fields.find("metres_per_pixel");
  if (!scale) return;
  const Json* sigma = fields.find("scale_sigma");
  const Json* by_person = fields.find("scale_by_person");
  LayoutScale read{Fields::finite(*scale, "metres_per_pixel"), sigma ? Fields::finite(*sigma, "scale_sigma") : 0.05,
                   by_person && by_person->is_boolean() && by_person->get<bool>()};
  if (!(read.metres_per_pixel > 0) || !(read.relative_sigma >= 0)) bad("metres_per_pixel", "is not positive");
  layout.scale = read;
}

void read_sheet(const Fields& fields, LayoutDocument& document) {
  if (const Json* homography = fields.find("homography")) {
    const auto h = Fields::numbers(*homography, "homography", 9, 9);
    std::copy(h.begin(), h.end(), document.homography.H_layout_photo.begin());
  }
  if (const Json* corners = fields.find("sheet_corners")) {
    if (!corners->is_array() || corners->size() != 4) bad("sheet_corners", "are not four");
    document.sheet_corners.emplace();
    for (std::size_t i = 0; i < 4; ++i) (*document.sheet_corners)[i] = Fields::point((*corners)[i], "sheet_corners");
  }
}

LayoutDocument parse_layout(std::string_view text) {
  const Json json = Json::parse(text);
  const Fields fields(json);
  LayoutDocument document;
  const Json* size = fields.find("size");
  if (!size) bad("size", "is missing");
  const auto wh = Fields::numbers(*size, "size", 2, 2);
  if (!(wh[0] >= 1 && wh[1] >= 1)) bad("size", "is not positive");
  if (wh[0] > kMostPixels || wh[1] > kMostPixels)
    throw BadField(Errc::kTooLarge, "layout document: size is over 100000 px");
  document.layout.width_px = static_cast<int>(wh[0]);
  document.layout.height_px = static_cast<int>(wh[1]);
  read_walls(fields, document.layout);
  read_openings(fields, document.layout);
  read_rooms_and_signs(fields, document.layout);
  read_scale(fields, document.layout);
  read_sheet(fields, document);
  return document;
}

void add_walls(Json& json, const LayoutMap& layout) {
  for (const char* field :
       {"walls", "wall_confidence", "wall_by_person", "wall_corners", "corners", "corner_confidence"})
    json[field] = Json::array();
  for (std::size_t i = 0; i < layout.walls.size(); ++i) {
    const LayoutWall& wall = layout.walls[i];
    Json line = segment_json(layout.wall_px(static_cast<int>(i)));
    line.push_back(rounded(wall.thickness_px));
    json["walls"].push_back(std::move(line));
    json["wall_confidence"].push_back(rounded(wall.confidence));
    json["wall_by_person"].push_back(wall.by_person);
    json["wall_corners"].push_back({wall.corner_a, wall.corner_b});
  }
  for (const LayoutCorner& corner : layout.corners) {
    json["corners"].push_back(point_json(corner.p_px));
    json["corner_confidence"].push_back(rounded(corner.confidence));
  }
}

void add_the_rest(Json& json, const LayoutMap& layout) {
  for (const char* field : {"doors", "door_kinds", "door_confidence", "rooms", "signs"}) json[field] = Json::array();
  for (const LayoutOpening& opening : layout.openings) {
    json["doors"].push_back(segment_json(opening.gap_px));
    json["door_kinds"].push_back(door_kind(opening.kind));
    json["door_confidence"].push_back(rounded(opening.confidence));
  }
  for (const Polygon& room : layout.rooms_px) {
    Json outline = Json::array();
    for (const Point2& p : room) outline.push_back(point_json(p));
    json["rooms"].push_back(std::move(outline));
  }
  for (const LayoutSign& sign : layout.signs)
    json["signs"].push_back({{"x", rounded(sign.p_px.x())},
                             {"y", rounded(sign.p_px.y())},
                             {"r", rounded(sign.radius_px)},
                             {"colour", sign.colour},
                             {"confidence", rounded(sign.confidence)}});
  json["drawings"] = Json::array();
  for (const LayoutDrawing& drawing : layout.drawings)
    json["drawings"].push_back({{"box", segment_json({drawing.low_px, drawing.high_px})},
                                {"score", rounded(drawing.score)},
                                {"chosen", drawing.chosen}});
  json["you_are_here"] = layout.you_are_here_px ? point_json(*layout.you_are_here_px) : Json();
  json["metres_per_pixel"] = layout.scale ? Json(layout.scale->metres_per_pixel) : Json();
  if (layout.scale)
    json["scale_sigma"] = layout.scale->relative_sigma, json["scale_by_person"] = layout.scale->by_person;
  json["warnings"] = layout.warnings;
}

}  // namespace

std::string to_json(const LayoutDocument& document) {
  Json json;
  json["size"] = {document.layout.width_px, document.layout.height_px};
  add_walls(json, document.layout);
  add_the_rest(json, document.layout);
  json["homography"] = document.homography.H_layout_photo;
  if (document.sheet_corners) {
    json["sheet_corners"] = Json::array();
    for (const Point2& p : *document.sheet_corners) json["sheet_corners"].push_back(point_json(p));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<LayoutDocument> layout_from_json(std::string_view text) {
  try {
    return parse_layout(text);
  } catch (const BadField& e) {
    return fail(e.code, e.what());
  } catch (const Json::exception& e) {
    return fail(Errc::kCorrupt, std::string("layout document: ") + e.what());
  }
}

}  // namespace smokemap
