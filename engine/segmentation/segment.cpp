#include "segmentation/segment.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/check.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/rooms.hpp"

namespace smokemap {
namespace {

constexpr double kUnsure = 0.5;  ///< confidence of a border that nearly was none, or that no cut accounts for

/// A border is as sure as the cut it came from is far from being refused, a region as its least sure border.
void add_confidence(const std::vector<ChosenCut>& cuts, Segmentation& segmentation) {
  for (RegionBorder& border : segmentation.borders) {
    border.confidence = kUnsure;
    border.is_door = false;
    const Point2 middle = border.line_px.midpoint();
    double nearest = 2 + 0.5 * border.width_px;
    for (const ChosenCut& chosen : cuts) {
      const cv::Point2d own = 0.5 * cv::Point2d(chosen.cut.a + chosen.cut.b);
      const double distance = (Point2(own.x, own.y) - middle).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      border.confidence = 1 - (1 - kUnsure) * chosen.cost;
      border.is_door = !chosen.is_mouth;
    }
    for (const int label : {border.label_a, border.label_b}) {
      double& region = segmentation.regions[static_cast<size_t>(label - 1)].confidence;
      region = std::min(region, border.confidence);
    }
  }
}

}  // namespace

Result<Ok> SegmentationParams::validate() const {
  ParamCheck check("SegmentationParams");
  check.in_range("door_ratio", door_ratio, 0.1, 0.99)
      .in_range("door_support", door_support, 0, 0.5)
      .in_range("niche_depth", niche_depth, 0, 10)
      .in_range("clutter_ratio", clutter_ratio, 0, 10)
      .in_range("tolerance_ratio", tolerance_ratio, 0, 1)
      .in_range("least_tolerance_px", least_tolerance_px, 0, 100)
      .in_range("longest_cut_ratio", longest_cut_ratio, 1, 1000);
  for (const BoundaryStyle* style : {&with_doors, &without_doors})
    check.in_range("mouth_ratio", style->mouth_ratio, 0, 2)
        .in_range("mouth_support", style->mouth_support, 0, 1)
        .in_range("passage_depth", style->passage_depth, 0, 10)
        .in_range("min_room_ratio", style->min_room_ratio, 0, 100);
  return check.result();
}

Result<Segmentation> segment(const cv::Mat& free_space, const SegmentationParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (const Result<Ok> sound = check_free_space(free_space); !sound) return sound.error();
  const Rooms rooms = find_rooms(free_space, params);
  Result<Segmentation> result = described(rooms.labels);
  if (result) add_confidence(rooms.cuts, *result);
  return result;
}

Result<Segmentation> segmentation_from_labels(const cv::Mat& labels) {
  if (labels.empty() || labels.type() != CV_16UC1)
    return fail(Errc::kInvalidArgument, "a label image has 16 bit and one channel");
  if (cv::countNonZero(labels) == 0) return fail(Errc::kDegenerate, "the label image has no region");
  cv::Mat wide;
  labels.convertTo(wide, CV_32S);
  return describe_regions(wide);
}

Result<cv::Mat> free_space_of_picture(const cv::Mat& picture, int threshold) {
  if (picture.empty()) return fail(Errc::kInvalidArgument, "the picture is empty");
  if (picture.depth() != CV_8U && picture.depth() != CV_16U)
    return fail(Errc::kInvalidArgument, "the picture must have 8 or 16 bit a channel");
  cv::Mat bytes = picture, gray;
  if (picture.depth() == CV_16U) picture.convertTo(bytes, CV_8U, 1.0 / 257);
  switch (bytes.channels()) {
    case 1:
      gray = bytes;
      break;
    case 3:
      cv::cvtColor(bytes, gray, cv::COLOR_BGR2GRAY);
      break;
    case 4:
      cv::cvtColor(bytes, gray, cv::COLOR_BGRA2GRAY);
      break;
    default:
      return fail(Errc::kInvalidArgument, "the picture must have 1, 3 or 4 channels");
  }
  return cv::Mat(gray > threshold);
}

}  // namespace smokemap
