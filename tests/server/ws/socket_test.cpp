// The live socket as the network may treat it: halves, pieces, silence, and what the protocol of WebSockets allows.

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "core/random.hpp"
#include "server/wire/tiles.hpp"
#include "tests/server/app/running_server.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

using test::Browser;
using test::RawClient;
using test::RunningServer;

std::string hello_text(const std::string& token) {
  return R"({"type":"hello","version":1,"token":")" + token + R"(","epoch":0,"seq":0})";
}

/// One frame with any first byte, masked with a mask that does something.
std::string raw_frame(int first_byte, std::string payload) {
  const std::string mask = "\x11\x22\x33\x44";
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<char>(payload[i] ^ mask[i % 4]);
  return std::string(1, static_cast<char>(first_byte)) + static_cast<char>(0x80 | payload.size()) + mask + payload;
}

bool is_welcome(const Json& message) { return message["type"] == "welcome"; }

TEST(Socket, TakesMessagesInFragmentsAndByteByByte) {
  RunningServer running;
  const std::string token = running.pair("observer");
  RawClient client(running.port());
  ASSERT_EQ(client.upgrade(), 101);
  const std::string text = hello_text(token);
  client.send(raw_frame(0x01, text.substr(0, 20)));  // not the last
  client.send(raw_frame(0x89, "still there?"));      // a ping between fragments
  const std::string rest = raw_frame(0x80, text.substr(20));
  for (const char c : rest) client.send(std::string(1, c));
  const auto frame = client.next();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(is_welcome(Json::parse(frame->payload)));
}

TEST(Socket, EndsForFramesThatTheProtocolForbids) {
  RunningServer running;
  const std::string token = running.pair("observer");
  const auto ends_after = [&](const std::string& bytes) {
    RawClient client(running.port());
    if (client.upgrade() != 101) return false;
    client.send_frame(hello_text(token));
    client.send(bytes);
    while (const auto frame = client.next())
      if (frame->opcode == 8) return true;
    return true;  // closed without a word
  };
  EXPECT_TRUE(ends_after(raw_frame(0xc1, "{}"))) << "a reserved bit: we agreed on no compression";
  EXPECT_TRUE(ends_after(raw_frame(0x83, "{}"))) << "a reserved kind of frame";
  EXPECT_TRUE(ends_after(raw_frame(0x80, "{}"))) << "a continuation of nothing";
  EXPECT_TRUE(ends_after(raw_frame(0x81, "\xff\xfe{}"))) << "text that is no text";
  EXPECT_TRUE(ends_after(raw_frame(0x09, "x"))) << "a ping in fragments";
  EXPECT_TRUE(ends_after(std::string("\x88\x81\0\0\0\0x", 7))) << "a close with half a code";
}

TEST(Socket, RefusesAMessageThatIsTooLargeWithoutReadingItAll) {
  RunningServer running;
  const std::string token = running.pair("observer");
  RawClient client(running.port());
  ASSERT_EQ(client.upgrade(), 101);
  client.send_frame(hello_text(token));
  client.send_frame(R"({"type":"ping","t":1,"padding":")" + std::string(300'000, 'x') + "\"}");
  int code = 0;
  while (const auto frame = client.next())
    if (frame->opcode == 8) code = frame->close_code();
  EXPECT_TRUE(code == 4003 || code == 1009) << code;
}

TEST(Socket, IsNotOpenedWithoutTheHandshakeOfThisProtocol) {
  RunningServer running;
  const auto status_of = [&](const std::string& headers) {
    RawClient client(running.port());
    client.send("GET /api/live HTTP/1.1\r\nHost: " + client.host() + "\r\n" + headers + "\r\n");
    return client.answer().status;
  };
  const std::string upgrade = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Protocol: smokemap.v1\r\n";
  EXPECT_EQ(status_of(""), 404) << "a plain request";
  EXPECT_NE(status_of(upgrade), 101) << "without a key";
  EXPECT_NE(status_of(upgrade + "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 7\r\n"), 101);
  EXPECT_EQ(status_of(upgrade + "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"), 101);
}

TEST(Socket, ListsTheProtocolItTookAndOffersNoCompression) {
  RunningServer running;
  RawClient client(running.port());
  client.send("GET /api/live HTTP/1.1\r\nHost: " + client.host() +
              "\r\nUpgrade: websocket\r\nConnection: keep-alive, Upgrade\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: other, smokemap.v1\r\n"
              "Sec-WebSocket-Extensions: permessage-deflate\r\n\r\n");
  const auto answer = client.answer();
  EXPECT_EQ(answer.status, 101);
  EXPECT_EQ(answer.headers.at("sec-websocket-protocol"), "smokemap.v1");
  EXPECT_EQ(answer.headers.at("sec-websocket-accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_FALSE(answer.headers.contains("sec-websocket-extensions"));
}

TEST(Socket, ForgetsPeopleWhoseConnectionBreaks) {
  RunningServer running;
  Browser anna(running, running.pair("commander", "Anna"));
  {
    Browser bo(running, running.pair("firefighter", "Bo"));
    EXPECT_FALSE(anna.wait_for([](const Json& m) {
                       return m.value("part", "") == "people" && m.dump().find("Bo") != std::string::npos;
                     })
                     .is_null());
    bo.client.send("\x81");  // half a frame, then nothing
  }
  EXPECT_FALSE(
      anna.wait_for([](const Json& m) { return m.value("part", "") == "people" && !m["del"].empty(); }).is_null());
}

TEST(Socket, LimitsHowOftenOneDeviceIsConnected) {
  RunningServer running;
  const std::string token = running.pair("observer");
  std::vector<std::unique_ptr<Browser>> same;
  for (int i = 0; i < 8; ++i) {
    same.push_back(std::make_unique<Browser>(running, token));
    ASSERT_FALSE(same.back()->wait_for(is_welcome).is_null()) << i;
  }
  Browser ninth(running, token);
  int code = 0;
  while (const auto frame = ninth.client.next())
    if (frame->opcode == 8) code = frame->close_code();
  EXPECT_EQ(code, 4029);
  Browser other(running, running.pair("observer", "Bo"));
  EXPECT_FALSE(other.wait_for(is_welcome).is_null()) << "another device is welcome";
  same.pop_back();
  EXPECT_TRUE(test::eventually([&] {
    Browser again(running, token);
    return !again.wait_for(is_welcome).is_null();
  }));
}

TEST(Socket, SendsNobodyAnythingBeforeHello) {
  RunningServer running;
  std::mt19937_64 random(1);
  auto grid = std::make_shared<OccupancyGrid>(GridFrame{0.05, Eigen::Vector2d(-3, -3), 128, 128});
  for (auto& cell : grid->cells()) cell = static_cast<std::int8_t>(uniform_index(random, 101));
  running.engine().show(grid);
  RawClient silent(running.port());
  ASSERT_EQ(silent.upgrade(), 101);
  EXPECT_FALSE(silent.next(200)) << "a stranger learns nothing of the map";
  silent.send_frame(R"({"type":"ping","t":1})");
  const auto bye = silent.next();
  ASSERT_TRUE(bye);
  EXPECT_EQ(Json::parse(bye->payload)["type"], "bye");
}

TEST(Socket, ResumesAfterABrokenLinkWithoutTheWholeMap) {
  RunningServer running;
  const std::string token = running.pair("observer");
  std::mt19937_64 random(2);
  auto grid = std::make_shared<OccupancyGrid>(GridFrame{0.05, Eigen::Vector2d(-16, -16), 640, 640});
  for (auto& cell : grid->cells()) cell = static_cast<std::int8_t>(uniform_index(random, 101));
  running.engine().show(grid);
  std::map<TileKey, PackedTile> drawn;
  std::uint64_t seq = 0;
  std::uint32_t epoch = 0;
  std::size_t tiles = 0;
  const auto draw_until = [&](Browser& browser, const std::map<TileKey, PackedTile>& wanted) {
    while (drawn != wanted) {
      const auto frame = browser.client.next();
      ASSERT_TRUE(frame);
      if (frame->opcode != 2) continue;
      const auto decoded = decode_map_frame(frame->payload);
      ASSERT_THAT(decoded, test::IsOk());
      seq = decoded->header.seq, epoch = decoded->header.epoch;
      tiles += decoded->tiles.size();
      for (const auto& tile : decoded->tiles) drawn[tile.key] = tile.cells;
      if (decoded->type == 1) browser.client.send_frame(R"({"type":"ack","seq":1})");
    }
  };
  {
    Browser first(running, token);
    draw_until(first, merged_tiles(*grid, MergedMap{}, 0.05));
  }
  const std::size_t whole = tiles;
  auto changed = std::make_shared<OccupancyGrid>(*grid);
  changed->at({5, 5}) = static_cast<std::int8_t>(changed->at({5, 5}) > 50 ? 0 : 100);
  running.engine().show(changed);
  Browser again(running, token, R"(,"epoch":)" + std::to_string(epoch) + R"(,"seq":)" + std::to_string(seq));
  tiles = 0;
  draw_until(again, merged_tiles(*changed, MergedMap{}, 0.05));
  EXPECT_LE(tiles, 2u) << "of " << whole;
}

TEST(Socket, KeepsCommandsOfManyTabletsApart) {
  RunningServer running;
  std::vector<std::string> tokens;
  for (int i = 0; i < 6; ++i) tokens.push_back(running.pair("commander", "P" + std::to_string(i)));
  std::vector<std::thread> tablets;
  std::atomic<int> right = 0;
  for (int t = 0; t < 6; ++t)
    tablets.emplace_back([&, t] {
      Browser tablet(running, tokens[static_cast<std::size_t>(t)]);
      for (int i = 0; i < 10; ++i) {
        const std::string id = "t" + std::to_string(t) + "-" + std::to_string(i);
        tablet.command(id, "place_poi",
                       R"({"poi_id":")" + id + R"(","kind":"victim","frame":"map","p":[0,0],"label":""})");
        right += tablet.wait_for_answer(id).value("type", "") == "done";
      }
    });
  for (std::thread& tablet : tablets) tablet.join();
  EXPECT_EQ(right, 60);
  EXPECT_EQ(running.engine().count(), 60u);
}

}  // namespace
}  // namespace smokemap::server
