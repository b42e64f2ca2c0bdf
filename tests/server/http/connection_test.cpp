// One HTTP connection, over real sockets: what a browser, a broken proxy and somebody hostile may do to it.

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "core/random.hpp"
#include "tests/server/app/running_server.hpp"
#include "tests/support/eventually.hpp"

namespace smokemap::server {
namespace {

using test::RawClient;
using test::RunningServer;

std::string head(const RawClient& client, const std::string& method, const std::string& target,
                 const std::string& more = {}) {
  return method + " " + target + " HTTP/1.1\r\nHost: " + client.host() + "\r\n" + more + "\r\n";
}

/// True when the server has closed: nothing more comes, and not because we gave up waiting.
bool is_closed(RawClient& client) { return !client.fill(5000); }

TEST(Connection, AnswersManyRequestsInTheirOrder) {
  RunningServer running;
  RawClient client(running.port());
  std::string pipelined;
  for (const char* path : {"/api/health", "/api/me", "/api/nothing", "/", "/api/health"})
    pipelined += head(client, "GET", path);
  client.send(pipelined);
  for (const int status : {200, 401, 404, 200, 200}) EXPECT_EQ(client.answer().status, status);
}

TEST(Connection, TakesARequestInPieces) {
  RunningServer running;
  RawClient client(running.port());
  const std::string body = R"({"pin":"123456","name":"Anna","role":"observer"})";
  const std::string request = "POST /api/pair HTTP/1.1\r\nHost: " + client.host() +
                              "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  for (const char c : request) client.send(std::string(1, c));
  EXPECT_EQ(client.answer().status, 200);
}

TEST(Connection, TakesChunkedBodiesAndSaysContinueWhenAsked) {
  RunningServer running;
  RawClient client(running.port());
  const std::string body = R"({"pin":"123456","name":"Anna","role":"observer"})";
  client.send(head(client, "POST", "/api/pair", "Transfer-Encoding: chunked\r\n"));
  for (std::size_t i = 0; i < body.size(); i += 10) {
    const std::string piece = body.substr(i, 10);
    client.send(std::string(1, "0123456789a"[piece.size()]) + "\r\n" + piece + "\r\n");
  }
  client.send("0\r\n\r\n");
  EXPECT_EQ(client.answer().status, 200);
  client.send(head(client, "POST", "/api/pair",
                   "Expect: 100-continue\r\nContent-Length: " + std::to_string(body.size()) + "\r\n"));
  EXPECT_EQ(client.answer().status, 100);
  client.send(body);
  EXPECT_EQ(client.answer().status, 200);
}

TEST(Connection, IsKeptOrClosedAsTheClientWishes) {
  RunningServer running;
  RawClient kept(running.port()), closed(running.port()), old(running.port());
  kept.send(head(kept, "GET", "/api/health"));
  EXPECT_EQ(kept.answer().status, 200);
  kept.send(head(kept, "GET", "/api/health"));
  EXPECT_EQ(kept.answer().status, 200);
  closed.send(head(closed, "GET", "/api/health", "Connection: close\r\n"));
  EXPECT_EQ(closed.answer().status, 200);
  EXPECT_TRUE(is_closed(closed));
  old.send("GET /api/health HTTP/1.0\r\nHost: " + old.host() + "\r\n\r\n");
  EXPECT_EQ(old.answer().status, 200);
  EXPECT_TRUE(is_closed(old));
}

TEST(Connection, IsClosedAfterABodyThatNobodyReads) {
  RunningServer running;
  RawClient client(running.port());
  client.send(head(client, "POST", "/api/plans", "Content-Length: 5000\r\n"));
  EXPECT_EQ(client.answer().status, 401) << "refused by its head alone";
  client.send(std::string(5000, 'x'));
  EXPECT_TRUE(is_closed(client)) << "the body would be taken for the next request";
}

TEST(Connection, SurvivesClientsThatLeaveInTheMiddle) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  for (int i = 0; i < 30; ++i) {
    RawClient client(running.port());
    if (i % 3 == 0) client.send("GET /api/hea");
    if (i % 3 == 1) client.send(head(client, "POST", "/api/plans", token + "Content-Length: 9000000\r\n") + "PNG");
    if (i % 3 == 2) client.send(head(client, "GET", "/api/export/events.jsonl", token));
  }
  RawClient client(running.port());
  // What was promised to those who left is free again: uploads are taken.
  EXPECT_TRUE(test::eventually([&] {
    RawClient uploader(running.port());
    return uploader.ask("POST", "/api/plans", "PNG small", token).status == 200;
  }));
  EXPECT_EQ(client.ask("GET", "/api/health").status, 200);
}

TEST(Connection, SendsNoBodyToHeadAndNothingToAFilesOldOwner) {
  RunningServer running;
  RawClient client(running.port());
  const auto whole = client.ask("GET", "/");
  const auto only_head = client.ask("HEAD", "/");
  EXPECT_EQ(only_head.headers.at("content-length"), whole.headers.at("content-length"));
  EXPECT_EQ(client.ask("GET", "/api/health").status, 200) << "the connection is still in step";
}

TEST(Connection, RefusesHeadsThatAreTooLargeOrSmuggle) {
  RunningServer running;
  const auto status_of = [&](const std::string& text) {
    RawClient client(running.port());
    client.send(text);
    return client.answer().status;
  };
  const std::string host = "Host: 127.0.0.1:" + std::to_string(running.port()) + "\r\n";
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n" + host + "X: " + std::string(20'000, 'a') + "\r\n\r\n"), 431);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), 421) << "without a host";
  for (const std::string& text :
       {"POST /api/pair HTTP/1.1\r\n" + host + "Content-Length: 5\r\nContent-Length: 6\r\n\r\nhello!",
        "POST /api/pair HTTP/1.1\r\n" + host + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
        "POST /api/pair HTTP/1.1\r\n" + host + "Content-Length: 99999999999999999999\r\n\r\n",
        "GET /%zz HTTP/1.1\r\n" + host + "\r\n", "GET index.html HTTP/1.1\r\n" + host + "\r\n",
        "GET / HTTP/1.1\r\n" + host + "bad header\r\n\r\n"}) {
    const int status = status_of(text);
    EXPECT_TRUE(status >= 400 && status < 500) << status << " for " << text.substr(0, 60);
  }
}

TEST(Connection, SurvivesNoise) {
  RunningServer running;
  std::mt19937_64 random(5);
  for (int i = 0; i < 60; ++i) {
    RawClient client(running.port());
    std::string noise = i % 2 == 0 ? "GET /api/health HTTP/1.1\r\nHost: " + client.host() + "\r\n" : "";
    for (std::uint64_t n = uniform_index(random, 300); n > 0; --n)
      noise += static_cast<char>(uniform_index(random, 256));
    client.send(noise + "\r\n\r\n");
  }
  RawClient client(running.port());
  EXPECT_EQ(client.ask("GET", "/api/health").status, 200);
}

TEST(Connection, RefusesForeignHostsInEveryRequestNotOnlyTheFirst) {
  RunningServer running;
  RawClient client(running.port());
  EXPECT_EQ(client.ask("GET", "/api/health").status, 200);
  client.send("GET /api/health HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(client.answer().status, 421);
  const std::string rebound = "localhost.evil.example:" + std::to_string(running.port());
  client.send("GET / HTTP/1.1\r\nHost: " + rebound + "\r\n\r\n");
  EXPECT_EQ(client.answer().status, 421) << "pages too, or a rebound name could read them";
  client.send(
      head(client, "GET", "/api/health", "Origin: http://localhost:" + std::to_string(running.port()) + "\r\n"));
  EXPECT_EQ(client.answer().status, 403) << "another name for us is another origin";
}

TEST(Connection, LimitsHowManyThereAreAndTakesNewOnesWhenOldOnesLeave) {
  RunningServer running;
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 255; ++i) idle.push_back(std::make_unique<RawClient>(running.port()));
  EXPECT_TRUE(test::eventually([&] {
    RawClient last(running.port());
    RawClient beyond(running.port());
    beyond.send(head(beyond, "GET", "/api/health"));
    return beyond.answer().status == 0;
  })) << "the 257th is closed";
  idle.clear();
  EXPECT_TRUE(test::eventually([&] {
    RawClient client(running.port());
    client.send(head(client, "GET", "/api/health"));
    return client.answer().status == 200;
  }));
}

TEST(Connection, ServesManyAtOnce) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  std::vector<std::thread> people;
  std::atomic<int> good = 0;
  for (int p = 0; p < 8; ++p)
    people.emplace_back([&, p] {
      RawClient client(running.port());
      for (int i = 0; i < 10; ++i) {
        const std::string id = "c" + std::to_string(p) + "-" + std::to_string(i);
        const auto answer = client.ask("POST", "/api/commands",
                                       R"({"id":")" + id + R"(","name":"place_poi","data":{"poi_id":")" + id +
                                           R"(","kind":"fire","frame":"map","p":[1,2]}})",
                                       token);
        good += answer.status == 200;
      }
    });
  for (std::thread& person : people) person.join();
  EXPECT_EQ(good, 80);
  EXPECT_EQ(running.engine().count(), 80u);
}

TEST(Uploads, AreLimitedInSizeHoweverTheyCome) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  constexpr std::size_t kMost = 25 * 1024 * 1024;
  RawClient exact(running.port());
  std::string picture = "PNG" + std::string(kMost - 3, 'x');
  EXPECT_EQ(exact.ask("POST", "/api/plans", picture, token).status, 200) << "the limit itself is allowed";
  RawClient one_more(running.port());
  one_more.send(head(one_more, "POST", "/api/plans", token + "Content-Length: " + std::to_string(kMost + 1) + "\r\n"));
  EXPECT_EQ(one_more.answer().status, 413);
  RawClient command(running.port());
  command.send(head(command, "POST", "/api/commands", token + "Content-Length: 5000000\r\n"));
  EXPECT_EQ(command.answer().status, 413) << "commands have a limit of their own";
  RawClient nothing(running.port());
  EXPECT_EQ(nothing.ask("GET", "/api/health", "a body", "").status, 413) << "what takes no body takes none";
}

TEST(Uploads, AreTakenOnlyAFewAtATime) {
  RunningServer running;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 4; ++i) {
    slow.push_back(std::make_unique<RawClient>(running.port()));
    slow.back()->send(head(*slow.back(), "POST", "/api/plans", token + "Content-Length: 2000000\r\n") + "PNG");
  }
  EXPECT_TRUE(test::eventually([&] {
    RawClient fifth(running.port());
    fifth.send(head(fifth, "POST", "/api/plans", token + "Content-Length: 2000000\r\n"));
    return fifth.answer().status == 503;
  }));
  RawClient other(running.port());
  EXPECT_EQ(other.ask("GET", "/api/me", "", token).status, 200) << "only uploads wait";
  slow.clear();
  EXPECT_TRUE(test::eventually([&] {
    RawClient again(running.port());
    return again.ask("POST", "/api/plans", "PNG" + std::string(2'000'000, 'x'), token).status == 200;
  }));
}

TEST(Connection, ASecondHostOrOriginWasOverlooked) {
  RunningServer running;
  const std::string host = "Host: 127.0.0.1:" + std::to_string(running.port()) + "\r\n";
  const auto status_of = [&](const std::string& more) {
    RawClient client(running.port());
    client.send("GET /api/health HTTP/1.1\r\n" + host + more + "\r\n");
    return client.answer().status;
  };
  EXPECT_EQ(status_of(""), 200);
  EXPECT_EQ(status_of("Host: evil.example\r\n"), 400);
  EXPECT_EQ(status_of(host), 400) << "even the same one again";
  EXPECT_EQ(status_of("Origin: http://127.0.0.1:" + std::to_string(running.port()) + "\r\nOrigin: null\r\n"), 400);
  EXPECT_EQ(status_of("Authorization: Bearer a\r\nAuthorization: Bearer b\r\n"), 400);
}

TEST(Connection, AnswersMethodsThatNobodyKnowsWithoutLosingStep) {
  RunningServer running;
  RawClient client(running.port());
  for (const char* method : {"PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "BREW", "get"}) {
    client.send(head(client, method, "/api/health"));
    const auto answer = client.answer();
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_EQ(answer.headers.at("allow"), "GET, HEAD") << method;
  }
  EXPECT_EQ(client.ask("GET", "/api/health").status, 200);
}

TEST(Connection, RefusesBodiesThatPretendInChunks) {
  RunningServer running;
  const auto status_of = [&](const std::string& chunks, const std::string& target = "/api/pair") {
    RawClient client(running.port());
    client.send(head(client, "POST", target, "Transfer-Encoding: chunked\r\n") + chunks);
    return client.answer().status;
  };
  EXPECT_EQ(status_of("zz\r\nx\r\n0\r\n\r\n"), 400) << "no number";
  EXPECT_EQ(status_of("-5\r\nhello\r\n0\r\n\r\n"), 400);
  EXPECT_EQ(status_of("3\r\nhello\r\n0\r\n\r\n"), 400) << "longer than it says";
  EXPECT_GE(status_of("ffffffffffffffff\r\nx"), 400) << "as long as all memory";
  EXPECT_EQ(status_of("4e20\r\n" + std::string(0x4e20, 'x') + "\r\n0\r\n\r\n"), 413) << "20 000 of 16 384 bytes";
  std::string trickle;
  for (int i = 0; i < 17'000; ++i) trickle += "1\r\nx\r\n";
  EXPECT_EQ(status_of(trickle + "0\r\n\r\n"), 413) << "and the same in small bites";
}

}  // namespace
}  // namespace smokemap::server
