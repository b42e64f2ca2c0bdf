#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/map_picture.hpp"
#include "matching/match.hpp"
#include "matching/transfer.hpp"
#include "segmentation/constriction.hpp"
#include "segmentation/outline.hpp"
#include "segmentation/segment.hpp"

namespace smokemap::app {
namespace {

struct MatchArguments {
  std::string sketch, map, pins, points, output, preview, method = "structure";
  bool mirrored = false;
};

Result<nlohmann::json> read_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) return fail(Errc::kNotFound, "there is no file " + path);
  nlohmann::json document = nlohmann::json::parse(file, nullptr, false);
  if (document.is_discarded()) return fail(Errc::kCorrupt, path + " is not JSON");
  return document;
}

Result<Point2> point_of(const nlohmann::json& value, const std::string& where) {
  const bool is_point = value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number();
  if (!is_point) return fail(Errc::kCorrupt, where + " must be a point [x, y]");
  return Point2(value[0].get<double>(), value[1].get<double>());
}

Result<std::vector<Pin>> read_pins(const std::string& path) {
  std::vector<Pin> pins;
  if (path.empty()) return pins;
  const Result<nlohmann::json> document = read_json(path);
  if (!document) return document.error();
  if (!document->is_object() || !document->contains("pins") || !(*document)["pins"].is_array())
    return fail(Errc::kCorrupt, path + " must be an object with a list \"pins\"");
  for (const nlohmann::json& entry : (*document)["pins"]) {
    if (!entry.is_object()) return fail(Errc::kCorrupt, path + ": a pin is {\"sketch\": [x, y], \"map\": [x, y]}");
    const Result<Point2> a = point_of(entry.value("sketch", nlohmann::json()), path + ": \"sketch\"");
    if (!a) return a.error();
    const Result<Point2> b = point_of(entry.value("map", nlohmann::json()), path + ": \"map\"");
    if (!b) return b.error();
    pins.push_back({*a, *b});
  }
  return pins;
}

Result<std::vector<Point2>> read_points(const std::string& path) {
  std::vector<Point2> points;
  if (path.empty()) return points;
  const Result<nlohmann::json> document = read_json(path);
  if (!document) return document.error();
  if (!document->is_object() || !document->contains("points") || !(*document)["points"].is_array())
    return fail(Errc::kCorrupt, path + " must be an object with a list \"points\"");
  for (const nlohmann::json& entry : (*document)["points"]) {
    const Result<Point2> point = point_of(entry, path + ": every point");
    if (!point) return point.error();
    points.push_back(*point);
  }
  return points;
}

Result<Segmentation> segment_file(const std::string& path) {
  const Result<cv::Mat> picture = read_map_picture(path);
  if (!picture) return picture.error();
  const Result<cv::Mat> free_space = free_space_of_picture(*picture);
  if (!free_space) return free_space.error();
  Result<Segmentation> segmentation = segment_by_constrictions(*free_space, matching_segmentation_params());
  if (!segmentation) return fail(segmentation.error().code, path + ": " + segmentation.error().message);
  return segmentation;
}

nlohmann::json pairs_document(const std::vector<RegionPair>& pairs) {
  nlohmann::json list = nlohmann::json::array();
  for (const RegionPair& pair : pairs)
    list.push_back(
        {{"sketch", pair.label_a}, {"map", pair.label_b}, {"confidence", std::round(pair.confidence * 1000) / 1000}});
  return list;
}

nlohmann::json match_document(const Matching& matching, const PointTransfer& transfer,
                              const std::vector<Point2>& points) {
  nlohmann::json places = nlohmann::json::array(), sigmas = places, confidences = places, reasons = places;
  for (const Point2& point : points) {
    const Transferred place = transfer(point);
    places.push_back(place.p ? nlohmann::json{place.p->x(), place.p->y()} : nlohmann::json());
    sigmas.push_back(place.p ? nlohmann::json(place.sigma) : nlohmann::json());
    confidences.push_back(place.confidence);
    reasons.push_back(place.reason);
  }
  return {{"pairs", pairs_document(matching.pairs)},
          {"runner_up", pairs_document(matching.runner_up)},
          {"margin", matching.margin},
          {"doubtful", matching.doubtful},
          {"same_building", std::round(matching.same_building * 1000) / 1000},
          {"next_pin", matching.next_pin_label_a ? nlohmann::json(*matching.next_pin_label_a) : nlohmann::json()},
          {"transfer", places},
          {"transfer_sigma_px", sigmas},
          {"transfer_confidence", confidences},
          {"transfer_reason", reasons}};
}

/// Both maps side by side, partners in one colour and joined by lines, worst ones red.
cv::Mat draw_matching(const Segmentation& a, const Segmentation& b, const Matching& matching) {
  const cv::Size size(a.labels.cols + b.labels.cols + 20, std::max(a.labels.rows, b.labels.rows));
  cv::Mat canvas(size, CV_8UC3, cv::Scalar(58, 52, 48));
  cv::Mat left = canvas(cv::Rect(0, 0, a.labels.cols, a.labels.rows));
  cv::Mat right = canvas(cv::Rect(a.labels.cols + 20, 0, b.labels.cols, b.labels.rows));
  left.setTo(cv::Scalar(150, 150, 150), a.labels != 0);
  right.setTo(cv::Scalar(150, 150, 150), b.labels != 0);
  for (const RegionPair& pair : matching.pairs) {
    if (pair.verdict == Verdict::kRejected) continue;
    left.setTo(cv::Scalar(region_colour(pair.label_a)), a.labels == pair.label_a);
    right.setTo(cv::Scalar(region_colour(pair.label_a)), b.labels == pair.label_b);
  }
  for (const RegionPair& pair : matching.pairs) {
    const Point2 p = a.regions[static_cast<size_t>(pair.label_a - 1)].anchor_px;
    const Point2 q = b.regions[static_cast<size_t>(pair.label_b - 1)].anchor_px;
    const cv::Scalar colour(60, 70 + 150 * pair.confidence, 230 - 170 * pair.confidence);
    if (pair.verdict != Verdict::kRejected)
      cv::line(canvas, cv::Point2d(p.x(), p.y()), cv::Point2d(q.x() + a.labels.cols + 20, q.y()), colour, 2,
               cv::LINE_AA);
  }
  return canvas;
}

Result<Ok> match_pictures(const MatchArguments& arguments) {
  const Result<std::vector<Pin>> pins = read_pins(arguments.pins);
  if (!pins) return pins.error();
  const Result<std::vector<Point2>> points = read_points(arguments.points);
  if (!points) return points.error();
  const Result<Segmentation> a = segment_file(arguments.sketch);
  if (!a) return a.error();
  const Result<Segmentation> b = segment_file(arguments.map);
  if (!b) return b.error();
  MatchParams params;
  params.allow_mirror = arguments.mirrored;
  if (arguments.method == "ursim") params.method = MatchMethod::kUrsim;
  if (arguments.method == "voronoi") params.method = MatchMethod::kVoronoi;
  const Result<Matching> matching = match(*a, *b, *pins, {}, params);
  if (!matching) return matching.error();
  const PointTransfer transfer(*a, *b, *matching, *pins);

  const std::filesystem::path output(arguments.output);
  const std::string stem = output.stem().string();
  nlohmann::json document = match_document(*matching, transfer, *points);
  document["sketch_labels"] = stem + "-sketch-labels.png";
  document["metric_labels"] = stem + "-map-labels.png";
  const Result<Ok> left = write_picture((output.parent_path() / (stem + "-sketch-labels.png")).string(), a->labels);
  if (!left) return left;
  const Result<Ok> right = write_picture((output.parent_path() / (stem + "-map-labels.png")).string(), b->labels);
  if (!right) return right;
  if (!arguments.preview.empty()) {
    const Result<Ok> drawn = write_picture(arguments.preview, draw_matching(*a, *b, *matching));
    if (!drawn) return drawn;
  }
  return write_text(arguments.output, document.dump());
}

}  // namespace

void add_match(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<MatchArguments>();
  auto* command = app.add_subcommand("match", "Find the same rooms on two maps and carry points from one to the other");
  command->add_option("sketch", arguments->sketch, "picture of the first map; free space is brighter than gray 250")
      ->required();
  command->add_option("map", arguments->map, "picture of the second map")->required();
  command->add_option("-o,--output", arguments->output, "match.json; label images are written beside it")->required();
  command->add_option("--pins", arguments->pins, "pins.json: what a person says is the same place");
  command->add_option("--points", arguments->points, "points.json: points of the first map to carry over");
  command->add_option("--preview", arguments->preview, "PNG with both maps and lines between partners");
  command->add_option("--method", arguments->method, "structure (default), or as published: ursim, voronoi")
      ->check(CLI::IsMember({"structure", "ursim", "voronoi"}));
  command->add_flag("--mirrored", arguments->mirrored, "the first map may be a mirror image");
  command->callback([arguments, &outcome] {
    const Result<Ok> done = match_pictures(*arguments);
    if (!done) outcome.no_answer(done.error());
  });
}

}  // namespace smokemap::app
