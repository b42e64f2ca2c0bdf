#include "server/http/message.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "core/random.hpp"
#include "recording/map_server.hpp"
#include "server/http/exports.hpp"
#include "tests/support/example_snapshot.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::server {
namespace {

std::string percent_encoded(const std::string& text) {
  constexpr const char* kDigits = "0123456789abcdefABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    encoded += '%';
    encoded += kDigits[byte >> 4];
    encoded += kDigits[byte & 15];
  }
  return encoded;
}

std::string random_bytes(std::mt19937_64& random, std::size_t most) {
  std::string bytes;
  for (std::uint64_t n = uniform_index(random, most); n > 0; --n)
    bytes += static_cast<char>(1 + uniform_index(random, 255));
  return bytes;
}

TEST(PercentDecoding, UndoesEncodingForAnyBytes) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const std::string text = random_bytes(random, 40);
    EXPECT_EQ(percent_decoded(percent_encoded(text)), text);
  }
  EXPECT_EQ(percent_decoded("%41%4A%4a"), "AJJ");
  EXPECT_EQ(percent_decoded("a+b"), "a+b") << "a plus is a plus in a path";
}

TEST(PercentDecoding, RefusesHalfEscapesAndNulBytes) {
  for (const char* text : {"%", "%4", "a%", "%g0", "%0g", "%00", "x%00y", "%-1"})
    EXPECT_EQ(percent_decoded(text), std::nullopt) << text;
}

TEST(Targets, SurviveAnyBytesAndNeverGiveANulByte) {
  std::mt19937_64 random(2);
  int taken = 0;
  for (int i = 0; i < 2000; ++i) {
    Request request;
    const std::string target = "/" + random_bytes(random, 30);
    if (!parse_target(target, request)) continue;
    ++taken;
    EXPECT_EQ(request.path.find('\0'), std::string::npos);
    EXPECT_TRUE(request.path.starts_with('/'));
    EXPECT_EQ(request.path.find('?'), std::string::npos) << target;
  }
  EXPECT_GT(taken, 100);
}

TEST(Targets, KeepTheLastOfRepeatedParametersAndDropFragments) {
  Request request;
  ASSERT_TRUE(parse_target("/p?a=1&a=2&b=x=y#a=3", request));
  EXPECT_EQ(request.path, "/p");
  EXPECT_EQ(request.query.at("a"), "2");
  EXPECT_EQ(request.query.at("b"), "x=y");
  EXPECT_EQ(request.query.size(), 2u);
}

TEST(Errors, HaveTheStatusThatFitsAndTheCodeThatTheWirePromises) {
  const std::map<Errc, int> expected{{Errc::kInvalidArgument, 400}, {Errc::kCorrupt, 400},     {Errc::kDegenerate, 422},
                                     {Errc::kNotConverged, 422},    {Errc::kUnsupported, 415}, {Errc::kTooLarge, 413},
                                     {Errc::kNotFound, 404},        {Errc::kConflict, 409},    {Errc::kCancelled, 409},
                                     {Errc::kForbidden, 403},       {Errc::kIo, 507}};
  for (const auto& [code, status] : expected) {
    const Response response = error_response(fail(code, "because"));
    EXPECT_EQ(response.status, status) << to_string(code);
    const Json body = Json::parse(*response.body);
    EXPECT_EQ(body["error"]["code"], to_string(code));
    EXPECT_EQ(body["error"]["message"], "because");
  }
}

TEST(JsonAnswers, AreNeverCachedAndHoldOnlyUtf8) {
  const Response response = json_response({{"text", "\xff\xfe"}});
  EXPECT_EQ(response.content_type, "application/json");
  EXPECT_NE(std::find(response.headers.begin(), response.headers.end(),
                      std::pair<std::string, std::string>("Cache-Control", "no-store")),
            response.headers.end());
  EXPECT_TRUE(Json::parse(*response.body, nullptr, false).is_object());
}

TEST(SecurityHeaders, LetNothingInThatIsNotOurs) {
  std::map<std::string, std::string> headers(security_headers().begin(), security_headers().end());
  const std::string& policy = headers.at("Content-Security-Policy");
  for (const char* rule : {"default-src 'self'", "object-src 'none'", "base-uri 'none'", "frame-ancestors 'none'",
                           "form-action 'none'", "connect-src 'self'"})
    EXPECT_NE(policy.find(rule), std::string::npos) << rule;
  for (const char* hole : {"unsafe", "http:", "https:", "*"}) EXPECT_EQ(policy.find(hole), std::string::npos) << hole;
  EXPECT_EQ(headers.at("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(headers.at("Referrer-Policy"), "no-referrer");
}

TEST(MapExports, SayEveryCellAndWhereItLies) {
  Snapshot snapshot = test::example_snapshot();
  auto grid = std::make_shared<OccupancyGrid>(GridFrame{0.25, Eigen::Vector2d(-2, 3), 3, 2});
  grid->at({0, 0}) = 0, grid->at({1, 0}) = 50, grid->at({2, 0}) = 100;
  grid->at({0, 1}) = 10, grid->at({1, 1}) = -1, grid->at({2, 1}) = 90;
  snapshot.sensed = grid;
  const std::string pgm = *export_file("map.pgm", snapshot).body;
  ASSERT_EQ(pgm.substr(0, 11), "P5\n3 2\n255\n");
  const auto pixel = [&](int column, int row) { return static_cast<unsigned char>(pgm[11 + 3 * row + column]); };
  EXPECT_EQ(pixel(0, 1), 254) << "row 0 of the grid is the lowest of the picture";
  EXPECT_EQ(pixel(1, 1), 127);
  EXPECT_EQ(pixel(2, 1), 0);
  EXPECT_EQ(pixel(1, 0), 205) << "unknown";
  EXPECT_GT(pixel(0, 0), pixel(2, 0));
  const std::string yaml = *export_file("map.yaml", snapshot).body;
  EXPECT_NE(yaml.find("resolution: 0.250000\n"), std::string::npos);
  EXPECT_NE(yaml.find("origin: [-2.000000, 3.000000, 0.0]\n"), std::string::npos);
}

TEST(MapExports, AreNotFoundWhenNothingWasSeenOrTheNameIsNoneOfOurs) {
  Snapshot snapshot = test::example_snapshot();
  for (const char* name : {"", "map", "map.pgm/", "../map.pgm", "MAP.PGM", "smokemap.db"})
    EXPECT_EQ(export_file(name, snapshot).status, 404) << name;
  snapshot.sensed = std::make_shared<OccupancyGrid>();
  EXPECT_EQ(export_file("map.pgm", snapshot).status, 404);
  EXPECT_EQ(export_file("merged.json", snapshot).status, 200) << "walls are known without a scan";
}

TEST(WallExports, CarryStateAndConfidenceOfEveryWall) {
  const Snapshot snapshot = test::example_snapshot();
  const Json features = Json::parse(*export_file("walls.geojson", snapshot).body)["features"];
  ASSERT_EQ(features.size(), snapshot.merged->walls.size());
  std::set<std::string> states;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const MergedWall& wall = snapshot.merged->walls[i];
    const Json& feature = features[i];
    states.insert(feature["properties"]["state"].get<std::string>());
    EXPECT_EQ(feature["geometry"]["type"], "LineString");
    EXPECT_NEAR(feature["geometry"]["coordinates"][0][0].get<double>(), wall.segment_map.a.x(), 1e-3);
    EXPECT_NEAR(feature["geometry"]["coordinates"][1][1].get<double>(), wall.segment_map.b.y(), 1e-3);
    EXPECT_NEAR(feature["properties"]["confidence"].get<double>(), wall.confidence, 1e-3);
  }
  EXPECT_EQ(states, (std::set<std::string>{"confirmed", "missing", "new"}));
}

TEST(QueryNumbers, AreWholeNumbersAndNothingElse) {
  const auto number = [](const std::string& text) {
    Request request;
    request.query["n"] = text;
    return query_number(request, "n");
  };
  EXPECT_EQ(number("0"), 0);
  EXPECT_EQ(number("-7"), -7);
  EXPECT_EQ(number("9223372036854775807"), 9223372036854775807);
  for (const char* text : {"", " 1", "1 ", "2abc", "+1", "0x1", "1.5", "1e3", "9223372036854775808", "--1"})
    EXPECT_EQ(number(text), std::nullopt) << text;
  EXPECT_EQ(query_number(Request{}, "n"), std::nullopt);
}

TEST(Targets, SplitAsManyParametersAsThereAre) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 200; ++i) {
    std::map<std::string, std::string> sent;
    std::string target = percent_encoded("/path " + random_bytes(random, 10)) + "?";
    target.replace(0, 3, "/");  // the first slash is no part of a name
    for (std::uint64_t n = uniform_index(random, 6); n > 0; --n) {
      const std::string key = "k" + std::to_string(n), value = random_bytes(random, 12);
      sent[key] = value;
      target += key + "=" + percent_encoded(value) + "&";
    }
    Request request;
    ASSERT_TRUE(parse_target(target, request)) << target;
    EXPECT_EQ(request.query.size(), sent.size());
    for (const auto& [key, value] : sent) EXPECT_EQ(request.query.at(key), value);
  }
}

TEST(Targets, OfOtherFormsAreNoneOfOurs) {
  Request request;
  for (const char* target : {"*", "http://127.0.0.1/", "127.0.0.1:80", "?a=1", "#", " /"})
    EXPECT_FALSE(parse_target(target, request)) << target;
  ASSERT_TRUE(parse_target("/?&&=&a=&=b", request));
  EXPECT_EQ(request.path, "/");
  EXPECT_EQ(request.query.at("a"), "");
  EXPECT_EQ(request.query.at(""), "b");
}

TEST(MapExports, AreReadBackByTheReaderOfRosMaps) {
  const test::TemporaryFolder folder;
  Snapshot snapshot = test::example_snapshot();
  auto grid = std::make_shared<OccupancyGrid>(GridFrame{0.05, Eigen::Vector2d(-1.25, 3.5), 23, 17});
  std::mt19937_64 random(7);
  for (auto& cell : grid->cells()) cell = static_cast<std::int8_t>(static_cast<int>(uniform_index(random, 102)) - 1);
  snapshot.sensed = grid;
  for (const char* name : {"map.pgm", "map.yaml"})
    std::ofstream(folder.path() + "/" + name, std::ios::binary) << *export_file(name, snapshot).body;
  const auto read = read_map(folder.path() + "/map.yaml");
  ASSERT_THAT(read, test::IsOk());
  ASSERT_EQ(read->frame().width_cells, 23);
  ASSERT_EQ(read->frame().height_cells, 17);
  EXPECT_NEAR(read->frame().resolution_m, 0.05, 1e-9);
  EXPECT_NEAR((read->frame().origin - grid->frame().origin).norm(), 0, 1e-6);
  for (std::size_t i = 0; i < grid->cells().size(); ++i) {
    const int sent = grid->cells()[i], got = read->cells()[i];
    const bool free = sent >= 0 && sent <= 18, occupied = sent >= 67, unknown = sent < 0;
    EXPECT_TRUE(!unknown || got == -1) << got;
    EXPECT_TRUE(!free || got == 0) << sent << " became " << got;
    EXPECT_TRUE(!occupied || got == 100) << sent << " became " << got;
  }
}

}  // namespace
}  // namespace smokemap::server
