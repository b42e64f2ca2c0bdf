#include "recording/map_server.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/bytes.hpp"
#include "recording/file_bytes.hpp"

namespace smokemap {
namespace {

// Cells are drawn with the thresholds of nav2's map_saver. The yaml says 0.196 for free all the same: with 0.25 the
// gray of unknown, 205, which is an occupancy of 0.1961, would be read back as free.
constexpr int kOccupiedPercent = 65;
constexpr int kFreePercent = 25;
constexpr double kOccupiedThreshold = 0.65;
constexpr double kFreeThreshold = 0.196;
constexpr std::size_t kMostCells = 100'000'000;
constexpr std::size_t kMostYamlBytes = 64_KiB;
constexpr std::size_t kMostMapFileBytes = 400'000'000;

cv::Mat trinary_image(const OccupancyGrid& grid) {
  const GridFrame& frame = grid.frame();
  cv::Mat image(frame.height_cells, frame.width_cells, CV_8UC1);
  for (int row = 0; row < image.rows; ++row)
    for (int x = 0; x < image.cols; ++x) {
      const std::int8_t percent = grid.at({x, image.rows - 1 - row});
      image.at<std::uint8_t>(row, x) = percent < 0                   ? 205
                                       : percent >= kOccupiedPercent ? 0
                                       : percent <= kFreePercent     ? 254
                                                                     : 205;
    }
  return image;
}

Result<Ok> write_image(const cv::Mat& image, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  try {
    if (!cv::imencode(path.extension().string(), image, bytes))
      return fail(Errc::kIo, "cannot encode " + path.string());
  } catch (const cv::Exception& e) {
    return fail(Errc::kIo, "cannot encode " + path.string() + ": " + e.err);
  }
  return write_file(path, bytes);
}

std::string map_yaml(const GridFrame& frame, const std::string& image_name) {
  std::array<char, 512> text;
  std::snprintf(text.data(), text.size(),
                "image: %s\nmode: trinary\nresolution: %.9g\norigin: [%.9g, %.9g, 0]\nnegate: 0\n"
                "occupied_thresh: %.2f\nfree_thresh: %.3f\n",
                image_name.c_str(), frame.resolution_m, frame.origin.x(), frame.origin.y(), kOccupiedThreshold,
                kFreeThreshold);
  return text.data();
}

/// "key: value" lines; quotes, comments and document marks taken off. All that map_server's files ever hold.
std::map<std::string, std::string> flat_yaml(std::string_view text) {
  const auto trimmed = [](std::string_view part) {
    const std::size_t begin = part.find_first_not_of(" \t\r\"'");
    if (begin == std::string_view::npos) return std::string();
    return std::string(part.substr(begin, part.find_last_not_of(" \t\r\"'") - begin + 1));
  };
  std::map<std::string, std::string> values;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (const std::size_t comment = line.find(" #"); comment != std::string_view::npos) line = line.substr(0, comment);
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || line.starts_with('#')) continue;
    values[trimmed(line.substr(0, colon))] = trimmed(line.substr(colon + 1));
  }
  return values;
}

/// Numbers between anything that is not part of a number.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = text.find_first_of("-.0123456789", at)) != std::string_view::npos;) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (error == std::errc() && std::isfinite(value)) numbers.push_back(value);
    at = std::max(at + 1, static_cast<std::size_t>(end - text.data()));
  }
  return numbers;
}

struct MapYaml {
  std::string image;
  std::string mode = "trinary";
  double resolution_m = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  bool negate = false;
  double occupied = kOccupiedThreshold, free = kFreeThreshold;
};

Result<MapYaml> parse_map_yaml(std::string_view text) {
  const auto values = flat_yaml(text);
  const auto text_at = [&](const char* key) { return values.contains(key) ? values.at(key) : std::string(); };
  const auto number_at = [&](const char* key, double fallback) {
    const auto numbers = numbers_in(text_at(key));
    return numbers.size() == 1 ? numbers[0] : fallback;
  };
  MapYaml map;
  map.image = text_at("image");
  if (map.image.empty()) return fail(Errc::kCorrupt, "map yaml without image");
  if (const std::string mode = text_at("mode"); !mode.empty()) map.mode = mode;
  if (map.mode != "trinary" && map.mode != "scale" && map.mode != "raw")
    return fail(Errc::kUnsupported, "map mode " + map.mode.substr(0, 32));
  map.resolution_m = number_at("resolution", 0);
  if (!(map.resolution_m > 1e-4 && map.resolution_m < 1e3))
    return fail(Errc::kCorrupt, "map yaml without a usable resolution");
  const auto origin = numbers_in(text_at("origin"));
  if (origin.size() != 3) return fail(Errc::kCorrupt, "map yaml without a usable origin");
  if (std::abs(origin[2]) > 1e-9) return fail(Errc::kUnsupported, "a map whose origin is turned");
  map.origin = {origin[0], origin[1]};
  map.negate = number_at("negate", 0) != 0;
  map.occupied = number_at("occupied_thresh", map.occupied);
  map.free = number_at("free_thresh", map.free);
  return map;
}

std::int8_t percent_of(int gray, const MapYaml& map) {
  if (map.mode == "raw") return gray <= 100 ? static_cast<std::int8_t>(gray) : OccupancyGrid::kUnknown;
  const double occupancy = (map.negate ? gray : 255 - gray) / 255.0;
  if (occupancy > map.occupied) return 100;
  if (occupancy < map.free) return 0;
  if (map.mode == "trinary") return OccupancyGrid::kUnknown;
  return static_cast<std::int8_t>(std::lround(1 + 98 * (occupancy - map.free) / (map.occupied - map.free)));
}

}  // namespace

Result<Ok> write_map(const OccupancyGrid& grid, const std::filesystem::path& prefix) {
  if (grid.empty()) return fail(Errc::kDegenerate, "a map without cells");
  const auto with = [&](const char* extension) {
    std::filesystem::path path = prefix;
    path += extension;
    return path;
  };
  const cv::Mat image = trinary_image(grid);
  Result<Ok> done = write_image(image, with(".pgm"));
  if (done) done = write_image(image, with(".png"));
  if (done) done = write_file(with(".yaml"), map_yaml(grid.frame(), with(".pgm").filename().string()));
  if (done) return done;
  for (const char* extension : {".pgm", ".png", ".yaml"}) {
    std::error_code ignored;
    std::filesystem::remove(with(extension), ignored);
  }
  return done;
}

Result<OccupancyGrid> read_map(const std::filesystem::path& yaml) {
  const auto text = read_file(yaml, kMostYamlBytes);
  if (!text) return text.error();
  const auto map = parse_map_yaml({reinterpret_cast<const char*>(text->data()), text->size()});
  if (!map) return map.error();
  const auto bytes = read_file(yaml.parent_path() / map->image, kMostMapFileBytes);
  if (!bytes) return bytes.error();
  cv::Mat image;
  try {
    image = cv::imdecode(*bytes, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) return fail(Errc::kCorrupt, map->image + " is no picture we can read");
  if (image.total() > kMostCells) return fail(Errc::kTooLarge, "a map of more than 100 million cells");
  OccupancyGrid grid({map->resolution_m, map->origin, image.cols, image.rows});
  for (int row = 0; row < image.rows; ++row)
    for (int x = 0; x < image.cols; ++x)
      grid.at({x, image.rows - 1 - row}) = percent_of(image.at<std::uint8_t>(row, x), *map);
  return grid;
}

}  // namespace smokemap
