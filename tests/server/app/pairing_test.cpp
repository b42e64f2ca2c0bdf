// Who gets in: guessing PINs over many connections, and what a locked door means for those who are in already.

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "tests/server/app/running_server.hpp"
#include "tests/support/eventually.hpp"

namespace smokemap::server {
namespace {

using test::Browser;
using test::RawClient;
using test::RunningServer;

std::string pair_request(const std::string& pin, const std::string& role = "commander") {
  return R"({"pin":")" + pin + R"(","name":"Mallory","role":")" + role + "\"}";
}

TEST(Guessing, OverManyConnectionsGetsNoMoreTriesThanOverOne) {
  RunningServer running;
  std::vector<std::thread> guessers;
  std::atomic<int> wrong = 0, locked = 0, in = 0, other = 0;
  for (int g = 0; g < 6; ++g)
    guessers.emplace_back([&, g] {
      RawClient client(running.port());
      for (int i = 0; i < 20; ++i) {
        const int status = client.ask("POST", "/api/pair", pair_request(std::to_string(200'000 + g * 20 + i))).status;
        ++(status == 403 ? wrong : status == 429 ? locked : status == 200 ? in : other);
      }
    });
  for (std::thread& guesser : guessers) guesser.join();
  EXPECT_EQ(wrong, 5);
  EXPECT_EQ(locked, 115);
  EXPECT_EQ(in, 0);
  EXPECT_EQ(other, 0);
}

TEST(Guessing, LocksTheDoorButNobodyWhoIsIn) {
  RunningServer running;
  const std::string token = running.pair("commander");
  Browser inside(running, token);
  RawClient guesser(running.port());
  for (int i = 0; i < 5; ++i) guesser.ask("POST", "/api/pair", pair_request("00000" + std::to_string(i)));
  EXPECT_EQ(guesser.ask("POST", "/api/pair", pair_request("123456")).status, 429) << "the right one too";
  EXPECT_EQ(guesser.ask("GET", "/api/me", "", RunningServer::bearer(token)).status, 200);
  inside.command("c1", "place_poi", R"({"poi_id":"p","kind":"fire","frame":"map","p":[1,2]})");
  EXPECT_EQ(inside.wait_for_answer("c1")["type"], "done");
}

TEST(Guessing, MayGoOnAfterTheLockAtFiveTriesATime) {
  PairingParams quick;
  quick.lock = from_seconds(0.05);
  RunningServer running(quick);
  RawClient client(running.port());
  for (int i = 0; i < 5; ++i) client.ask("POST", "/api/pair", pair_request("000000"));
  EXPECT_TRUE(test::eventually(
      [&] { return client.ask("POST", "/api/pair", pair_request("123456", "observer")).status == 200; }));
}

TEST(PairRequests, ThatAreNoneCostNoTry) {
  RunningServer running;
  RawClient client(running.port());
  for (const std::string& body :
       {std::string("{"), std::string("{}"), std::string(R"({"pin":123456,"name":"x","role":"observer"})"),
        std::string(R"({"pin":"123456","role":"observer"})"), std::string(R"({"pin":"1","name":"x","role":"king"})"),
        R"({"pin":")" + std::string(100, '1') + R"(","name":"x","role":"observer"})"})
    EXPECT_EQ(client.ask("POST", "/api/pair", body).status, 400) << body;
  EXPECT_EQ(client.ask("POST", "/api/pair", pair_request("123456", "observer")).status, 200);
}

TEST(Tokens, OfOthersAreNotGuessedFromOnesOwn) {
  RunningServer running;
  const std::string token = running.pair("observer");
  ASSERT_EQ(token.size(), 32u);
  RawClient client(running.port());
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string near = token;
    near[i] = near[i] == '0' ? '1' : '0';
    EXPECT_EQ(client.ask("GET", "/api/me", "", RunningServer::bearer(near)).status, 401);
  }
  for (const std::string& other : {token.substr(1), token + "0", std::string(), "Bearer " + token})
    EXPECT_EQ(client.ask("GET", "/api/me", "", RunningServer::bearer(other)).status, 401) << other;
  EXPECT_EQ(client.ask("GET", "/api/me", "", "Authorization: Basic " + token + "\r\n").status, 401);
}

TEST(BrokenStorage, IsToldAndNothingIsAcknowledged) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const std::string plan =
      Json::parse(client.ask("POST", "/api/plans", "PNG kept", token).body)["plan_id"].get<std::string>();
  std::filesystem::remove_all(running.data_dir() + "/files");
  std::ofstream(running.data_dir() + "/files") << "in the way";  // no file can be put there
  const auto refused = client.ask("POST", "/api/plans", "PNG lost", token);
  EXPECT_EQ(refused.status, 507);
  EXPECT_EQ(Json::parse(refused.body)["error"]["code"], "io");
  EXPECT_EQ(client.ask("GET", "/api/plans/" + plan + "/picture", "", token).status, 404) << "gone, and said so";
  EXPECT_EQ(
      client
          .ask("POST", "/api/commands",
               R"({"id":"c1","name":"place_poi","data":{"poi_id":"p","kind":"fire","frame":"map","p":[1,2]}})", token)
          .status,
      200)
      << "marks do not need the pictures";
}

TEST(BrokenStorage, OfAPictureIsNoticedBeforeItIsShown) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const std::string plan =
      Json::parse(client.ask("POST", "/api/plans", "PNG of a plan", token).body)["plan_id"].get<std::string>();
  for (const auto& entry : std::filesystem::directory_iterator(running.data_dir() + "/files"))
    std::ofstream(entry.path(), std::ios::app) << "x";
  const auto damaged = client.ask("GET", "/api/plans/" + plan + "/picture", "", token);
  EXPECT_GE(damaged.status, 400);
  EXPECT_EQ(Json::parse(damaged.body)["error"]["code"], "corrupt");
}

}  // namespace
}  // namespace smokemap::server
