// Every command, drawn at random within its limits, keeps its schema, comes back the same, and is refused one step
// beyond each limit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "server/wire/commands_json.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

const Authorship kWriter{"Anna", 42};

class CommandDice {
 public:
  explicit CommandDice(std::uint64_t seed) : random_(seed) {}

  Command draw(std::size_t kind) {
    switch (kind) {
      case 0:
        return SetLayout{id(), layout()};
      case 1:
        return SetStart{id(), point(), uniform(random_, -100, 100)};
      case 2:
        return AddAnchor{id(), point(), point()};
      case 3:
        return RemoveAnchor{id()};
      case 4:
        return JudgeWall{index(), static_cast<WallVerdict>(uniform_index(random_, 3))};
      case 5:
        return MeasureWall{index(), maybe() ? std::optional(uniform(random_, 0.1, 500)) : std::nullopt};
      case 6:
        return PinCorner{index(), maybe() ? std::optional(point()) : std::nullopt};
      case 7:
        return AddStroke{stroke()};
      case 8:
        return EraseStroke{id(), maybe()};
      case 9:
        return ClearSketch{};
      case 10:
        return SetSketchSheet{side(), side()};
      case 11:
        return JudgePair{point(), point(), static_cast<Verdict>(uniform_index(random_, 3))};
      case 12:
        return PlacePoi{poi()};
      case 13:
        return RemovePoi{id()};
      case 14:
        return SetGoal{goal()};
      case 15:
        return CancelGoal{id()};
      case 16:
        return EmergencyStop{maybe() ? id() : "", maybe()};
      default:
        return SetExploring{id(), maybe()};
    }
  }

 private:
  bool maybe() { return uniform01(random_) < 0.5; }
  int index() { return static_cast<int>(uniform_index(random_, 1'000'001)); }
  int side() { return 16 + static_cast<int>(uniform_index(random_, 8177)); }
  Point2 point() {
    const double most = maybe() ? 10 : Fields::kLargest;
    return {uniform(random_, -most, most), uniform(random_, -most, most)};
  }
  std::string id() {
    std::string text;
    for (std::uint64_t n = 1 + uniform_index(random_, 64); n > 0; --n) {
      const char c = static_cast<char>('!' + uniform_index(random_, 94));
      text += c == '"' || c == '\\' ? '-' : c;
    }
    return text;
  }
  Place place() { return {static_cast<PlaceFrame>(uniform_index(random_, 3)), point(), 0}; }
  Stroke stroke() {
    Stroke stroke{id(), "", static_cast<StrokeKind>(uniform_index(random_, 3)), uniform(random_, 0.1, 200), {}};
    for (std::uint64_t n = 1 + uniform_index(random_, 50); n > 0; --n) stroke.points_px.push_back(point());
    return stroke;
  }
  PointOfInterest poi() {
    PointOfInterest poi;
    poi.id = id();
    poi.kind = static_cast<PoiKind>(uniform_index(random_, 9));
    poi.place = place();
    poi.label = maybe() ? "Gasflasche \xc3\xbc\xe2\x82\xac \"quoted\" \\ \n" : "";
    return poi;
  }
  Goal goal() {
    Goal goal;
    goal.id = id();
    goal.robot = id();
    goal.place = place();
    if (maybe()) goal.heading_rad = uniform(random_, -100, 100);
    return goal;
  }
  /// Coordinates in hundredths of a pixel, as documents keep them.
  LayoutMap layout() {
    const auto hundredth = [this](double most) { return std::round(uniform(random_, 0, most) * 100) / 100; };
    LayoutMap layout;
    layout.width_px = 100 + static_cast<int>(uniform_index(random_, 3000));
    layout.height_px = 100 + static_cast<int>(uniform_index(random_, 3000));
    const int corners = 2 + static_cast<int>(uniform_index(random_, 20));
    for (int i = 0; i < corners; ++i) layout.corners.push_back({{hundredth(3000), hundredth(3000)}, 0, 1});
    for (int i = 0; i + 1 < corners; ++i) {
      layout.walls.push_back({i, i + 1, hundredth(20), hundredth(1), maybe()});
      ++layout.corners[static_cast<std::size_t>(i)].degree;
      ++layout.corners[static_cast<std::size_t>(i + 1)].degree;
    }
    if (maybe()) layout.scale = LayoutScale{0.025, 0.03, maybe()};
    if (maybe()) layout.you_are_here_px = Point2(hundredth(100), hundredth(100));
    layout.warnings.assign(uniform_index(random_, 3), "a \"warning\"");
    return layout;
  }

  std::mt19937_64 random_;
};

TEST(EveryCommand, KeepsItsSchemaAndComesBackTheSame) {
  const test::Schema schema(std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/ws/commands.schema.json");
  CommandDice dice(1);
  for (std::size_t kind = 0; kind < std::variant_size_v<Command>; ++kind)
    for (int round = 0; round < 60; ++round) {
      const Command command = dice.draw(kind);
      ASSERT_EQ(command.index(), kind);
      const std::string name = command_name(command);
      const Json data = command_data(command);
      EXPECT_EQ(schema.complaint(data, schema.def(name)), "") << name;
      const auto read = parse_json(to_text(data), {1'000'000, 16});  // as it lies in the log
      ASSERT_THAT(read, test::IsOk());
      const auto again = command_from_json(name, *read, kWriter);
      ASSERT_THAT(again, test::IsOk()) << name << " " << data;
      EXPECT_EQ(again->index(), kind);
      EXPECT_EQ(command_data(*again), data) << name;
    }
}

TEST(EveryCommand, CarriesWhoDidItAndWhen) {
  CommandDice dice(2);
  for (const std::size_t kind : {7u, 12u, 14u}) {
    const Command sent = dice.draw(kind);
    const auto command = command_from_json(command_name(sent), command_data(sent), {"Bo", 77});
    ASSERT_THAT(command, test::IsOk());
    if (const auto* stroke = std::get_if<AddStroke>(&*command)) {
      EXPECT_EQ(stroke->stroke.author, "Bo");
    } else if (const auto* poi = std::get_if<PlacePoi>(&*command)) {
      EXPECT_EQ(poi->poi.author + std::to_string(poi->poi.created), "Bo77");
    } else {
      const Goal& goal = std::get<SetGoal>(*command).goal;
      EXPECT_EQ(goal.author + std::to_string(goal.created), "Bo77");
      EXPECT_EQ(goal.state, GoalState::kQueued);
    }
  }
}

/// A field, the least and the most it takes, and the step beyond.
struct Limit {
  std::string command, field;
  double low, high, beyond;
};

TEST(EveryLimit, IsTakenAtItsEdgeAndRefusedBeyond) {
  const auto folder = std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/examples";
  const std::vector<Limit> limits{
      {"set_start", "heading", -100, 100, 1e-9},  {"judge_wall", "wall", 0, 1e6, 1},
      {"measure_wall", "wall", 0, 1e6, 1},        {"measure_wall", "length", 0.1, 500, 1e-9},
      {"pin_corner", "corner", 0, 1e6, 1},        {"add_stroke", "width", 0.1, 200, 1e-9},
      {"set_sketch_sheet", "width", 16, 8192, 1}, {"set_sketch_sheet", "height", 16, 8192, 1},
      {"set_goal", "heading", -100, 100, 1e-9}};
  for (const Limit& limit : limits) {
    const Json whole = test::read_json(folder / ("client_command_" + limit.command + ".json"))["data"];
    const auto with = [&](const Json& value) {
      Json data = whole;
      data[limit.field] = value;
      return command_from_json(limit.command, data, kWriter);
    };
    EXPECT_THAT(with(limit.low), test::IsOk()) << limit.command << "." << limit.field;
    EXPECT_THAT(with(limit.high), test::IsOk()) << limit.command << "." << limit.field;
    for (const double bad : {limit.low - limit.beyond, limit.high + limit.beyond, 1e308, -1e308})
      EXPECT_THAT(with(bad), test::Fails(Errc::kInvalidArgument)) << limit.command << "." << limit.field << " " << bad;
    for (const Json& odd : {Json("1"), Json(true), Json::array({1}), Json::object()})
      EXPECT_THAT(with(odd), test::Fails(Errc::kInvalidArgument)) << limit.command << "." << limit.field << odd;
  }
}

TEST(EveryLimit, OfWholeNumbersRefusesHalves) {
  for (const char* field : {"width", "height"}) {
    Json data{{"width", 100}, {"height", 100}};
    data[field] = 100.5;
    EXPECT_THAT(command_from_json("set_sketch_sheet", data, kWriter), test::Fails(Errc::kInvalidArgument)) << field;
  }
  EXPECT_THAT(command_from_json("judge_wall", {{"wall", 2.0}, {"verdict", "gone"}}, kWriter), test::IsOk())
      << "browsers know only one kind of number";
}

TEST(EveryPlace, IsTwoNumbersWithinTheLargest) {
  const auto at = [](const Json& p) {
    return command_from_json("place_poi", {{"poi_id", "a"}, {"kind", "fire"}, {"frame", "map"}, {"p", p}}, kWriter);
  };
  EXPECT_THAT(at({Fields::kLargest, -Fields::kLargest}), test::IsOk());
  for (const Json& p : {Json({1.0001e7, 0}), Json({0, -1.0001e7}), Json({1}), Json({1, 2, 3}), Json({1, nullptr}),
                        Json({"1", "2"}), Json({{"x", 1}, {"y", 2}}), Json("1,2"), Json(nullptr)})
    EXPECT_THAT(at(p), test::Fails(Errc::kInvalidArgument)) << p;
}

TEST(EveryText, OfOtherAlphabetsWasRefusedWellBelowItsLimit) {
  const auto labelled = [](const std::string& label) {
    return command_from_json(
        "place_poi", {{"poi_id", "a"}, {"kind", "note"}, {"frame", "map"}, {"p", {0, 0}}, {"label", label}}, kWriter);
  };
  std::string euros;
  for (int i = 0; i < 200; ++i) euros += "\xe2\x82\xac";
  EXPECT_THAT(labelled(euros), test::IsOk()) << "200 characters, 600 bytes";
  EXPECT_THAT(labelled(euros + "a"), test::Fails(Errc::kInvalidArgument));
  const auto stopped = [](const std::string& robot) {
    return command_from_json("emergency_stop", {{"robot", robot}, {"engaged", true}}, kWriter);
  };
  EXPECT_THAT(stopped(""), test::IsOk()) << "everybody";
  EXPECT_THAT(stopped(std::string(64, 'r')), test::IsOk());
  EXPECT_THAT(stopped(std::string(65, 'r')), test::Fails(Errc::kInvalidArgument));
}

TEST(EveryId, IsPrintableAndShort) {
  const auto removed = [](const std::string& id) { return command_from_json("remove_poi", {{"poi_id", id}}, kWriter); };
  EXPECT_THAT(removed(std::string(64, 'x')), test::IsOk());
  EXPECT_THAT(removed("robot-1:poi/7.b~"), test::IsOk());
  for (const std::string& id :
       {std::string(), std::string(65, 'x'), std::string("a b"), std::string("a\tb"), std::string("a\0b", 3),
        std::string("a\"b"), std::string("a\\b"), std::string("\x7f"), std::string("\xc3\xa4")})
    EXPECT_THAT(removed(id), test::Fails(Errc::kInvalidArgument)) << id;
}

}  // namespace
}  // namespace smokemap::server
