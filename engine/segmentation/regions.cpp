#include "segmentation/regions.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
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

}  // namespace

std::vector<Contact> find_contacts(const cv::Mat& labels) {
  std::map<std::pair<int, int>, std::vector<cv::Point>> touching;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int own = labels.at<int>(y, x);
      if (own == 0) continue;
      for (const cv::Point n : {cv::Point(x + 1, y), cv::Point(x, y + 1)}) {
        if (n.x >= labels.cols || n.y >= labels.rows) continue;
        const int other = labels.at<int>(n);
        if (other == 0 || other == own) continue;
        std::vector<cv::Point>& pixels = touching[std::minmax(own, other)];
        pixels.emplace_back(x, y);
        pixels.push_back(n);
      }
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
      if (labels.at<int>(y, x) != 0) front.emplace_back(x, y);
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

}  // namespace smokemap
