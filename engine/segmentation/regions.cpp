#include "segmentation/regions.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <unordered_map>
#include <utility>

#include "segmentation/thickness.hpp"

namespace smokemap {
namespace {

constexpr double kCorridorElongation = 3.0;  ///< length over width from which a region counts as a corridor

struct Tally {
  int old_label = 0;
  double area = 0;
  double sum_x = 0, sum_y = 0;
  cv::Point first;
};

std::vector<Tally> tally_labels(const cv::Mat& labels) {
  std::unordered_map<int, size_t> index;
  std::vector<Tally> tallies;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int label = labels.at<int>(y, x);
      if (label == 0) continue;
      const auto [slot, is_new] = index.try_emplace(label, tallies.size());
      if (is_new) tallies.push_back({label, 0, 0, 0, {x, y}});
      Tally& tally = tallies[slot->second];
      tally.area += 1;
      tally.sum_x += x;
      tally.sum_y += y;
    }
  std::stable_sort(tallies.begin(), tallies.end(),
                   [](const Tally& one, const Tally& two) { return one.area > two.area; });
  return tallies;
}

/// Distance to the nearest pixel of another label, wall or the picture's edge.
cv::Mat clearance_within_regions(const cv::Mat& labels) {
  cv::Mat inner(labels.size(), CV_8UC1, cv::Scalar(0));
  for (int y = 1; y + 1 < labels.rows; ++y)
    for (int x = 1; x + 1 < labels.cols; ++x) {
      const int own = labels.at<int>(y, x);
      const bool is_inner = own != 0 && labels.at<int>(y - 1, x) == own && labels.at<int>(y + 1, x) == own &&
                            labels.at<int>(y, x - 1) == own && labels.at<int>(y, x + 1) == own;
      if (is_inner) inner.at<unsigned char>(y, x) = 255;
    }
  return clearance_image(inner);
}

void find_anchors(const cv::Mat& labels16, std::vector<Region>& regions, const cv::Mat& clearance) {
  std::vector<float> best(regions.size(), -1.0f);
  for (int y = 0; y < labels16.rows; ++y)
    for (int x = 0; x < labels16.cols; ++x) {
      const int label = labels16.at<unsigned short>(y, x);
      if (label == 0) continue;
      const auto i = static_cast<size_t>(label - 1);
      if (clearance.at<float>(y, x) <= best[i]) continue;
      best[i] = clearance.at<float>(y, x);
      regions[i].anchor_px = Point2(x, y);
      regions[i].clearance_px = best[i] + 1.0;
    }
  for (Region& region : regions) {
    const double width = 2 * region.clearance_px;
    region.kind = region.area_px / (width * width) >= kCorridorElongation ? RegionKind::kCorridor : RegionKind::kRoom;
  }
}

/// The two pixels of a run that are farthest apart, found by walking to the farthest twice.
Segment2 longest_chord(const std::vector<cv::Point>& pixels) {
  const auto farthest_from = [&](const cv::Point& from) {
    return *std::max_element(pixels.begin(), pixels.end(), [&](const cv::Point& one, const cv::Point& two) {
      return (one - from).dot(one - from) < (two - from).dot(two - from);
    });
  };
  const cv::Point a = farthest_from(pixels.front());
  const cv::Point b = farthest_from(a);
  return {Point2(a.x, a.y), Point2(b.x, b.y)};
}

bool has_bare_neighbour(const cv::Mat& free_space, const cv::Mat& labels, int x, int y) {
  const auto is_bare = [&](int nx, int ny) {
    const bool inside = nx >= 0 && ny >= 0 && nx < labels.cols && ny < labels.rows;
    return inside && labels.at<int>(ny, nx) == 0 && free_space.at<unsigned char>(ny, nx) == 255;
  };
  return is_bare(x - 1, y) || is_bare(x + 1, y) || is_bare(x, y - 1) || is_bare(x, y + 1);
}

}  // namespace

std::vector<Contact> find_contacts(const cv::Mat& labels) {
  std::map<std::pair<int, int>, std::vector<cv::Point>> touching;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int* here = labels.ptr<int>(y) + x;
      if (*here == 0) continue;
      const auto touch = [&](int other, const cv::Point& n) {
        if (other == 0 || other == *here) return;
        std::vector<cv::Point>& pixels = touching[std::minmax(*here, other)];
        pixels.emplace_back(x, y);
        pixels.push_back(n);
      };
      if (x + 1 < labels.cols) touch(here[1], {x + 1, y});
      if (y + 1 < labels.rows) touch(labels.ptr<int>(y + 1)[x], {x, y + 1});
    }
  std::vector<Contact> contacts;
  for (auto& [pair, pixels] : touching) {
    const cv::Rect box = cv::boundingRect(pixels);
    cv::Mat mask(box.size(), CV_8UC1, cv::Scalar(0)), runs;
    for (const cv::Point& p : pixels) mask.at<unsigned char>(p - box.tl()) = 255;
    const int count = cv::connectedComponents(mask, runs, 8, CV_32S);
    std::vector<Contact> parts(static_cast<size_t>(count - 1), Contact{pair.first, pair.second, {}});
    for (int y = 0; y < runs.rows; ++y)
      for (int x = 0; x < runs.cols; ++x)
        if (const int run = runs.at<int>(y, x); run > 0)
          parts[static_cast<size_t>(run - 1)].pixels.push_back(cv::Point(x, y) + box.tl());
    contacts.insert(contacts.end(), parts.begin(), parts.end());
  }
  return contacts;
}

void grow_labels(const cv::Mat& free_space, cv::Mat& labels) {
  std::deque<cv::Point> front;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels.at<int>(y, x) != 0 && has_bare_neighbour(free_space, labels, x, y)) front.emplace_back(x, y);
  while (!front.empty()) {
    const cv::Point p = front.front();
    front.pop_front();
    for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
      const cv::Point n = p + step;
      if (n.x < 0 || n.y < 0 || n.x >= labels.cols || n.y >= labels.rows) continue;
      if (labels.at<int>(n) != 0 || free_space.at<unsigned char>(n) != 255) continue;
      labels.at<int>(n) = labels.at<int>(p);
      front.push_back(n);
    }
  }
}

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

void sweep_crumbs(cv::Mat& labels, double least_area) {
  double last = 0;
  cv::minMaxLoc(labels, nullptr, &last);
  std::vector<double> areas(static_cast<size_t>(last) + 1, 0);
  for (int y = 0; y < labels.rows; ++y)
    for (const int* label = labels.ptr<int>(y); label != labels.ptr<int>(y) + labels.cols; ++label)
      areas[static_cast<size_t>(*label)] += 1;
  areas[0] = 0;
  const double limit = std::min(least_area, *std::max_element(areas.begin(), areas.end()));
  const auto is_crumb = [&](int label) { return label != 0 && areas[static_cast<size_t>(label)] < limit; };
  if (std::none_of(areas.begin() + 1, areas.end(), [&](double area) { return area > 0 && area < limit; })) return;
  cv::Mat to_room(labels.size(), CV_8UC1, cv::Scalar(255)), distance, nearest;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.ptr<int>(y)[x]; label != 0 && !is_crumb(label)) to_room.ptr(y)[x] = 0;
  cv::distanceTransform(to_room, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<int> label_of(labels.total() + 1, 0);  // of the room pixel that the transform numbered so
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (to_room.ptr(y)[x] == 0) label_of[static_cast<size_t>(nearest.ptr<int>(y)[x])] = labels.ptr<int>(y)[x];
  std::map<int, std::map<int, int>> wish;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int label = labels.ptr<int>(y)[x]; is_crumb(label))
        ++wish[label][label_of[static_cast<size_t>(nearest.ptr<int>(y)[x])]];
  std::vector<int> joins(areas.size());
  std::iota(joins.begin(), joins.end(), 0);
  for (const auto& [crumb, votes] : wish)
    joins[static_cast<size_t>(crumb)] =
        std::max_element(votes.begin(), votes.end(), [](const auto& one, const auto& two) {
          return one.second < two.second;
        })->first;
  for (int y = 0; y < labels.rows; ++y)
    for (int* label = labels.ptr<int>(y); label != labels.ptr<int>(y) + labels.cols; ++label)
      *label = joins[static_cast<size_t>(*label)];
}

void label_rest(const cv::Mat& free_space, int next, cv::Mat& labels) {
  cv::Mat rest = (labels == 0) & (free_space == 255), pieces;
  cv::connectedComponents(rest, pieces, 4, CV_32S);
  labels += pieces;
  cv::Mat shift(labels.size(), CV_32SC1, cv::Scalar(0));
  shift.setTo(next, rest);
  labels += shift;
}

Segmentation describe_regions(const cv::Mat& labels) {
  Segmentation result;
  const std::vector<Tally> tallies = tally_labels(labels);
  std::unordered_map<int, int> renumber;
  for (const Tally& tally : tallies) {
    Region region;
    region.label = static_cast<int>(result.regions.size()) + 1;
    region.area_px = tally.area;
    region.centroid_px = Point2(tally.sum_x, tally.sum_y) / tally.area;
    renumber[tally.old_label] = region.label;
    result.regions.push_back(region);
  }
  cv::Mat ordered(labels.size(), CV_32SC1, cv::Scalar(0));
  int last_old = 0, last_new = 0;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int old = labels.at<int>(y, x);
      if (old == 0) continue;
      if (old != last_old) last_new = renumber.at(last_old = old);
      ordered.at<int>(y, x) = last_new;
    }
  ordered.convertTo(result.labels, CV_16U);
  find_anchors(result.labels, result.regions, clearance_within_regions(ordered));
  for (const Contact& contact : find_contacts(ordered)) {
    const Segment2 line = longest_chord(contact.pixels);
    result.borders.push_back({contact.label_a, contact.label_b, line, line.length()});
  }
  return result;
}

Result<Ok> check_free_space(const cv::Mat& free_space) {
  constexpr size_t kMaxPixels = size_t{64} << 20;
  if (free_space.empty() || free_space.type() != CV_8UC1)
    return fail(Errc::kInvalidArgument, "segmentation needs an 8 bit picture of free space with one channel");
  if (free_space.total() > kMaxPixels)
    return fail(Errc::kTooLarge, "the map has more than 64 megapixels: reduce it first");
  if (cv::countNonZero(free_space == 255) == 0) return fail(Errc::kDegenerate, "the map has no free space to split");
  return Ok{};
}

Result<Segmentation> described(const cv::Mat& labels) {
  Segmentation result = describe_regions(labels);
  if (result.regions.size() > kMostRegions)
    return fail(Errc::kTooLarge, "the map falls into more than 65535 regions: it is noise, not rooms");
  return result;
}

}  // namespace smokemap
