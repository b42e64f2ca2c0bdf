// proto/http.yaml is what others build against: every answer of the running server is held against it.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "tests/server/app/running_server.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/yaml.hpp"

namespace smokemap::server {
namespace {

using test::RawClient;
using test::RunningServer;

const std::filesystem::path kProtoFolder = std::filesystem::path(SMOKEMAP_SOURCE_DIR) / "proto";

/// The document, and which of its answers have been seen.
class OpenApi {
 public:
  OpenApi() : document_(test::YamlFile::read(kProtoFolder / "http.yaml")) {}

  const Json& paths() const { return document_["paths"]; }

  /// Empty if the answer is one that the document promises for this request.
  std::string complaint(const std::string& method, const std::string& path, const test::HttpAnswer& answer) {
    if (!paths().contains(path) || !paths()[path].contains(method)) return method + " " + path + " is not promised";
    const std::string status = std::to_string(answer.status);
    const Json& responses = paths()[path][method]["responses"];
    seen_.insert(method + " " + path);
    // Errors that any request may meet (no token, wrong role, too large, busy) are not repeated for each.
    if (!responses.contains(status))
      return answer.status >= 400 ? error_complaint(answer) : path + " answers with " + status;
    Json response = responses[status];
    if (response.contains("$ref")) response = resolved(response["$ref"]);
    if (!response.contains("content")) return {};
    const std::string type = answer.headers.at("content-type");
    if (!response["content"].contains(type)) return path + " answers with the type " + type;
    const Json& content = response["content"][type];
    return content.is_object() && content.contains("schema")
               ? against(content["schema"], Json::parse(answer.body, nullptr, false))
               : "";
  }
  std::string error_complaint(const test::HttpAnswer& answer) const {
    return against(Json{{"$ref", "#/components/schemas/Error"}}, Json::parse(answer.body, nullptr, false));
  }
  std::set<std::string> unseen() const {
    std::set<std::string> left;
    for (const auto& [path, methods] : paths().items())
      for (const auto& [method, operation] : methods.items())
        if (!seen_.contains(method + " " + path)) left.insert(method + " " + path);
    return left;
  }

 private:
  const Json& resolved(const std::string& reference) const {
    return document_.at(Json::json_pointer(reference.substr(1)));
  }
  std::string against(const Json& schema, const Json& value) const {
    const std::string reference = schema.value("$ref", "");
    if (!reference.starts_with("ws/")) return shape(schema, value, "$");
    const std::size_t hash = reference.find('#');
    const test::Schema other(kProtoFolder / reference.substr(0, hash));
    return hash == std::string::npos
               ? other.complaint(value, other.root())
               : other.complaint(value, other.root().at(Json::json_pointer(reference.substr(hash + 1))));
  }
  /// type, required, properties, items and enum: what this document uses.
  std::string shape(const Json& given, const Json& value, const std::string& at) const {
    const Json& schema = given.contains("$ref") ? resolved(given["$ref"]) : given;
    const std::string type = schema.value("type", "");
    const bool fits = type.empty() || (type == "object" && value.is_object()) ||
                      (type == "array" && value.is_array()) || (type == "string" && value.is_string()) ||
                      (type == "boolean" && value.is_boolean()) || (type == "integer" && value.is_number_integer()) ||
                      (type == "number" && value.is_number());
    if (!fits) return at + " is no " + type;
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      return at + " is none of " + schema["enum"].dump();
    for (const Json& field : schema.value("required", Json::array()))
      if (!value.contains(field.get<std::string>())) return at + " has no " + field.get<std::string>();
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [field, rule] : properties.items())
      if (value.contains(field))
        if (const auto why = shape(rule, value[field], at + "." + field); !why.empty()) return why;
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i)
      if (const auto why = shape(schema["items"], value[i], at + "[" + std::to_string(i) + "]"); !why.empty())
        return why;
    return {};
  }

  Json document_;
  std::set<std::string> seen_;
};

TEST(OpenApiDocument, IsKeptByEveryAnswer) {
  RunningServer running;
  OpenApi api;
  const std::string token = RunningServer::bearer(running.pair("commander"));
  RawClient client(running.port());
  const auto ask = [&](const std::string& method, const std::string& path, const std::string& target,
                       const std::string& body = {}, const std::string& headers = {}) {
    const auto answer = client.ask(method, target, body, headers);
    const std::string lower = method == "GET" ? "get" : "post";
    EXPECT_EQ(api.complaint(lower, path, answer), "") << method << " " << target << " " << answer.status << answer.body;
    return answer;
  };
  ask("GET", "/api/health", "/api/health");
  ask("POST", "/api/pair", "/api/pair", R"({"pin":"123456","name":"Bo","role":"observer"})");
  ask("POST", "/api/pair", "/api/pair", R"({"pin":"000000","name":"Bo","role":"observer"})");
  ask("POST", "/api/pair", "/api/pair", R"({"pin":"123456","name":"Bo","role":"emperor"})");
  ask("GET", "/api/me", "/api/me", "", token);
  const Json plan = Json::parse(ask("POST", "/api/plans", "/api/plans", "PNG of a plan", token).body);
  ask("POST", "/api/plans", "/api/plans", "GIF", token);
  const std::string base = "/api/plans/" + plan["plan_id"].get<std::string>();
  ask("GET", "/api/plans/{id}/picture", base + "/picture", "", token);
  ask("POST", "/api/plans/{id}/read", base + "/read", R"({"metres_per_pixel":0.05})", token);
  ask("GET", "/api/plans/{id}/rectified", base + "/rectified", "", token);
  ask("GET", "/api/plans/{id}/rectified", "/api/plans/" + std::string(64, '0') + "/rectified", "", token);
  ask("POST", "/api/sketch-photo", "/api/sketch-photo", "PNG of a sketch", token);
  ask("POST", "/api/commands", "/api/commands",
      R"({"id":"c1","name":"place_poi","data":{"poi_id":"p","kind":"fire","frame":"map","p":[1,2]}})", token);
  ask("POST", "/api/commands", "/api/commands", R"({"id":"c2","name":"dance","data":{}})", token);
  ask("GET", "/api/events", "/api/events?from=1&limit=10", "", token);
  ask("GET", "/api/snapshot", "/api/snapshot?at=1", "", token);
  ask("GET", "/api/snapshot", "/api/snapshot?at=x", "", token);
  ask("GET", "/api/way", "/api/way?robot=fox&x=1.5&y=-2", "", token);
  ask("GET", "/api/way", "/api/way?robot=fox&x=900&y=0", "", token);
  ask("GET", "/api/way", "/api/way?robot=nobody&x=1&y=2", "", token);
  ask("GET", "/api/way", "/api/way?robot=fox&x=nan&y=2", "", token);
  for (const char* file : {"merged.json", "walls.geojson", "events.jsonl", "map.pgm", "map.yaml", "nothing"})
    ask("GET", "/api/export/{file}", "/api/export/" + std::string(file), "", token);
  EXPECT_TRUE(api.unseen().empty()) << *api.unseen().begin() << " was never asked";
}

TEST(OpenApiDocument, SaysOfErrorsWhatTheyAre) {
  RunningServer running;
  const OpenApi api;
  RawClient client(running.port());
  for (const char* target : {"/api/me", "/api/events", "/api/nothing", "/api/export/map.pgm", "/no/such.js"}) {
    const auto answer = client.ask("GET", target);
    EXPECT_GE(answer.status, 400) << target;
    EXPECT_EQ(api.error_complaint(answer), "") << target;
  }
}

TEST(OpenApiDocument, LetsNobodyInWithoutATokenWhereItSaysSo) {
  RunningServer running;
  const OpenApi api;
  for (const auto& [path, methods] : api.paths().items())
    for (const auto& [method, operation] : methods.items()) {
      RawClient client(running.port());
      std::string target = path;
      for (const char* name : {"{id}", "{file}"})
        if (const auto at = target.find(name); at != std::string::npos)
          target.replace(at, std::string(name).size(), "map.pgm");
      const auto answer = client.ask(method == "get" ? "GET" : "POST", target, method == "get" ? "" : "{}");
      EXPECT_EQ(answer.status == 401, !operation.contains("security")) << method << " " << path << answer.status;
    }
}

}  // namespace
}  // namespace smokemap::server
