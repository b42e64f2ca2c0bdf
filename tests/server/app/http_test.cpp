#include <gtest/gtest.h>

#include <algorithm>

#include "tests/server/app/running_server.hpp"

namespace smokemap::server {
namespace {

using test::RawClient;
using test::RunningServer;

std::string error_code_of(const test::HttpAnswer& answer) {
  const Json json = Json::parse(answer.body, nullptr, false);
  return json.is_object() && json.contains("error") ? json["error"]["code"].get<std::string>() : "";
}

TEST(StaticPages, HaveTheirTypesAndAStrictPolicy) {
  RunningServer running;
  RawClient client(running.port());
  const auto page = client.ask("GET", "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(page.headers.at("cache-control"), "no-cache");
  const std::string policy = page.headers.at("content-security-policy");
  EXPECT_NE(policy.find("default-src 'self'"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_EQ(page.headers.at("x-content-type-options"), "nosniff");
  const auto script = client.ask("GET", "/assets/app-1234.js", "", "Accept-Encoding: gzip, br\r\n");
  EXPECT_EQ(script.headers.at("content-type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(script.headers.at("cache-control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(script.headers.at("content-encoding"), "gzip");
  EXPECT_LT(script.body.size(), 200u);
  EXPECT_EQ(client.ask("GET", "/", "", "If-None-Match: " + page.headers.at("etag") + "\r\n").status, 304);
  EXPECT_TRUE(client.ask("HEAD", "/").body.empty());
  EXPECT_EQ(client.ask("GET", "/operate/deep").body, page.body) << "the app's own addresses";
}

TEST(StaticPages, EndAtTheirFolder) {
  RunningServer running;
  RawClient client(running.port());
  for (const char* path : {"/../secret.txt", "/%2e%2e/secret.txt", "/assets/../../secret.txt", "/..%2fsecret.txt",
                           "/assets/..%5c..%5csecret.txt", "/%2fetc/passwd.txt", "/nothing.js"}) {
    const auto answer = client.ask("GET", path);
    EXPECT_EQ(answer.status, 404) << path;
    EXPECT_EQ(answer.body.find("secret\n"), std::string::npos);
  }
  EXPECT_EQ(client.ask("GET", "/%00").status, 400);
}

TEST(Http, RefusesForeignHostsAndOrigins) {
  RunningServer running;
  RawClient client(running.port());
  client.send("GET /api/health HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(client.answer().status, 421);
  const auto own = "Origin: http://" + client.host() + "\r\n";
  EXPECT_EQ(client.ask("GET", "/api/health", "", own).status, 200);
  EXPECT_EQ(client.ask("GET", "/api/health", "", "Origin: http://evil.example\r\n").status, 403);
  EXPECT_EQ(client.ask("GET", "/api/health", "", "Origin: null\r\n").status, 403);
}

TEST(Http, AsksForATokenAndARole) {
  RunningServer running;
  RawClient client(running.port());
  EXPECT_EQ(client.ask("GET", "/api/me").status, 401);
  EXPECT_EQ(client.ask("GET", "/api/me", "", RunningServer::bearer("wrong")).status, 401);
  const std::string observer = running.pair("observer");
  const auto me = client.ask("GET", "/api/me", "", RunningServer::bearer(observer));
  EXPECT_EQ(Json::parse(me.body)["role"], "observer");
  EXPECT_EQ(client.ask("POST", "/api/plans", "PNG", RunningServer::bearer(observer)).status, 403);
  RawClient again(running.port());
  EXPECT_EQ(again.ask("POST", "/api/sketch-photo", "PNG", RunningServer::bearer(observer)).status, 403);
  RawClient third(running.port());
  EXPECT_EQ(third.ask("GET", "/api/nothing").status, 404);
  EXPECT_EQ(third.ask("POST", "/api/health").status, 405);
}

TEST(Http, LocksPairingAfterWrongPins) {
  RunningServer running;
  RawClient client(running.port());
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(client.ask("POST", "/api/pair", R"({"pin":"000000","name":"x","role":"observer"})").status, 403);
  const auto locked = client.ask("POST", "/api/pair", R"({"pin":"123456","name":"x","role":"observer"})");
  EXPECT_EQ(locked.status, 429);
  EXPECT_EQ(error_code_of(locked), "locked");
}

TEST(Http, PairsWithoutPinInTheDemoOnThisMachine) {
  PairingParams demo;
  demo.loopback_without_pin = true;
  RunningServer running(demo);
  RawClient client(running.port());
  EXPECT_EQ(client.ask("POST", "/api/pair", R"({"name":"Anna","role":"commander"})").status, 200);
}

TEST(Plans, AreUploadedReadAndShown) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const auto uploaded = client.ask("POST", "/api/plans", "PNG of a plan", token);
  ASSERT_EQ(uploaded.status, 200) << uploaded.body;
  const std::string plan = Json::parse(uploaded.body)["plan_id"];
  EXPECT_EQ(client.ask("GET", "/api/plans/" + plan + "/picture", "", token).body, "PNG of a plan");
  const auto read = client.ask("POST", "/api/plans/" + plan + "/read",
                               R"({"corners":[[0,0],[9,0],[9,9],[0,9]],"metres_per_pixel":0.05})", token);
  ASSERT_EQ(read.status, 200) << read.body;
  const Json layout = Json::parse(read.body);
  EXPECT_EQ(layout["walls"].size(), 1u);
  EXPECT_EQ(layout["metres_per_pixel"], 0.05);
  EXPECT_EQ(layout["sheet_corners"][2], Json::parse("[9.0,9.0]"));
  const auto rectified = client.ask("GET", layout["rectified"], "", token);
  EXPECT_EQ(rectified.body, "PNG rectified");
  EXPECT_EQ(rectified.headers.at("content-type"), "image/png");
  EXPECT_EQ(client.ask("GET", "/api/plans/" + plan + "/rectified", "", token).body, "PNG rectified");
  EXPECT_EQ(client.ask("GET", "/api/plans/" + std::string(64, '0') + "/picture", "", token).status, 404);
  const auto sketch = client.ask("POST", "/api/sketch-photo", "PNG of a sketch", token);
  EXPECT_EQ(Json::parse(sketch.body)["strokes"][0]["kind"], "wall");
}

TEST(Plans, ThatAreSlowToDrawAreDrawnForWhoeverHasPatience) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const auto refused = client.ask("POST", "/api/plans", "PNG slow", token);
  EXPECT_EQ(refused.status, 413);
  EXPECT_EQ(Json::parse(refused.body)["error"]["code"], "too_large");
  EXPECT_EQ(client.ask("POST", "/api/plans?patience=0", "PNG slow", token).status, 413);
  EXPECT_EQ(client.ask("POST", "/api/plans?patience=1", "PNG slow", token).status, 200);
  EXPECT_EQ(client.ask("POST", "/api/plans?patience=much", "PNG slow", token).status, 400);
}

TEST(Plans, ThatCannotBeReadGiveOneClearError) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const auto gif = client.ask("POST", "/api/plans", "GIF89a", token);
  EXPECT_EQ(gif.status, 415);
  EXPECT_EQ(error_code_of(gif), "unsupported");
  EXPECT_EQ(client.ask("POST", "/api/plans?page=9", "PNG", token).status, 404);
  EXPECT_EQ(client.ask("POST", "/api/plans?page=x", "PNG", token).status, 400);
  const auto empty = client.ask("POST", "/api/plans", "PNG no walls", token);
  const std::string plan = Json::parse(empty.body)["plan_id"];
  const auto read = client.ask("POST", "/api/plans/" + plan + "/read", "", token);
  EXPECT_EQ(read.status, 422);
  EXPECT_EQ(error_code_of(read), "degenerate");
  EXPECT_EQ(client.ask("POST", "/api/plans/" + plan + "/read", R"({"corners":[[1,2]]})", token).status, 400);
}

TEST(Uploads, AreRefusedByTheirHeadWhenTooLarge) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  client.send("POST /api/plans HTTP/1.1\r\nHost: " + client.host() + "\r\nContent-Length: 99999999\r\n" + token +
              "\r\n");
  const auto answer = client.answer();
  EXPECT_EQ(answer.status, 413);
  EXPECT_EQ(error_code_of(answer), "too_large");
  RawClient chunked(running.port());
  chunked.send("POST /api/pair HTTP/1.1\r\nHost: " + chunked.host() + "\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 20; ++i) chunked.send("1000\r\n" + std::string(4096, 'x') + "\r\n");
  EXPECT_EQ(chunked.answer().status, 413);
}

TEST(Http, SurvivesRequestsThatAreNone) {
  RunningServer running;
  for (const std::string& text :
       {std::string("\0\0\0\0\r\n\r\n", 8), std::string("GET\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
        "GET /" + std::string(40'000, 'a') + " HTTP/1.1\r\n\r\n",
        "POST /api/pair HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(running.port()) +
            "\r\nContent-Length: -5\r\n\r\n"}) {
    RawClient client(running.port());
    client.send(text);
    const int status = client.answer().status;
    EXPECT_TRUE(status == 0 || (status >= 400 && status < 500)) << status;
  }
  RawClient client(running.port());
  EXPECT_EQ(client.ask("GET", "/api/health").status, 200);
}

TEST(Commands, AreTakenOverHttpToo) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("firefighter"));
  RawClient client(running.port());
  const std::string poi =
      R"({"id":"c1","name":"place_poi","data":{"poi_id":"p1","kind":"fire","frame":"map","p":[1,2]}})";
  const auto done = client.ask("POST", "/api/commands", poi, token);
  EXPECT_EQ(done.status, 200);
  EXPECT_EQ(Json::parse(done.body)["seq"], 1);
  const auto refused =
      client.ask("POST", "/api/commands", R"({"id":"c2","name":"cancel_goal","data":{"goal_id":"g"}})", token);
  EXPECT_EQ(refused.status, 403);
  const auto unknown = client.ask("POST", "/api/commands", R"({"id":"c3","name":"dance","data":{}})", token);
  EXPECT_EQ(unknown.status, 422);
  EXPECT_EQ(error_code_of(unknown), "not_found");
}

TEST(Ways, AreShownBeforeAnybodyIsSent) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("observer"));
  RawClient client(running.port());
  const Json there = Json::parse(client.ask("GET", "/api/way?robot=fox&x=3&y=-4e0", "", token).body);
  EXPECT_EQ(there["path"], Json::parse("[[0.0,0.0],[3.0,-4.0]]"));
  EXPECT_EQ(there["length_m"], 5);
  EXPECT_EQ(there["unseen_m"], 2.5);
  const Json nowhere = Json::parse(client.ask("GET", "/api/way?robot=fox&x=101&y=0", "", token).body);
  EXPECT_EQ(nowhere["path"], Json::array());
  EXPECT_EQ(nowhere["reason"], "no way there is known");
  EXPECT_EQ(client.ask("GET", "/api/way?robot=nobody&x=1&y=1", "", token).status, 404);
  for (const char* query : {"", "?robot=fox", "?robot=fox&x=1", "?x=1&y=1", "?robot=fox&x=1&y=", "?robot=fox&x=1&y=2m",
                            "?robot=fox&x=inf&y=1", "?robot=fox&x=nan&y=1", "?robot=fox&x=1e6&y=1"})
    EXPECT_EQ(client.ask("GET", std::string("/api/way") + query, "", token).status, 400) << query;
  EXPECT_EQ(client.ask("GET", "/api/way?robot=fox&x=1&y=1").status, 401);
}

TEST(Events, AreListedAndExportedAndLookedBackTo) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  for (int i = 1; i <= 3; ++i)
    client.ask("POST", "/api/commands",
               R"({"id":"c)" + std::to_string(i) + R"(","name":"place_poi","data":{"poi_id":"p)" + std::to_string(i) +
                   R"(","kind":"fire","frame":"map","p":[1,2]}})",
               token);
  const Json page = Json::parse(client.ask("GET", "/api/events?from=2&limit=1", "", token).body);
  ASSERT_EQ(page["events"].size(), 1u);
  EXPECT_EQ(page["events"][0]["data"]["poi_id"], "p2");
  EXPECT_EQ(page["events"][0]["person"], "Anna");
  EXPECT_EQ(page["next"], 3);
  const auto lines = client.ask("GET", "/api/export/events.jsonl", "", token).body;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 3);
  const Json past = Json::parse(client.ask("GET", "/api/snapshot?at=2", "", token).body);
  EXPECT_EQ(past["parts"]["pois"].size(), 2u);
  EXPECT_EQ(client.ask("GET", "/api/snapshot", "", token).status, 400);
  EXPECT_EQ(client.ask("GET", "/api/export/map.pgm", "", token).status, 404) << "nothing has been seen";
  running.engine().show(std::make_shared<OccupancyGrid>(GridFrame{0.05, Eigen::Vector2d::Zero(), 3, 2}, 0));
  EXPECT_EQ(client.ask("GET", "/api/export/map.pgm", "", token).body, "P5\n3 2\n255\n" + std::string(6, '\xfe'));
  EXPECT_EQ(client.ask("GET", "/api/export/walls.geojson", "", token).status, 200);
  EXPECT_EQ(client.ask("GET", "/api/export/passwd", "", token).status, 404);
}

TEST(Events, APastWithoutAnchorsAndWithoutThePlansPictureWasShown) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const auto command = [&](const std::string& id, const std::string& name, const std::string& data) {
    return client
        .ask("POST", "/api/commands", R"({"id":")" + id + R"(","name":")" + name + R"(","data":)" + data + "}", token)
        .status;
  };
  ASSERT_EQ(command("c1", "add_anchor", R"({"id":"a1","px":[1,2],"map":[3,4]})"), 200);
  ASSERT_EQ(command("c2", "add_anchor", R"({"id":"a2","px":[5,6],"map":[7,8]})"), 200);
  ASSERT_EQ(command("c3", "remove_anchor", R"({"id":"a1"})"), 200);
  const auto anchors_at = [&](int seq) {
    return Json::parse(
        client.ask("GET", "/api/snapshot?at=" + std::to_string(seq), "", token).body)["parts"]["anchors"];
  };
  EXPECT_EQ(anchors_at(1), (Json{{"a1", {{"px", {1.0, 2.0}}, {"map", {3.0, 4.0}}}}}));
  EXPECT_EQ(anchors_at(2).size(), 2u);
  EXPECT_TRUE(anchors_at(3).contains("a2") && !anchors_at(3).contains("a1"));
}

}  // namespace
}  // namespace smokemap::server
