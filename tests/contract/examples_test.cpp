// proto/examples is read by the browser's tests too: whoever changes the wire hears of it here.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "server/wire/commands_json.hpp"
#include "server/wire/layout_json.hpp"
#include "server/wire/live_state.hpp"
#include "server/wire/messages.hpp"
#include "server/wire/tiles.hpp"
#include "tests/support/example_snapshot.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

namespace fs = std::filesystem;
const fs::path kProto = fs::path(SMOKEMAP_SOURCE_DIR) / "proto";

test::Schema schema(const std::string& name) { return test::Schema(kProto / "ws" / (name + ".schema.json")); }
Json example(const std::string& name) { return test::read_json(kProto / "examples" / (name + ".json")); }

std::vector<std::string> examples(const std::string& beginning) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kProto / "examples"))
    if (const std::string name = entry.path().stem().string(); name.starts_with(beginning)) names.push_back(name);
  EXPECT_FALSE(names.empty()) << beginning;
  return names;
}

/// Schema of an object of a part; `info` has one for each id.
std::string definition(const std::string& part, const std::string& id) { return part == "info" ? "info." + id : part; }

TEST(Examples, OfTheBrowserKeepTheirSchemaAndAreUnderstood) {
  const auto rules = schema("client");
  for (const std::string& name : examples("client_")) {
    const Json message = example(name);
    EXPECT_EQ(rules.complaint(message, rules.root()), "") << name;
    EXPECT_THAT(parse_client_message(message.dump()), test::IsOk()) << name;
  }
}

TEST(Examples, OfEveryCommandBecomeTheCommandAndComeBackUnchanged) {
  const auto rules = schema("commands");
  std::set<std::string> seen;
  for (const std::string& name : examples("client_command_")) {
    const Json message = example(name);
    const std::string word = message["name"];
    EXPECT_EQ(rules.complaint(message["data"], rules.def(word)), "") << name;
    const auto command = command_from_json(word, message["data"], {"Anna", 5});
    ASSERT_THAT(command, test::IsOk()) << name;
    EXPECT_EQ(command_name(*command), word);
    Json again = command_data(*command), expected = message["data"];
    if (word == "set_layout")  // where the sheet lay in the picture is the server's to remember, not the engine's
      for (const char* field : {"homography", "sheet_corners"}) expected["layout"].erase(field);
    EXPECT_EQ(again, expected) << name;
    seen.insert(word);
  }
  EXPECT_EQ(seen.size(), command_names().size()) << "a command has no example";
}

TEST(Examples, OfTheServerKeepTheirSchemas) {
  const auto rules = schema("server"), parts = schema("parts");
  std::set<std::string> shown;
  for (const std::string& name : examples("server_")) {
    const Json message = example(name);
    EXPECT_EQ(rules.complaint(message, rules.root()), "") << name;
    if (message["type"] != "delta") continue;
    const std::string part = message["part"];
    EXPECT_TRUE(part_of(part)) << part;
    shown.insert(part);
    for (const auto& [id, object] : message["set"].items())
      EXPECT_EQ(parts.complaint(object, parts.def(definition(part, id))), "") << name;
  }
  EXPECT_EQ(shown.size(), kPartCount) << "a part has no example";
}

TEST(Examples, OfMapFramesSayWhatTheyClaim) {
  for (const std::string& name : examples("map_frame")) {
    const Json described = example(name);
    const std::string hex = described["hex"];
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
      bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    const auto frame = decode_map_frame(bytes);
    ASSERT_THAT(frame, test::IsOk()) << name;
    EXPECT_EQ(frame->type, described["says"]["type"]);
    EXPECT_EQ(frame->header.epoch, described["says"]["epoch"]);
    EXPECT_EQ(frame->header.seq, described["says"]["seq"]);
    EXPECT_EQ(frame->tiles.size(), described["says"]["tiles"].size());
    if (frame->tiles.empty()) continue;
    EXPECT_EQ(frame->tiles[0].key, (TileKey{-1, 0}));
    EXPECT_EQ(code_at(frame->tiles[0].cells, 77, 77), 5);
    const PackedTile& packed = frame->tiles[1].cells;
    EXPECT_EQ(code_at(packed, 0, 0), 14);
    EXPECT_EQ(code_at(packed, 127, 127), 15);
    EXPECT_EQ(code_at(packed, 63, 5), 1);
    EXPECT_EQ(code_at(packed, 64, 5), 13);
    EXPECT_EQ(code_at(packed, 65, 5), 0);
  }
}

TEST(Examples, OfLayoutsAreUnderstoodAndComeBack) {
  const auto rules = schema("layout");
  for (const std::string& name : examples("layout")) {
    EXPECT_EQ(rules.complaint(example(name), rules.root()), "") << name;
    const auto layout = layout_from_json(example(name));
    ASSERT_THAT(layout, test::IsOk()) << name;
    EXPECT_EQ(rules.complaint(layout_to_json(*layout), rules.root()), "") << name;
  }
  EXPECT_EQ(layout_from_json(example("layout_minimal"))->corners.size(), 3u) << "touching ends are one corner";
}

TEST(Encoder, WritesWhatTheSchemasPromise) {
  const auto parts = schema("parts"), messages = schema("server");
  const Snapshot snapshot = test::example_snapshot();
  ServerView view{"/api/plans/x/rectified", {{"a1", {Point2(1, 2), Point2(3, 4)}}}};
  for (std::size_t i = 0; i < kPartCount; ++i) {
    const auto part = static_cast<Part>(i);
    const PartTable table = part == Part::kPeople
                                ? people_table({{"d1", {"Anna", "commander", "operate", Point2(1, 2), 5}}})
                                : part_table(part, snapshot, view);
    EXPECT_FALSE(table.empty()) << to_string(part);
    for (const auto& [id, text] : table)
      EXPECT_EQ(parts.complaint(Json::parse(text), parts.def(definition(to_string(part), id))), "") << to_string(part);
    for (const std::string& text : delta_messages(part, *advance(PartState{}, table), 0))
      EXPECT_EQ(messages.complaint(Json::parse(text), messages.root()), "");
  }
}

TEST(Encoder, WritesMessagesAsTheSchemasPromise) {
  const auto rules = schema("server");
  const Identity who{"d1", "Anna", Role::kCommander};
  for (const std::string& text :
       {welcome_message({who, 5, 6, 7, 0.05}), reply_message({"c1", 9, "", ""}),
        reply_message({"c1", std::nullopt, "forbidden", "no"}), reply_message({"c1", 4, "conflict", "no"}),
        pong_message(1.5, 2), ink_message(who, {"s", {Point2(1, 2)}}), bye_message("stop")})
    EXPECT_EQ(rules.complaint(Json::parse(text), rules.root()), "") << text;
}

}  // namespace
}  // namespace smokemap::server
