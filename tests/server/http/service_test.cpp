#include "server/http/service.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace smokemap::server
