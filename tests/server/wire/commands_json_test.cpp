#include "server/wire/commands_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <map>
#include <vector>

#include "core/random.hpp"
#include "server/wire/layout_json.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

const Authorship kBy{"Anna", 42};

/// The example of every command: what a browser truly sends.
std::map<std::string, Json> command_examples() {
  std::map<std::string, Json> examples;
  const auto folder = std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/examples";
  for (const char* name : command_names())
    examples[name] = test::read_json(folder / ("client_command_" + std::string(name) + ".json"))["data"];
  return examples;
}

TEST(CommandJson, NamesEveryFieldThatIsMissing) {
  for (const auto& [name, data] : command_examples())
    for (const auto& [field, value] : data.items()) {
      Json without = data;
      without.erase(field);
      const auto command = command_from_json(name, without, kBy);
      if (command) continue;  // an optional one
      EXPECT_EQ(command.error().code, Errc::kInvalidArgument) << name << "." << field;
      EXPECT_THAT(command.error().message, testing::HasSubstr(field)) << name;
    }
}

TEST(CommandJson, RefusesEveryFieldOfAnotherKindWithoutThrowing) {
  const std::vector<Json> oddities{nullptr,
                                   true,
                                   -1,
                                   1e308,
                                   std::numeric_limits<double>::infinity(),
                                   "",
                                   "a b",
                                   "\n",
                                   std::string(5000, 'x'),
                                   Json::array(),
                                   Json::object(),
                                   Json::array({1, 2, 3}),
                                   Json::array({"a", "b"}),
                                   Json::array({1e300, 1})};
  int refused = 0;
  for (const auto& [name, data] : command_examples())
    for (const auto& [field, value] : data.items())
      for (const Json& odd : oddities) {
        Json changed = data;
        changed[field] = odd;
        const auto command = command_from_json(name, changed, kBy);
        refused += !command;
        if (!command) {
          EXPECT_FALSE(command.error().message.empty()) << name << "." << field;
        }
      }
  EXPECT_GT(refused, 300);
}

TEST(CommandJson, TakesNothingThatIsNoObject) {
  for (const char* name : command_names())
    for (const Json& data : {Json(), Json(1), Json("x"), Json::array()}) {
      const auto command = command_from_json(name, data, kBy);
      EXPECT_TRUE(!command || std::string(name) == "clear_sketch") << name;
    }
}

TEST(CommandJson, ForgetsFieldsThatItDoesNotKnow) {
  for (const auto& [name, data] : command_examples()) {
    Json more = data;
    more["author"] = "Mallory";
    more["created"] = 1;
    more["of_tomorrow"] = {1, 2, 3};
    const auto command = command_from_json(name, more, kBy);
    ASSERT_THAT(command, test::IsOk()) << name;
    EXPECT_FALSE(command_data(*command).contains("of_tomorrow"));
    if (const auto* poi = std::get_if<PlacePoi>(&*command)) {
      EXPECT_EQ(poi->poi.author, "Anna") << "who did it is not believed from the browser";
      EXPECT_EQ(poi->poi.created, 42);
    }
    if (const auto* goal = std::get_if<SetGoal>(&*command)) {
      EXPECT_EQ(goal->goal.author, "Anna");
    }
    if (const auto* stroke = std::get_if<AddStroke>(&*command)) {
      EXPECT_EQ(stroke->stroke.author, "Anna");
    }
  }
}

TEST(CommandJson, ComesBackUnchangedForRandomStrokesAndPlaces) {
  std::mt19937_64 random(9);
  for (int i = 0; i < 200; ++i) {
    Json points = Json::array();
    for (std::uint64_t n = 1 + uniform_index(random, 40); n > 0; --n)
      points.push_back({uniform(random, -1000, 1000), uniform(random, -1000, 1000)});
    const std::vector<std::string> kinds{"wall", "door", "note"};
    const Json stroke{{"stroke_id", "s" + std::to_string(i)},
                      {"kind", kinds[uniform_index(random, 3)]},
                      {"width", uniform(random, 0.1, 200)},
                      {"points", points}};
    const auto command = command_from_json("add_stroke", stroke, kBy);
    ASSERT_THAT(command, test::IsOk());
    EXPECT_EQ(command_data(*command), stroke);
    const std::vector<std::string> frames{"layout_px", "sketch_px", "map"};
    Json goal{{"goal_id", "g"},
              {"robot", "fox"},
              {"frame", frames[uniform_index(random, 3)]},
              {"p", {uniform(random, -50, 50), uniform(random, -50, 50)}},
              {"heading", nullptr}};
    if (i % 2 == 0) goal["heading"] = uniform(random, -3, 3);
    const auto set = command_from_json("set_goal", goal, kBy);
    ASSERT_THAT(set, test::IsOk());
    EXPECT_EQ(command_data(*set), goal);
  }
}

TEST(CommandJson, LimitsWhatOneCommandMayHold) {
  Json points = Json::array();
  for (int i = 0; i < 20'000; ++i) points.push_back({i, i});
  Json stroke{{"stroke_id", "s"}, {"kind", "wall"}, {"width", 3}, {"points", points}};
  EXPECT_THAT(command_from_json("add_stroke", stroke, kBy), test::IsOk());
  stroke["points"].push_back({0, 0});
  EXPECT_THAT(command_from_json("add_stroke", stroke, kBy), test::Fails(Errc::kInvalidArgument));
  stroke["points"] = Json::array();
  EXPECT_THAT(command_from_json("add_stroke", stroke, kBy), test::Fails(Errc::kInvalidArgument));
  const auto sheet = [](int width) { return Json{{"width", width}, {"height", 100}}; };
  EXPECT_THAT(command_from_json("set_sketch_sheet", sheet(8192), kBy), test::IsOk());
  EXPECT_THAT(command_from_json("set_sketch_sheet", sheet(8193), kBy), test::Fails(Errc::kInvalidArgument));
  EXPECT_THAT(command_from_json("set_sketch_sheet", sheet(15), kBy), test::Fails(Errc::kInvalidArgument));
}

TEST(CommandJson, KnowsNoCommandButItsOwn) {
  for (const char* name : {"", "place_poi ", "PLACE_POI", "set", "delete_everything"})
    EXPECT_THAT(command_from_json(name, Json::object(), kBy), test::Fails(Errc::kNotFound)) << name;
  const auto unknown = command_from_json(std::string(10'000, 'x'), Json::object(), kBy);
  EXPECT_LT(unknown.error().message.size(), 100u) << "an error does not repeat what a stranger wrote at length";
}

TEST(LayoutOnTheWire, IsRefusedWhenItPointsOutsideOfItself) {
  const auto folder = std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/examples";
  const Json whole = test::read_json(folder / "layout.json");
  ASSERT_THAT(layout_from_json(whole), test::IsOk());
  for (const char* field : {"size", "walls"}) {
    Json without = whole;
    without.erase(field);
    EXPECT_FALSE(layout_from_json(without).ok()) << field;
  }
  for (const Json& size : {Json::array({0, 10}), Json::array({-1, 10}), Json::array({1e9, 1e9}), Json("big")}) {
    Json changed = whole;
    changed["size"] = size;
    EXPECT_FALSE(layout_from_json(changed).ok()) << size;
  }
  Json far = whole;
  far["walls"][0][0] = 1e300;
  EXPECT_FALSE(layout_from_json(far).ok());
}

}  // namespace
}  // namespace smokemap::server
