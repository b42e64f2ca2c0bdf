#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>

#include "core/random.hpp"
#include "server/wire/commands_json.hpp"
#include "server/wire/tiles.hpp"
#include "tests/server/app/running_server.hpp"
#include "tests/support/json_schema.hpp"

namespace smokemap::server {
namespace {

using test::Browser;
using test::RawClient;
using test::RunningServer;

std::string poi(const std::string& id) {
  return R"({"poi_id":")" + id + R"(","kind":"gas_bottle","frame":"map","p":[1.5,2],"label":"two"})";
}

TEST(LiveSocket, WelcomesWithWhatTheClientNeeds) {
  RunningServer running;
  Browser browser(running, running.pair("firefighter", "Bo"));
  const Json welcome = browser.wait_for([](const Json& m) { return m["type"] == "welcome"; });
  ASSERT_FALSE(welcome.is_null());
  EXPECT_EQ(welcome["role"], "firefighter");
  EXPECT_EQ(welcome["name"], "Bo");
  EXPECT_EQ(welcome["tile_size"], 128);
  EXPECT_GT(welcome["epoch"], 1'000'000);
}

TEST(LiveSocket, IsRefusedToForeignPagesAndOtherProtocols) {
  RunningServer running;
  const std::string protocol = "Sec-WebSocket-Protocol: smokemap.v1\r\n";
  EXPECT_EQ(RawClient(running.port()).upgrade("/api/live", protocol + "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(RawClient(running.port()).upgrade("/api/live", protocol, "evil.example"), 421);
  EXPECT_EQ(RawClient(running.port()).upgrade("/api/other", protocol), 404);
  EXPECT_NE(RawClient(running.port()).upgrade("/api/live", ""), 101);
  RawClient own(running.port());
  EXPECT_EQ(own.upgrade("/api/live", protocol + "Origin: http://" + own.host() + "\r\n"), 101);
}

TEST(LiveSocket, ClosesWithTheCodeThatSaysWhy) {
  RunningServer running;
  const std::string token = running.pair("observer");
  const auto closing = [&](const std::function<void(RawClient&)>& misbehave, bool hello = true) {
    RawClient client(running.port());
    EXPECT_EQ(client.upgrade(), 101);
    if (hello) client.send_frame(R"({"type":"hello","version":1,"token":")" + token + R"(","epoch":0,"seq":0})");
    misbehave(client);
    while (const auto frame = client.next())
      if (frame->opcode == 8) return frame->close_code();
    return 0;
  };
  EXPECT_EQ(closing([](RawClient& c) { c.send_frame(R"({"type":"hello","version":1,"token":"x","epoch":0,"seq":0})"); },
                    false),
            4001);
  EXPECT_EQ(closing([](RawClient& c) { c.send_frame("{"); }), 4003);
  EXPECT_EQ(closing([](RawClient& c) { c.send_frame("\x01\x02", 2); }), 4003);
  EXPECT_EQ(closing([](RawClient& c) { c.send_frame(std::string(5000, '[')); }), 4003);
  EXPECT_EQ(closing([](RawClient& c) {
              for (int i = 0; i < 1000; ++i) c.send_frame(R"({"type":"ping","t":1})");
            }),
            4029);
}

TEST(LiveSocket, SurvivesFramesThatAreNone) {
  RunningServer running;
  const std::string token = running.pair("observer");
  std::mt19937_64 random(1);
  for (int i = 0; i < 40; ++i) {
    RawClient client(running.port());
    client.upgrade();
    std::string noise;
    for (std::uint64_t n = uniform_index(random, 200); n > 0; --n)
      noise += static_cast<char>(uniform_index(random, 256));
    if (i % 3 == 0) client.send_frame(noise);
    if (i % 3 == 1) client.send_frame(R"({"type":"ping","t":1})", 1, false);  // unmasked
    if (i % 3 == 2) client.send(noise);
  }
  RawClient big(running.port());
  big.upgrade();
  big.send(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14));  // promises 2^63 bytes
  Browser good(running, token);
  EXPECT_FALSE(good.wait_for([](const Json& m) { return m["type"] == "welcome"; }).is_null());
}

TEST(LiveSocket, ShowsEverybodyWhatOneMarks) {
  RunningServer running;
  Browser anna(running, running.pair("commander", "Anna")), bo(running, running.pair("firefighter", "Bo"));
  anna.command("c1", "place_poi", poi("p1"));
  EXPECT_EQ(anna.wait_for_answer("c1")["type"], "done");
  const Json seen = bo.wait_for_object("pois", "p1");
  ASSERT_FALSE(seen.is_null());
  EXPECT_EQ(seen["author"], "Anna");
  EXPECT_EQ(seen["label"], "two");
  bo.command("c2", "place_poi", poi("p2"));
  EXPECT_EQ(anna.wait_for_object("pois", "p2")["author"], "Bo");
  bo.client.send_frame(R"({"type":"ink","stroke_id":"s","points":[[1,2]]})");
  EXPECT_EQ(anna.wait_for([](const Json& m) { return m["type"] == "ink"; })["name"], "Bo");
}

TEST(LiveSocket, ShowsWhoIsThereAndWhoLeft) {
  RunningServer running;
  Browser anna(running, running.pair("commander", "Anna"));
  {
    Browser bo(running, running.pair("firefighter", "Bo"));
    bo.client.send_frame(R"({"type":"presence","mode":"sketch","p":[1,2]})");
    EXPECT_FALSE(anna.wait_for([](const Json& m) {
                       return m.value("part", "") == "people" && m.dump().find("Bo") != std::string::npos;
                     })
                     .is_null());
  }
  EXPECT_FALSE(
      anna.wait_for([](const Json& m) { return m.value("part", "") == "people" && !m["del"].empty(); }).is_null());
}

TEST(LiveSocket, AnswersEveryCommandOfEveryRoleAsTheTableSays) {
  RunningServer running;
  const auto folder = std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto/examples";
  const std::set<std::string> of_firefighters{"add_stroke", "erase_stroke", "clear_sketch", "set_sketch_sheet",
                                              "judge_pair", "place_poi",    "remove_poi"};
  for (const char* role : {"observer", "firefighter", "commander"}) {
    Browser browser(running, running.pair(role));
    for (const char* name : command_names()) {
      const Json example = test::read_json(folder / ("client_command_" + std::string(name) + ".json"));
      const std::string id = std::string(role) + name;
      browser.command(id, name, example["data"].dump());
      const Json answer = browser.wait_for_answer(id);
      const bool allowed = std::string(role) == "commander" || std::string(name) == "emergency_stop" ||
                           (std::string(role) == "firefighter" && of_firefighters.contains(name));
      EXPECT_EQ(answer["type"], allowed ? "done" : "refused") << id << answer;
      if (allowed) continue;
      EXPECT_EQ(answer["code"], "forbidden") << id;
    }
    browser.command(std::string(role) + "release", "emergency_stop", R"({"robot":"","engaged":false})");
    EXPECT_EQ(browser.wait_for_answer(std::string(role) + "release")["type"],
              std::string(role) == "commander" ? "done" : "refused");
  }
}

TEST(LiveSocket, CarriesOutACommandOnceHoweverOftenItComes) {
  RunningServer running;
  const std::string token = running.pair("commander");
  for (int i = 0; i < 3; ++i) {
    Browser browser(running, token);
    browser.command("same", "place_poi", poi("p1"));
    const Json answer = browser.wait_for_answer("same");
    EXPECT_EQ(answer["type"], "done");
    EXPECT_EQ(answer["seq"], 1);
  }
  EXPECT_EQ(running.engine().count(), 1u);
  Browser other(running, running.pair("commander", "Bo"));
  other.command("same", "place_poi", poi("p9"));
  EXPECT_EQ(other.wait_for_answer("same")["code"], "conflict") << "nobody gets the answer to another's command";
}

TEST(LiveSocket, RefusesWhatCameTooLateAndRemembersWhatTheEngineRefused) {
  RunningServer running;
  Browser browser(running, running.pair("commander"));
  browser.command("late", "place_poi", poi("p1"), R"(,"expires_ms":1000)");
  const Json late = browser.wait_for_answer("late");
  EXPECT_EQ(late["code"], "cancelled");
  EXPECT_FALSE(late.contains("seq")) << "nothing was stored";
  const std::string goal = R"({"goal_id":"g","robot":"nobody","frame":"map","p":[1,2]})";
  for (int i = 0; i < 2; ++i) {
    browser.command("goal", "set_goal", goal);
    const Json refused = browser.wait_for_answer("goal");
    EXPECT_EQ(refused["type"], "refused");
    EXPECT_EQ(refused["code"], "not_found");
    EXPECT_EQ(refused["message"], "no robot is called nobody");
    EXPECT_EQ(refused["seq"], 1);
  }
}

TEST(LiveSocket, LosesNothingAcknowledgedWhenTheServerIsKilled) {
  RunningServer running;
  const std::string token = running.pair("commander");
  Browser browser(running, token);
  for (int i = 0; i < 20; ++i) {
    const std::string id = "k" + std::to_string(i);
    browser.command(id, "place_poi", poi(id));
    ASSERT_EQ(browser.wait_for_answer(id)["type"], "done");
  }
  browser.command("refused", "set_goal", R"({"goal_id":"g","robot":"nobody","frame":"map","p":[1,2]})");
  browser.wait_for_answer("refused");
  const std::string copy = running.folder().path() + "/as-after-kill";  // the disk at this moment, nothing closed
  std::filesystem::copy(running.data_dir(), copy, std::filesystem::copy_options::recursive);
  running.stop();
  running.start(copy);
  EXPECT_EQ(running.engine().count(), 20u);
  for (const auto& [command, origin] : running.engine().applied()) EXPECT_EQ(origin, Origin::kHistory);
  Browser again(running, token);  // the token still counts
  EXPECT_EQ(again.wait_for_object("pois", "k19")["author"], "Anna");
  again.command("k3", "place_poi", poi("k3"));
  EXPECT_EQ(again.wait_for_answer("k3")["seq"], 4) << "and so does what was done before";
}

TEST(LiveSocket, SaysGoodbyeWhenTheServerStops) {
  RunningServer running;
  Browser browser(running, running.pair("observer"));
  browser.wait_for([](const Json& m) { return m["type"] == "welcome"; });
  running.server().stop();
  int code = 0;
  while (const auto frame = browser.client.next())
    if (frame->opcode == 8) code = frame->close_code();
  EXPECT_EQ(code, 1001);
}

std::shared_ptr<OccupancyGrid> noise(std::mt19937_64& random) {
  auto grid = std::make_shared<OccupancyGrid>(GridFrame{0.05, Eigen::Vector2d(-16, -16), 640, 640});
  for (auto& cell : grid->cells()) cell = static_cast<std::int8_t>(uniform_index(random, 101));
  return grid;
}

TEST(LiveSocket, GivesASlowBrowserTheNewestMapAndSlowsNobody) {
  RunningServer running;
  const std::string token = running.pair("observer");
  std::mt19937_64 random(7);
  Browser slow(running, token, R"(,"epoch":0,"seq":0)", 8 * 1024), quick(running, token);
  auto grid = noise(random);
  std::map<TileKey, PackedTile> shown;
  for (int round = 0; round < 4; ++round) {
    auto next = std::make_shared<OccupancyGrid>(*grid);
    for (int i = 0; i < 1000; ++i)
      next->cells()[uniform_index(random, next->cells().size())] = static_cast<std::int8_t>(round);
    grid = next;
    running.engine().show(grid);
    // The quick one draws everything of this round while the slow one reads nothing.
    const auto wanted = merged_tiles(*grid, MergedMap{}, 0.05);
    while (shown != wanted) {
      const auto frame = quick.client.next();
      ASSERT_TRUE(frame) << "the quick browser waits in round " << round;
      if (frame->opcode != 2) continue;
      const auto decoded = decode_map_frame(frame->payload);
      ASSERT_THAT(decoded, test::IsOk());
      for (const auto& tile : decoded->tiles) shown[tile.key] = tile.cells;
      if (decoded->type == 1) quick.client.send_frame(R"({"type":"ack","seq":1})");
    }
  }
  std::map<TileKey, PackedTile> late;
  const auto wanted = merged_tiles(*grid, MergedMap{}, 0.05);
  std::size_t bytes = 0;
  while (late != wanted) {
    const auto frame = slow.client.next();
    ASSERT_TRUE(frame) << "the slow browser never caught up";
    if (frame->opcode != 2) continue;
    bytes += frame->payload.size();
    const auto decoded = decode_map_frame(frame->payload);
    ASSERT_THAT(decoded, test::IsOk());
    for (const auto& tile : decoded->tiles) late[tile.key] = tile.cells;
    if (decoded->type == 1) slow.client.send_frame(R"({"type":"ack","seq":1})");
  }
  EXPECT_LT(bytes, 640u * 640 / 2 * 2) << "one map and a little, not four";
}

}  // namespace
}  // namespace smokemap::server
