#include "segmentation/segment.hpp"

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/check.hpp"
#include "segmentation/constriction.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/straighten.hpp"
#include "segmentation/thickness.hpp"

namespace smokemap {
namespace {

constexpr size_t kMaxPixels = size_t{64} << 20;
constexpr size_t kMaxRegions = 65535;

/// Furniture hides how wide rooms are, so what counts as furniture is asked again once some of it is gone.
cv::Mat structure_of(const cv::Mat& free_space, double clutter_ratio) {
  cv::Mat structure = without_islands(free_space, 0);
  for (int round = 0; round < 3; ++round) {
    const double typical = typical_thickness(local_thickness(clearance_image(structure)));
    cv::Mat cleared = without_islands(free_space, clutter_ratio * typical);
    const bool is_stable = cv::countNonZero(cleared != structure) == 0;
    structure = cleared;
    if (is_stable) break;
  }
  return structure;
}

/// Parts of a region that a cut or furniture tore off become regions of their own.
cv::Mat connected_regions(const cv::Mat& labels) {
  cv::Mat result(labels.size(), CV_32SC1, cv::Scalar(0));
  std::vector<cv::Point> stack;
  int next = 0;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      if (labels.at<int>(y, x) == 0 || result.at<int>(y, x) != 0) continue;
      const int own = labels.at<int>(y, x);
      result.at<int>(y, x) = ++next;
      stack.assign(1, {x, y});
      while (!stack.empty()) {
        const cv::Point p = stack.back();
        stack.pop_back();
        for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
          const cv::Point n = p + step;
          if (n.x < 0 || n.y < 0 || n.x >= labels.cols || n.y >= labels.rows) continue;
          if (labels.at<int>(n) != own || result.at<int>(n) != 0) continue;
          result.at<int>(n) = next;
          stack.push_back(n);
        }
      }
    }
  return result;
}

/// Crumbs join the neighbour they touch most; crumbs that touch nothing join the nearest region, unless all are crumbs.
void sweep_crumbs(cv::Mat& labels, double least_area) {
  std::map<int, double> areas;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.at<int>(y, x); label != 0) areas[label] += 1;
  const auto largest = std::max_element(areas.begin(), areas.end(),
                                        [](const auto& one, const auto& two) { return one.second < two.second; });
  const double limit = std::min(least_area, largest->second);
  if (std::none_of(areas.begin(), areas.end(), [&](const auto& entry) { return entry.second < limit; })) return;
  cv::Mat to_room(labels.size(), CV_8UC1, cv::Scalar(255)), distance, nearest;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.at<int>(y, x); label != 0 && areas[label] >= limit)
        to_room.at<unsigned char>(y, x) = 0;
  cv::distanceTransform(to_room, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::map<int, int> label_of;  // of the room pixel that the transform numbered so
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (to_room.at<unsigned char>(y, x) == 0) label_of[nearest.at<int>(y, x)] = labels.at<int>(y, x);
  std::map<int, std::map<int, int>> wish;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.at<int>(y, x); label != 0 && areas[label] < limit)
        ++wish[label][label_of.at(nearest.at<int>(y, x))];
  std::map<int, int> joins;
  for (const auto& [crumb, votes] : wish)
    joins[crumb] = std::max_element(votes.begin(), votes.end(), [](const auto& one, const auto& two) {
                     return one.second < two.second;
                   })->first;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const auto join = joins.find(labels.at<int>(y, x)); join != joins.end()) labels.at<int>(y, x) = join->second;
}

cv::Mat constriction_method(const cv::Mat& free_space, const SegmentationParams& params) {
  const cv::Mat structure = structure_of(free_space, params.clutter_ratio);
  cv::Mat labels = straighten_borders(constriction_labels(structure, params), structure);
  labels.setTo(0, free_space != 255);
  labels = connected_regions(labels);
  const double typical = typical_thickness(local_thickness(clearance_image(structure)));
  sweep_crumbs(labels, params.min_room_ratio * typical * typical);
  return labels;
}

}  // namespace

Result<Ok> SegmentationParams::validate() const {
  return ParamCheck("SegmentationParams")
      .in_range("pinch_ratio", pinch_ratio, 0.1, 0.99)
      .in_range("step_ratio", step_ratio, 0.1, 0.99)
      .in_range("niche_depth", niche_depth, 0, 10)
      .in_range("door_depth", door_depth, 0, 100)
      .in_range("open_ratio", open_ratio, 0.1, 10)
      .in_range("min_room_ratio", min_room_ratio, 0, 100)
      .in_range("min_clearance_px", min_clearance_px, 0, 1000)
      .in_range("clutter_ratio", clutter_ratio, 0, 10)
      .result();
}

SegmentationParams segmentation_params(MapKind kind) {
  SegmentationParams params;
  if (kind == MapKind::kSketch) {
    params.step_ratio = 0.75;
    params.door_depth = 0.3;
    params.min_room_ratio = 0.05;
  }
  return params;
}

SegmentationParams matching_segmentation_params() {
  SegmentationParams params;
  params.min_room_ratio = 0.05;
  return params;
}

Result<Segmentation> segment(const cv::Mat& free_space, const SegmentationParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (free_space.empty() || free_space.type() != CV_8UC1)
    return fail(Errc::kInvalidArgument, "segmentation needs an 8 bit picture of free space with one channel");
  if (free_space.total() > kMaxPixels)
    return fail(Errc::kTooLarge, "the map has more than 64 megapixels: reduce it first");
  if (cv::countNonZero(free_space == 255) == 0) return fail(Errc::kDegenerate, "the map has no free space to split");
  const cv::Mat labels = constriction_method(free_space, params);
  Segmentation result = describe_regions(labels);
  if (result.regions.size() > kMaxRegions)
    return fail(Errc::kTooLarge, "the map falls into more than 65535 regions: it is noise, not rooms");
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
