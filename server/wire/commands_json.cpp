#include "server/wire/commands_json.hpp"

#include <array>

#include "server/wire/layout_json.hpp"
#include "server/wire/words.hpp"

namespace smokemap::server {
namespace {

constexpr std::size_t kMostStrokePoints = 20'000;
constexpr int kMostWalls = 1'000'000;

Place place_from(Fields& f) {
  Place place;
  place.frame = static_cast<PlaceFrame>(f.word("frame", kFrameWords));
  place.p = f.point("p");
  return place;
}

using Reader = Result<Command> (*)(const Json&, const Authorship&);

template <typename T>
Result<Command> finish(const Fields& f, T command) {
  if (!f.ok()) return f.error();
  return Command(std::move(command));
}

Result<Command> set_layout(const Json& data, const Authorship&) {
  Fields f(data, "set_layout");
  SetLayout command;
  command.plan_id = f.id("plan_id");
  if (!f.has("layout")) f.complain(".layout is missing");
  if (!f.ok()) return f.error();
  auto layout = layout_from_json(data["layout"]);
  if (!layout) return layout.error();
  command.layout = std::move(*layout);
  return Command(std::move(command));
}
Result<Command> set_start(const Json& data, const Authorship&) {
  Fields f(data, "set_start");
  return finish(f, SetStart{f.id("robot"), f.point("px"), f.number("heading", -100, 100)});
}
Result<Command> add_anchor(const Json& data, const Authorship&) {
  Fields f(data, "add_anchor");
  return finish(f, AddAnchor{f.id("id"), f.point("px"), f.point("map")});
}
Result<Command> remove_anchor(const Json& data, const Authorship&) {
  Fields f(data, "remove_anchor");
  return finish(f, RemoveAnchor{f.id("id")});
}
Result<Command> judge_wall(const Json& data, const Authorship&) {
  Fields f(data, "judge_wall");
  return finish(
      f, JudgeWall{f.integer("wall", 0, kMostWalls), static_cast<WallVerdict>(f.word("verdict", kWallVerdictWords))});
}
Result<Command> measure_wall(const Json& data, const Authorship&) {
  Fields f(data, "measure_wall");
  MeasureWall command{f.integer("wall", 0, kMostWalls), std::nullopt};
  if (f.has("length")) command.length_m = f.number("length", 0.1, 500);
  return finish(f, command);
}
Result<Command> pin_corner(const Json& data, const Authorship&) {
  Fields f(data, "pin_corner");
  PinCorner command{f.integer("corner", 0, kMostWalls), std::nullopt};
  if (f.has("map")) command.p_map = f.point("map");
  return finish(f, command);
}
Result<Command> add_stroke(const Json& data, const Authorship& by) {
  Fields f(data, "add_stroke");
  Stroke stroke;
  stroke.id = f.id("stroke_id");
  stroke.author = by.author;
  stroke.kind = static_cast<StrokeKind>(f.word("kind", kStrokeWords));
  stroke.width_px = f.number("width", 0.1, 200);
  stroke.points_px = f.points("points", 1, kMostStrokePoints);
  return finish(f, AddStroke{std::move(stroke)});
}
Result<Command> erase_stroke(const Json& data, const Authorship&) {
  Fields f(data, "erase_stroke");
  return finish(f, EraseStroke{f.id("stroke_id"), f.boolean("restore")});
}
Result<Command> clear_sketch(const Json& data, const Authorship&) {
  return finish(Fields(data, "clear_sketch"), ClearSketch{});
}
Result<Command> set_sketch_sheet(const Json& data, const Authorship&) {
  Fields f(data, "set_sketch_sheet");
  return finish(f, SetSketchSheet{f.integer("width", 16, 8192), f.integer("height", 16, 8192)});
}
Result<Command> judge_pair(const Json& data, const Authorship&) {
  Fields f(data, "judge_pair");
  return finish(
      f, JudgePair{f.point("sketch_px"), f.point("plan_px"), static_cast<Verdict>(f.word("verdict", kVerdictWords))});
}
Result<Command> place_poi(const Json& data, const Authorship& by) {
  Fields f(data, "place_poi");
  PointOfInterest poi;
  poi.id = f.id("poi_id");
  const auto kind = poi_kind(f.text("kind", 64));
  if (!kind) f.complain(".kind is not a word known here");
  poi.kind = kind.value_or(PoiKind::kNote);
  poi.place = place_from(f);
  poi.label = f.text("label", 200, false);
  poi.author = by.author;
  poi.created = by.created;
  return finish(f, PlacePoi{std::move(poi)});
}
Result<Command> remove_poi(const Json& data, const Authorship&) {
  Fields f(data, "remove_poi");
  return finish(f, RemovePoi{f.id("poi_id")});
}
Result<Command> set_goal(const Json& data, const Authorship& by) {
  Fields f(data, "set_goal");
  Goal goal;
  goal.id = f.id("goal_id");
  goal.robot = f.id("robot");
  goal.place = place_from(f);
  if (f.has("heading")) goal.heading_rad = f.number("heading", -100, 100);
  goal.author = by.author;
  goal.created = by.created;
  return finish(f, SetGoal{std::move(goal)});
}
Result<Command> cancel_goal(const Json& data, const Authorship&) {
  Fields f(data, "cancel_goal");
  return finish(f, CancelGoal{f.id("goal_id")});
}
Result<Command> emergency_stop(const Json& data, const Authorship&) {
  Fields f(data, "emergency_stop");
  return finish(f, EmergencyStop{f.text("robot", 64), f.boolean("engaged")});
}
Result<Command> set_exploring(const Json& data, const Authorship&) {
  Fields f(data, "set_exploring");
  return finish(f, SetExploring{f.text("robot", 64), f.boolean("exploring")});
}

/// In the order of the variant.
struct Kind {
  const char* name;
  Reader read;
};
constexpr std::array<Kind, std::variant_size_v<Command>> kKinds{{{"set_layout", set_layout},
                                                                 {"set_start", set_start},
                                                                 {"add_anchor", add_anchor},
                                                                 {"remove_anchor", remove_anchor},
                                                                 {"judge_wall", judge_wall},
                                                                 {"measure_wall", measure_wall},
                                                                 {"pin_corner", pin_corner},
                                                                 {"add_stroke", add_stroke},
                                                                 {"erase_stroke", erase_stroke},
                                                                 {"clear_sketch", clear_sketch},
                                                                 {"set_sketch_sheet", set_sketch_sheet},
                                                                 {"judge_pair", judge_pair},
                                                                 {"place_poi", place_poi},
                                                                 {"remove_poi", remove_poi},
                                                                 {"set_goal", set_goal},
                                                                 {"cancel_goal", cancel_goal},
                                                                 {"emergency_stop", emergency_stop},
                                                                 {"set_exploring", set_exploring}}};

Json plain_point(const Point2& p) { return Json::array({p.x(), p.y()}); }

struct DataOf {
  Json operator()(const SetLayout& c) const { return {{"plan_id", c.plan_id}, {"layout", layout_to_json(c.layout)}}; }
  Json operator()(const SetStart& c) const {
    return {{"robot", c.robot}, {"px", plain_point(c.p_layout_px)}, {"heading", c.heading_rad}};
  }
  Json operator()(const AddAnchor& c) const {
    return {{"id", c.id}, {"px", plain_point(c.p_layout_px)}, {"map", plain_point(c.p_map)}};
  }
  Json operator()(const RemoveAnchor& c) const { return {{"id", c.id}}; }
  Json operator()(const JudgeWall& c) const {
    return {{"wall", c.layout_wall}, {"verdict", word_of(kWallVerdictWords, c.verdict)}};
  }
  Json operator()(const MeasureWall& c) const {
    return {{"wall", c.layout_wall}, {"length", c.length_m ? Json(*c.length_m) : Json()}};
  }
  Json operator()(const PinCorner& c) const {
    return {{"corner", c.layout_corner}, {"map", c.p_map ? plain_point(*c.p_map) : Json()}};
  }
  Json operator()(const AddStroke& c) const {
    Json points = Json::array();
    for (const Point2& p : c.stroke.points_px) points.push_back(plain_point(p));
    return {{"stroke_id", c.stroke.id},
            {"kind", word_of(kStrokeWords, c.stroke.kind)},
            {"width", c.stroke.width_px},
            {"points", std::move(points)}};
  }
  Json operator()(const EraseStroke& c) const { return {{"stroke_id", c.stroke_id}, {"restore", c.restore}}; }
  Json operator()(const ClearSketch&) const { return Json::object(); }
  Json operator()(const SetSketchSheet& c) const { return {{"width", c.width_px}, {"height", c.height_px}}; }
  Json operator()(const JudgePair& c) const {
    return {{"sketch_px", plain_point(c.p_sketch_px)},
            {"plan_px", plain_point(c.p_layout_px)},
            {"verdict", word_of(kVerdictWords, c.verdict)}};
  }
  Json operator()(const PlacePoi& c) const {
    return {{"poi_id", c.poi.id},
            {"kind", to_string(c.poi.kind)},
            {"frame", word_of(kFrameWords, c.poi.place.frame)},
            {"p", plain_point(c.poi.place.p)},
            {"label", c.poi.label}};
  }
  Json operator()(const RemovePoi& c) const { return {{"poi_id", c.id}}; }
  Json operator()(const SetGoal& c) const {
    return {{"goal_id", c.goal.id},
            {"robot", c.goal.robot},
            {"frame", word_of(kFrameWords, c.goal.place.frame)},
            {"p", plain_point(c.goal.place.p)},
            {"heading", c.goal.heading_rad ? Json(*c.goal.heading_rad) : Json(nullptr)}};
  }
  Json operator()(const CancelGoal& c) const { return {{"goal_id", c.id}}; }
  Json operator()(const EmergencyStop& c) const { return {{"robot", c.robot}, {"engaged", c.engaged}}; }
  Json operator()(const SetExploring& c) const { return {{"robot", c.robot}, {"exploring", c.exploring}}; }
};

}  // namespace

Result<Command> command_from_json(std::string_view name, const Json& data, const Authorship& authorship) {
  for (const Kind& kind : kKinds)
    if (name == kind.name) return kind.read(data, authorship);
  return fail(Errc::kNotFound, "no command is called '" + std::string(name.substr(0, 40)) + "'");
}

const char* command_name(const Command& command) { return kKinds[command.index()].name; }

Json command_data(const Command& command) { return std::visit(DataOf{}, command); }

const std::vector<const char*>& command_names() {
  static const std::vector<const char*> names = [] {
    std::vector<const char*> all;
    for (const Kind& kind : kKinds) all.push_back(kind.name);
    return all;
  }();
  return names;
}

}  // namespace smokemap::server
