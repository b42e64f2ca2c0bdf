#include "server/wire/json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.hpp"

namespace smokemap::server {
namespace {

/// Deepest nesting of brackets outside strings.
int nesting(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

bool usable_number(const Json& json) {
  if (!json.is_number()) return false;
  const double value = json.get<double>();
  return std::isfinite(value) && std::abs(value) <= Fields::kLargest;
}

}  // namespace

Result<Json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes)
    return fail(Errc::kTooLarge, "JSON of " + std::to_string(text.size()) + " bytes, at most " +
                                     std::to_string(limits.max_bytes) + " are taken");
  if (nesting(text) > limits.max_depth)
    return fail(Errc::kTooLarge, "JSON nested deeper than " + std::to_string(limits.max_depth) + " levels");
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return fail(Errc::kCorrupt, "this is not JSON");
  return json;
}

std::string to_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

double rounded(double value, double step) {
  if (!std::isfinite(value)) return 0;
  const double inverse = std::round(1.0 / step), steps = value * inverse;
  if (std::abs(steps) > 9e15) return value;  // it has no such digits; and a product beyond all numbers would be null
  const double result = std::round(steps) / inverse;
  return result == 0 ? 0 : result;  // no "-0.0"
}

Json point_json(const Point2& p, double step) { return Json::array({rounded(p.x(), step), rounded(p.y(), step)}); }

Json points_json(const std::vector<Point2>& points, double step) {
  Json array = Json::array();
  for (const Point2& p : points) array.push_back(point_json(p, step));
  return array;
}

std::optional<Point2> point_of(const Json& json) {
  if (!json.is_array() || json.size() != 2 || !usable_number(json[0]) || !usable_number(json[1])) return std::nullopt;
  return Point2(json[0].get<double>(), json[1].get<double>());
}

Fields::Fields(const Json& object, std::string owner) : object_(object), owner_(std::move(owner)) {
  if (!object_.is_object()) complain(" is not an object");
}

bool Fields::has(const char* field) const {
  const Json* value = find(field);
  return value && !value->is_null();
}

void Fields::complain(const std::string& what) {
  if (complaint_.empty()) complaint_ = owner_ + what;
}

const Json* Fields::find(const char* field) const {
  if (!object_.is_object()) return nullptr;
  const auto it = object_.find(field);
  return it == object_.end() ? nullptr : &*it;
}

const Json* Fields::require(const char* field) {
  const Json* value = find(field);
  if (!value) complain(std::string(".") + field + " is missing");
  return value;
}

std::string Fields::text(const char* field, std::size_t max_characters, bool required) {
  if (!required && !has(field)) return {};
  const Json* value = require(field);
  if (!value) return {};
  if (!value->is_string() || characters(value->get_ref<const std::string&>()) > max_characters) {
    complain(std::string(".") + field + " must be text of at most " + std::to_string(max_characters) + " characters");
    return {};
  }
  return value->get<std::string>();
}

std::string Fields::id(const char* field) {
  const std::string id = text(field, 64);
  bool printable = !id.empty();
  for (const char c : id) printable = printable && c > ' ' && c != 127 && c != '"' && c != '\\';
  if (!printable) complain(std::string(".") + field + " must be 1 to 64 printable characters");
  return id;
}

double Fields::number(const char* field, double low, double high) {
  const Json* value = require(field);
  if (!value) return low;
  if (!usable_number(*value) || value->get<double>() < low || value->get<double>() > high) {
    complain(std::string(".") + field + " must be a number within [" + to_text(low) + ", " + to_text(high) + "]");
    return low;
  }
  return value->get<double>();
}

int Fields::integer(const char* field, int low, int high) {
  const double value = number(field, low, high);
  if (value != std::floor(value)) complain(std::string(".") + field + " must be a whole number");
  return static_cast<int>(value);
}

bool Fields::boolean(const char* field) {
  const Json* value = require(field);
  if (!value) return false;
  if (!value->is_boolean()) {
    complain(std::string(".") + field + " must be true or false");
    return false;
  }
  return value->get<bool>();
}

Point2 Fields::point(const char* field) {
  const Json* value = require(field);
  if (!value) return Point2::Zero();
  const auto p = point_of(*value);
  if (!p) complain(std::string(".") + field + " must be [x, y]");
  return p.value_or(Point2::Zero());
}

std::vector<Point2> Fields::points(const char* field, std::size_t at_least, std::size_t at_most) {
  std::vector<Point2> points;
  const Json* value = require(field);
  if (!value) return points;
  if (!value->is_array() || value->size() < at_least || value->size() > at_most) {
    complain(std::string(".") + field + " must have " + std::to_string(at_least) + " to " + std::to_string(at_most) +
             " points");
    return points;
  }
  points.reserve(value->size());
  for (const Json& item : *value) {
    const auto p = point_of(item);
    if (!p) {
      complain(std::string(".") + field + " must be a list of [x, y]");
      return {};
    }
    points.push_back(*p);
  }
  return points;
}

std::size_t Fields::word(const char* field, std::span<const char* const> words) {
  const std::string value = text(field, 64);
  for (std::size_t i = 0; i < words.size(); ++i)
    if (value == words[i]) return i;
  complain(std::string(".") + field + " is not a word known here");
  return 0;
}

}  // namespace smokemap::server
