#include "server/http/service.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <stdexcept>

#include "server/http/exports.hpp"
#include "tests/support/example_snapshot.hpp"
#include "tests/support/result_matchers.hpp"

namespace smokemap::server {
namespace {

struct Parts {
  Parts() {
    PairingParams params;
    params.pin = "123456";
    access = std::make_unique<Access>(params, std::make_shared<ManualClock>(),
                                      [](const PairedDevice&) -> Result<Ok> { return Ok{}; });
    service = std::make_unique<HttpService>(OriginPolicy(), *access, workers, "", HttpService::Limits{100, 2});
  }
  Request request(Method method, const std::string& path, std::optional<Role> role = std::nullopt) {
    Request r;
    r.method = method;
    r.path = path;
    r.host = "127.0.0.1:80";
    r.local_address = "127.0.0.1";
    r.local_port = 80;
    if (role) r.authorization = "Bearer " + access->pair({"123456", "Anna", *role, false})->token;
    return r;
  }
  Response answer(Request asked) {
    const Admission admission = service->admit(asked);
    if (admission.refusal) return *admission.refusal;
    std::promise<Response> promise;
    service->handle(admission, std::move(asked), [&promise](Response r) { promise.set_value(std::move(r)); });
    return promise.get_future().get();
  }
  WorkerPool workers{2, 4};
  std::unique_ptr<Access> access;
  std::unique_ptr<HttpService> service;
};

Handler saying(const std::string& text) {
  return [text](const Request& r, const Respond& respond) {
    respond(bytes_response(text + (r.path_parameters.empty() ? "" : r.path_parameters.begin()->second), "text/plain"));
  };
}

TEST(Routes, AreFoundByMethodAndPathAndCarryTheirParameters) {
  Parts parts;
  parts.service->add({Method::kGet, "/api/things/{id}", std::nullopt, 0, false, saying("thing ")});
  parts.service->add({Method::kGet, "/api/things/all", std::nullopt, 0, false, saying("all")});
  EXPECT_EQ(*parts.answer(parts.request(Method::kGet, "/api/things/7")).body, "thing 7");
  EXPECT_EQ(*parts.answer(parts.request(Method::kHead, "/api/things/7")).body, "thing 7");
  EXPECT_EQ(parts.answer(parts.request(Method::kPost, "/api/things/7")).status, 405);
  EXPECT_EQ(parts.answer(parts.request(Method::kGet, "/api/things")).status, 404);
  EXPECT_EQ(parts.answer(parts.request(Method::kGet, "/api/things/7/8")).status, 404);
}

TEST(Routes, AskForTheLeastRole) {
  Parts parts;
  parts.service->add({Method::kGet, "/api/x", Role::kFirefighter, 0, false, saying("x")});
  EXPECT_EQ(parts.answer(parts.request(Method::kGet, "/api/x")).status, 401);
  EXPECT_EQ(parts.answer(parts.request(Method::kGet, "/api/x", Role::kObserver)).status, 403);
  EXPECT_EQ(parts.answer(parts.request(Method::kGet, "/api/x", Role::kFirefighter)).status, 200);
  EXPECT_EQ(parts.answer(parts.request(Method::kGet, "/api/x", Role::kCommander)).status, 200);
}

TEST(LargeBodies, AreTakenOnlyAFewAtATime) {
  Parts parts;
  parts.service->add({Method::kPost, "/api/upload", std::nullopt, 1000, false, saying("ok")});
  std::vector<Admission> held;
  const auto refused = [&parts, &held] {
    Request request = parts.request(Method::kPost, "/api/upload");
    held.push_back(parts.service->admit(request));
    return held.back().refusal.has_value();
  };
  EXPECT_FALSE(refused());
  EXPECT_FALSE(refused());
  EXPECT_TRUE(refused());
  EXPECT_EQ(held.back().refusal->status, 503);
  held.clear();
  EXPECT_FALSE(refused());
}

TEST(LargeBodies, AreThoseThatComeNotThoseThatMightHaveCome) {
  Parts parts;
  parts.service->add({Method::kPost, "/api/commands", std::nullopt, 1000, false, saying("ok")});
  std::vector<Admission> held;
  for (int i = 0; i < 10; ++i) {  // small commands on a route that would take a large one
    Request request = parts.request(Method::kPost, "/api/commands");
    request.content_length = 50;
    held.push_back(parts.service->admit(request));
    EXPECT_FALSE(held.back().refusal) << "command " << i << " must not wait for others";
  }
}

TEST(Handlers, ThatThrowBecomeOneError) {
  Parts parts;
  for (const bool on_worker : {false, true})
    parts.service->add({Method::kGet, on_worker ? "/api/slow" : "/api/quick", std::nullopt, 0, on_worker,
                        [](const Request&, const Respond&) { throw std::runtime_error("secret detail"); }});
  for (const char* path : {"/api/slow", "/api/quick"}) {
    const Response response = parts.answer(parts.request(Method::kGet, path));
    EXPECT_EQ(response.status, 500);
    EXPECT_EQ(response.body->find("secret"), std::string::npos);
  }
}

TEST(WorkerPool, RefusesWhenTooMuchWaits) {
  std::promise<void> gate;
  auto opened = gate.get_future().share();
  WorkerPool pool(1, 2);
  int accepted = 0;
  for (int i = 0; i < 10; ++i) accepted += pool.post([opened] { opened.wait(); });
  EXPECT_GE(accepted, 2);
  EXPECT_LE(accepted, 3);
  gate.set_value();
  pool.stop();
  EXPECT_FALSE(pool.post([] {}));
}

TEST(Targets, AreDecodedOrRefused) {
  Request request;
  ASSERT_TRUE(parse_target("/a%20b?x=1&y=%C3%A4&z", request));
  EXPECT_EQ(request.path, "/a b");
  EXPECT_EQ(request.query.at("x"), "1");
  EXPECT_EQ(request.query.at("y"), "ä");
  EXPECT_TRUE(request.query.contains("z"));
  for (const char* target : {"", "a", "/%", "/%4", "/%zz", "/%00", "/?a=%"})
    EXPECT_FALSE(parse_target(target, request)) << target;
}

TEST(Exports, SayStatesAndUncertainty) {
  const Snapshot snapshot = test::example_snapshot();
  const Json merged = merged_document(snapshot);
  EXPECT_EQ(merged["walls"][0]["layout_wall"], 0);
  EXPECT_TRUE(merged["walls"][2]["layout_wall"].is_null());
  EXPECT_EQ(merged["walls"][2]["state"], "new");
  EXPECT_EQ(merged["corners"][0]["sigma_m"], 0.1);
  EXPECT_EQ(merged["points"].size(), 1u) << "only what was placed on the plan";
  EXPECT_EQ(export_file("map.pgm", snapshot).body->size(), std::string("P5\n40 40\n255\n").size() + 1600);
  EXPECT_NE(export_file("map.yaml", snapshot).body->find("resolution: 0.05"), std::string::npos);
  EXPECT_EQ(Json::parse(*export_file("walls.geojson", snapshot).body)["features"].size(), 3u);
  EXPECT_EQ(export_file("../smokemap.db", snapshot).status, 404);
}

TEST(Routes, SayWhichMethodsAPathTakes) {
  Parts parts;
  parts.service->add({Method::kGet, "/api/things/{id}", std::nullopt, 0, false, saying("get ")});
  parts.service->add({Method::kPost, "/api/things/{id}", std::nullopt, 10, false, saying("post ")});
  parts.service->add({Method::kPost, "/api/upload", std::nullopt, 10, false, saying("up")});
  const auto allowed = [&](Method method, const std::string& path) {
    const Response response = parts.answer(parts.request(method, path));
    for (const auto& [name, value] : response.headers)
      if (name == "Allow") return std::to_string(response.status) + " " + value;
    return std::to_string(response.status);
  };
  EXPECT_EQ(allowed(Method::kOther, "/api/things/7"), "405 GET, HEAD, POST");
  EXPECT_EQ(allowed(Method::kGet, "/api/upload"), "405 POST");
  EXPECT_EQ(allowed(Method::kHead, "/api/upload"), "405 POST");
  EXPECT_EQ(allowed(Method::kPost, "/index.html"), "405 GET, HEAD") << "a page";
  EXPECT_EQ(allowed(Method::kPost, "/api/things/7"), "200");
}

TEST(Routes, KeepWhatStandsBetweenTheSlashes) {
  Parts parts;
  parts.service->add(
      {Method::kGet, "/api/{a}/x/{b}", std::nullopt, 0, false, [](const Request& r, const Respond& respond) {
         respond(bytes_response(r.path_parameters.at("a") + "|" + r.path_parameters.at("b"), "text/plain"));
       }});
  EXPECT_EQ(*parts.answer(parts.request(Method::kGet, "/api/1/x/2 3")).body, "1|2 3");
  EXPECT_EQ(*parts.answer(parts.request(Method::kGet, "/api/../x/..")).body, "..|..") << "a name like any other";
  for (const char* path : {"/api/1/x", "/api/1/x/2/", "//api/1/x/2", "/api//x", "/api/1/X/2", "/API/1/x/2"})
    EXPECT_EQ(parts.answer(parts.request(Method::kGet, path)).status, 404) << path;
}

TEST(Tokens, AreTakenInOneFormOnly) {
  Parts parts;
  parts.service->add({Method::kGet, "/api/x", Role::kObserver, 0, false, saying("x")});
  const std::string token = parts.access->pair({"123456", "Anna", Role::kObserver, false})->token;
  const auto status = [&](const std::string& authorization) {
    Request request = parts.request(Method::kGet, "/api/x");
    request.authorization = authorization;
    return parts.answer(request).status;
  };
  EXPECT_EQ(status("Bearer " + token), 200);
  for (const std::string& other :
       {std::string(), token, "bearer" + token, "Basic " + token, "Bearer  " + token, "Bearer " + token + " ",
        "Bearer " + token.substr(1), std::string("Bearer "), "Bearer " + token + token})
    EXPECT_EQ(status(other), 401) << other;
}

TEST(Hosts, AreOursToTheLetterForEveryMethodAndEvenForSockets) {
  Parts parts;
  parts.service->add({Method::kGet, "/api/x", std::nullopt, 0, false, saying("x")});
  for (const char* host : {"127.0.0.1:80", "127.0.0.1", "localhost", "LOCALHOST:80", "[::1]:80"}) {
    Request request = parts.request(Method::kGet, "/api/x");
    request.host = host;
    EXPECT_EQ(parts.answer(request).status, 200) << host;
  }
  for (const char* host : {"", "127.0.0.1:81", "127.0.0.1.evil.example", "evil.example", "localhost:80:80",
                           "localhost.", " localhost", "localhost/", "127.1", "0x7f000001", "[::1", "::1"}) {
    Request request = parts.request(Method::kGet, "/api/x");
    request.host = host;
    EXPECT_EQ(parts.answer(request).status, 421) << host;
    request.path = "/api/live";
    EXPECT_EQ(parts.service->refuse_socket(request)->status, 421) << host;
  }
}

TEST(Origins, AreThePagesOwnOrAbsent) {
  Parts parts;
  parts.service->add({Method::kPost, "/api/x", std::nullopt, 10, false, saying("x")});
  const auto status = [&](const std::string& origin) {
    Request request = parts.request(Method::kPost, "/api/x");
    request.origin = origin;
    return parts.answer(request).status;
  };
  for (const char* own : {"", "http://127.0.0.1:80", "https://127.0.0.1:80", "HTTP://127.0.0.1:80"})
    EXPECT_EQ(status(own), 200) << own;
  for (const char* foreign :
       {"null", "http://127.0.0.1", "http://localhost:80", "http://127.0.0.1:80/", "http://127.0.0.1:800",
        "http://evil.example", "file://", "http://127.0.0.1:80@evil.example", "ftp://127.0.0.1:80"})
    EXPECT_EQ(status(foreign), 403) << foreign;
}

TEST(LargeBodies, OfUnknownLengthCountAsTheMostTheyMayBecome) {
  Parts parts;
  parts.service->add({Method::kPost, "/api/upload", std::nullopt, 1000, false, saying("ok")});
  parts.service->add({Method::kPost, "/api/small", std::nullopt, 100, false, saying("ok")});
  const auto permit = [&](const std::string& path, std::optional<std::uint64_t> length) {
    Request request = parts.request(Method::kPost, path);
    request.content_length = length;
    return parts.service->admit(request).permit.use_count() > 0;
  };
  EXPECT_TRUE(permit("/api/upload", std::nullopt)) << "chunked";
  EXPECT_TRUE(permit("/api/upload", 101));
  EXPECT_FALSE(permit("/api/upload", 100));
  EXPECT_FALSE(permit("/api/small", std::nullopt)) << "it cannot become large";
  EXPECT_FALSE(permit("/api/small", std::uint64_t{1} << 60)) << "its length is refused elsewhere";
}

TEST(WorkerPool, RunsWhatWasTakenOnceAndInOrderAndSurvivesWhatThrows) {
  std::vector<int> done;
  std::promise<void> last;
  WorkerPool pool(1, 200);
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(pool.post([&, i] {
      done.push_back(i);
      if (i == 99) last.set_value();
      if (i % 10 == 0) throw std::runtime_error("work that fails");
    }));
  last.get_future().wait();
  pool.stop();
  ASSERT_EQ(done.size(), 100u);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
}

}  // namespace
}  // namespace smokemap::server
