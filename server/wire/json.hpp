#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "geometry/pose2.hpp"

namespace smokemap::server {

using Json = nlohmann::json;

struct JsonLimits {
  std::size_t max_bytes = 256_KiB;
  int max_depth = 16;  ///< of nested arrays and objects, counted before parsing: the parser would recurse
};

/// Never throws: kTooLarge beyond the limits, kCorrupt for what is not JSON.
Result<Json> parse_json(std::string_view text, const JsonLimits& limits = {});

/// Never throws; bytes that are not UTF-8 come out as U+FFFD.
std::string to_text(const Json& json);

/// Rounded, so that noise below what anybody can see makes no traffic. NaN and infinity become 0.
double rounded(double value, double step);
inline double rounded_m(double metres) { return rounded(metres, 0.001); }
inline double rounded_rad(double radians) { return rounded(radians, 0.0001); }
Json point_json(const Point2& p, double step = 0.001);
Json points_json(const std::vector<Point2>& points, double step = 0.001);

/// Reads the fields of an object from outside and keeps the first complaint, so that a reader is one line a field:
///   Fields f(json, "place_poi"); poi.id = f.id("poi_id"); poi.p = f.point("p"); if (!f.ok()) return f.error();
/// Unknown fields are ignored: newer browsers may send more.
class Fields {
 public:
  /// Bounds every coordinate and length from outside, so that later arithmetic stays finite.
  static constexpr double kLargest = 1e7;

  Fields(const Json& object, std::string owner);

  bool has(const char* field) const;  ///< present and not null
  std::string text(const char* field, std::size_t max_characters, bool required = true);
  std::string id(const char* field);  ///< 1..64 printable bytes without space
  double number(const char* field, double low = -kLargest, double high = kLargest);
  int integer(const char* field, int low, int high);
  bool boolean(const char* field);
  Point2 point(const char* field);
  std::vector<Point2> points(const char* field, std::size_t at_least, std::size_t at_most);
  /// The index of the field's word in `words`.
  std::size_t word(const char* field, std::span<const char* const> words);

  void complain(const std::string& what);
  bool ok() const { return complaint_.empty(); }
  Error error() const { return fail(Errc::kInvalidArgument, complaint_); }

 private:
  const Json* find(const char* field) const;
  const Json* require(const char* field);
  const Json& object_;
  std::string owner_;
  std::string complaint_;
};

/// [x, y] with finite coordinates within Fields::kLargest.
std::optional<Point2> point_of(const Json& json);

}  // namespace smokemap::server
