#include "server/wire/layout_json.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace smokemap::server {
namespace {

constexpr std::size_t kMostWalls = 20'000;
constexpr std::size_t kMostItems = 20'000;
const std::vector<const char*> kOpeningKinds{"door", "window", "passage"};

/// `count` finite numbers at the front of an array item.
bool numbers(const Json& item, std::size_t at_least, std::size_t at_most, std::vector<double>& out) {
  out.clear();
  if (!item.is_array() || item.size() < at_least || item.size() > at_most) return false;
  for (const Json& value : item) {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    if (!std::isfinite(number) || std::abs(number) > Fields::kLargest) return false;
    out.push_back(number);
  }
  return true;
}

double share(const Json* list, std::size_t i, double otherwise) {
  if (!list || i >= list->size() || !(*list)[i].is_number()) return otherwise;
  const double value = (*list)[i].get<double>();
  return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise;
}

/// Ends of walls that (nearly) coincide are one corner.
class CornerBook {
 public:
  explicit CornerBook(std::vector<LayoutCorner>& corners) : corners_(corners) {}

  int at(const Point2& p) {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const auto it = cells_.find({cell(p.x()) + dx, cell(p.y()) + dy});
        if (it == cells_.end()) continue;
        for (const int i : it->second)
          if ((corners_[static_cast<std::size_t>(i)].p_px - p).norm() < kSame_px) return i;
      }
    corners_.push_back({p, 0, 1});
    const int index = static_cast<int>(corners_.size()) - 1;
    cells_[{cell(p.x()), cell(p.y())}].push_back(index);
    return index;
  }

 private:
  static constexpr double kSame_px = 0.5;
  static long cell(double v) { return std::lround(std::floor(v)); }
  std::vector<LayoutCorner>& corners_;
  std::map<std::pair<long, long>, std::vector<int>> cells_;
};

/// Corners as given, if they and the index pairs fit the walls.
bool read_given_corners(Fields& f, std::size_t wall_count, LayoutMap& layout,
                        std::vector<std::pair<int, int>>& ends) {
  const Json* corners = f.array("corners", 2 * kMostWalls);
  const Json* pairs = f.array("wall_corners", kMostWalls);
  const Json* confidence = f.array("corner_confidence", 2 * kMostWalls);
  if (!corners || !pairs || pairs->size() != wall_count) return false;
  std::vector<double> v;
  for (std::size_t i = 0; i < corners->size(); ++i) {
    if (!numbers((*corners)[i], 2, 2, v)) return f.complain(".corners must be a list of [x, y]"), false;
    layout.corners.push_back({Point2(v[0], v[1]), 0, share(confidence, i, 1)});
  }
  for (const Json& pair : *pairs) {
    if (!numbers(pair, 2, 2, v)) return f.complain(".wall_corners must be a list of [i, j]"), false;
    const double most = static_cast<double>(corners->size());
    if (v[0] < 0 || v[1] < 0 || v[0] >= most || v[1] >= most)
      return f.complain(".wall_corners names a corner that is not there"), false;
    ends.emplace_back(static_cast<int>(v[0]), static_cast<int>(v[1]));
  }
  return true;
}

void read_walls(Fields& f, LayoutMap& layout) {
  const Json* walls = f.array("walls", kMostWalls);
  if (!walls) return f.complain(".walls is missing");
  const Json* confidence = f.array("wall_confidence", kMostWalls);
  const Json* by_person = f.array("wall_by_person", kMostWalls);
  std::vector<std::pair<int, int>> ends;
  const bool given = read_given_corners(f, walls->size(), layout, ends);
  CornerBook book(layout.corners);
  std::vector<double> v;
  for (std::size_t i = 0; f.ok() && i < walls->size(); ++i) {
    if (!numbers((*walls)[i], 4, 5, v))
      return f.complain(".walls[" + std::to_string(i) + "] must be [x1, y1, x2, y2, thickness]");
    LayoutWall wall;
    wall.corner_a = given ? ends[i].first : book.at(Point2(v[0], v[1]));
    wall.corner_b = given ? ends[i].second : book.at(Point2(v[2], v[3]));
    wall.thickness_px = v.size() > 4 ? std::max(0.0, v[4]) : 0;
    wall.confidence = share(confidence, i, 1);
    wall.by_person = by_person && i < by_person->size() && (*by_person)[i] == true;
    layout.walls.push_back(wall);
  }
  for (const LayoutWall& wall : layout.walls) {
    ++layout.corners[static_cast<std::size_t>(wall.corner_a)].degree;
    ++layout.corners[static_cast<std::size_t>(wall.corner_b)].degree;
  }
}

void read_openings(Fields& f, LayoutMap& layout) {
  const Json* doors = f.array("doors", kMostItems);
  const Json* kinds = f.array("door_kinds", kMostItems);
  if (!doors) return;
  std::vector<double> v;
  for (std::size_t i = 0; i < doors->size(); ++i) {
    if (!numbers((*doors)[i], 4, 4, v)) return f.complain(".doors must be a list of [x1, y1, x2, y2]");
    LayoutOpening opening;
    opening.gap_px = {Point2(v[0], v[1]), Point2(v[2], v[3])};
    for (std::size_t k = 0; kinds && i < kinds->size() && k < kOpeningKinds.size(); ++k)
      if ((*kinds)[i] == kOpeningKinds[k]) opening.kind = static_cast<OpeningKind>(k);
    layout.openings.push_back(opening);
  }
}

void read_rooms(Fields& f, LayoutMap& layout) {
  const Json* rooms = f.array("rooms", kMostItems);
  if (!rooms) return;
  for (const Json& room : *rooms) {
    Polygon ring;
    if (!room.is_array() || room.size() > kMostItems) return f.complain(".rooms must be a list of rings");
    for (const Json& corner : room) {
      const auto p = point_of(corner);
      if (!p) return f.complain(".rooms must be a list of rings of [x, y]");
      ring.push_back(*p);
    }
    layout.rooms_px.push_back(std::move(ring));
  }
}

void read_signs(Fields& f, LayoutMap& layout) {
  const Json* signs = f.array("signs", kMostItems);
  if (!signs) return;
  for (const Json& item : *signs) {
    Fields s(item, "layout.signs");
    LayoutSign sign;
    sign.p_px = {s.number("x"), s.number("y")};
    sign.radius_px = s.number("r", 0, 1e5);
    sign.colour = s.text("colour", 32);
    if (s.has("confidence")) sign.confidence = s.number("confidence", 0, 1);
    if (!s.ok()) return f.complain(".signs has one without x, y, r or colour");
    layout.signs.push_back(std::move(sign));
  }
}

void read_rest(Fields& f, LayoutMap& layout) {
  if (f.has("you_are_here")) layout.you_are_here_px = f.point("you_are_here");
  if (f.has("metres_per_pixel")) {
    LayoutScale scale;
    scale.metres_per_pixel = f.number("metres_per_pixel", 1e-5, 100);
    if (f.has("scale_sigma")) scale.relative_sigma = f.number("scale_sigma", 0, 10);
    if (f.has("scale_by_person")) scale.by_person = f.boolean("scale_by_person");
    layout.scale = scale;
  }
  const Json* warnings = f.array("warnings", 1000);
  for (std::size_t i = 0; warnings && i < warnings->size(); ++i)
    if ((*warnings)[i].is_string()) layout.warnings.push_back((*warnings)[i].get<std::string>());
}

Json ends_json(const Segment2& s) { return Json::array({s.a.x(), s.a.y(), s.b.x(), s.b.y()}); }
Json exact(const Point2& p) { return Json::array({p.x(), p.y()}); }

void write_walls(const LayoutMap& layout, Json& json) {
  json["walls"] = json["wall_confidence"] = json["wall_by_person"] = json["wall_corners"] = Json::array();
  json["corners"] = json["corner_confidence"] = Json::array();
  for (std::size_t i = 0; i < layout.walls.size(); ++i) {
    const LayoutWall& wall = layout.walls[i];
    Json line = ends_json(layout.wall_px(static_cast<int>(i)));
    line.push_back(wall.thickness_px);
    json["walls"].push_back(std::move(line));
    json["wall_confidence"].push_back(wall.confidence);
    json["wall_by_person"].push_back(wall.by_person);
    json["wall_corners"].push_back(Json::array({wall.corner_a, wall.corner_b}));
  }
  for (const LayoutCorner& corner : layout.corners) {
    json["corners"].push_back(exact(corner.p_px));
    json["corner_confidence"].push_back(corner.confidence);
  }
}

}  // namespace

Result<LayoutMap> layout_from_json(const Json& json) {
  Fields f(json, "layout");
  if (json.is_object() && json.contains("walls") && json["walls"].is_array() && json["walls"].size() > kMostWalls)
    return fail(Errc::kTooLarge, "layout with " + std::to_string(json["walls"].size()) + " walls, at most " +
                                     std::to_string(kMostWalls) + " are taken");
  LayoutMap layout;
  const Point2 size = f.point("size");
  if (f.ok() && (size.x() < 1 || size.y() < 1 || size.x() > 1e5 || size.y() > 1e5))
    f.complain(".size must be within 1 and 100000 pixels");
  if (!f.ok()) return f.error();
  layout.width_px = static_cast<int>(size.x());
  layout.height_px = static_cast<int>(size.y());
  read_walls(f, layout);
  read_openings(f, layout);
  read_rooms(f, layout);
  read_signs(f, layout);
  read_rest(f, layout);
  if (!f.ok()) return f.error();
  return layout;
}

Json layout_to_json(const LayoutMap& layout, const std::optional<SheetInPicture>& sheet) {
  Json json = {{"size", {layout.width_px, layout.height_px}}};
  write_walls(layout, json);
  json["doors"] = json["door_kinds"] = json["rooms"] = json["signs"] = Json::array();
  for (const LayoutOpening& opening : layout.openings) {
    json["doors"].push_back(ends_json(opening.gap_px));
    json["door_kinds"].push_back(kOpeningKinds[static_cast<std::size_t>(opening.kind)]);
  }
  for (const Polygon& room : layout.rooms_px) {
    Json ring = Json::array();
    for (const Point2& p : room) ring.push_back(exact(p));
    json["rooms"].push_back(std::move(ring));
  }
  for (const LayoutSign& sign : layout.signs)
    json["signs"].push_back({{"x", sign.p_px.x()},
                             {"y", sign.p_px.y()},
                             {"r", sign.radius_px},
                             {"colour", sign.colour},
                             {"confidence", sign.confidence}});
  json["you_are_here"] = layout.you_are_here_px ? exact(*layout.you_are_here_px) : Json(nullptr);
  json["metres_per_pixel"] = layout.scale ? Json(layout.scale->metres_per_pixel) : Json(nullptr);
  json["scale_sigma"] = layout.scale ? Json(layout.scale->relative_sigma) : Json(nullptr);
  json["scale_by_person"] = layout.scale && layout.scale->by_person;
  if (sheet) {
    json["homography"] = sheet->homography.H_layout_photo;
    json["sheet_corners"] = Json::array();
    for (const Point2& corner : sheet->corners) json["sheet_corners"].push_back(exact(corner));
  }
  json["warnings"] = layout.warnings;
  return json;
}

}  // namespace smokemap::server
