#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace smokemap::test {

using nlohmann::json;

inline json read_json(const std::filesystem::path& path) {
  std::ifstream in(path);
  return json::parse(in, nullptr, false);
}

/// As much of JSON Schema as proto/ws uses: type, const, enum, required, properties, additionalProperties (a schema),
/// items, minItems, maxItems, minLength, maxLength, minimum, maximum, anyOf, oneOf, $ref within the file and to its
/// neighbours.
class Schema {
 public:
  explicit Schema(const std::filesystem::path& file) : folder_(file.parent_path()), root_(read_json(file)) {}
  const json& root() const { return root_; }
  const json& def(const std::string& name) const { return root_.at("$defs").at(name); }

  /// Empty when `value` keeps `schema`; otherwise where and why not.
  std::string complaint(const json& value, const json& schema, const std::string& at = "$") const {
    if (schema.contains("$ref")) return follow(value, schema["$ref"], at);
    if (schema.contains("const") && value != schema["const"]) return at + " is not " + schema["const"].dump();
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      return at + " is none of " + schema["enum"].dump();
    for (const char* choice : {"anyOf", "oneOf"})
      if (schema.contains(choice)) return any(value, schema[choice], at);
    if (schema.contains("type") && !has_type(value, schema["type"]))
      return at + " is no " + schema["type"].get<std::string>();
    if (value.is_number()) return within(value.get<double>(), schema, "minimum", "maximum", at);
    if (value.is_string())
      return within(static_cast<double>(value.get<std::string>().size()), schema, "minLength", "maxLength", at);
    if (value.is_array()) return array(value, schema, at);
    if (value.is_object()) return object(value, schema, at);
    return {};
  }

 private:
  static bool has_type(const json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "integer") return value.is_number() && value.get<double>() == std::floor(value.get<double>());
    return value.is_number();
  }
  static std::string within(double size, const json& schema, const char* low, const char* high, const std::string& at) {
    if (schema.contains(low) && size < schema[low].get<double>()) return at + " is below " + low;
    if (schema.contains(high) && size > schema[high].get<double>()) return at + " is above " + high;
    return {};
  }
  std::string any(const json& value, const json& choices, const std::string& at) const {
    std::string all;
    for (const json& choice : choices) {
      const std::string why = complaint(value, choice, at);
      if (why.empty()) return {};
      all += why + "; ";
    }
    return all;
  }
  std::string array(const json& value, const json& schema, const std::string& at) const {
    if (auto why = within(static_cast<double>(value.size()), schema, "minItems", "maxItems", at); !why.empty())
      return why;
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i)
      if (auto why = complaint(value[i], schema["items"], at + "[" + std::to_string(i) + "]"); !why.empty()) return why;
    return {};
  }
  std::string object(const json& value, const json& schema, const std::string& at) const {
    for (const json& field : schema.value("required", json::array()))
      if (!value.contains(field.get<std::string>())) return at + " has no " + field.get<std::string>();
    for (const auto& [key, item] : value.items()) {
      const json* rule = schema.contains("properties") && schema["properties"].contains(key)
                             ? &schema["properties"][key]
                         : schema.contains("additionalProperties") ? &schema["additionalProperties"]
                                                                   : nullptr;
      if (!rule) continue;
      if (auto why = complaint(item, *rule, at + "." + key); !why.empty()) return why;
    }
    return {};
  }
  std::string follow(const json& value, const std::string& reference, const std::string& at) const {
    const std::size_t hash = reference.find('#');
    if (hash != 0) {
      const Schema other(folder_ / reference.substr(0, hash));
      const json& target =
          hash == std::string::npos ? other.root_ : other.root_.at(json::json_pointer(reference.substr(hash + 1)));
      return other.complaint(value, target, at);
    }
    return complaint(value, root_.at(json::json_pointer(reference.substr(1))), at);
  }

  std::filesystem::path folder_;
  json root_;
};

}  // namespace smokemap::test
