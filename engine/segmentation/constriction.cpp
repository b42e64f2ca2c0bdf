// Rooms by peeling. The local thickness is nearly constant inside a room and inside a corridor. Starting from the thickest
// place, a room is everything connected to it that is at least `door_ratio` as thick; then the thickest remaining place
// starts the next room. Left over are corners, window recesses and door slots: pieces that are shallow compared with the
// opening through which they hang on to a neighbour. They are given back to it, shallowest first.
// Only ratios are used, so neither the resolution nor the largest hall matters.
#include "segmentation/constriction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "segmentation/thickness.hpp"
#include "segmentation/zones.hpp"

namespace smokemap {
namespace {

/// Everything 4-connected to `seed`, not yet labelled and at least `least` thick, becomes `id`.
void flood(const cv::Mat& thickness, cv::Point seed, float least, int id, cv::Mat& labels,
           std::vector<cv::Point>& stack) {
  stack.assign(1, seed);
  labels.at<int>(seed) = id;
  while (!stack.empty()) {
    const cv::Point p = stack.back();
    stack.pop_back();
    for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
      const cv::Point n = p + step;
      if (n.x < 0 || n.y < 0 || n.x >= labels.cols || n.y >= labels.rows) continue;
      if (labels.at<int>(n) != 0 || thickness.at<float>(n) < least) continue;
      labels.at<int>(n) = id;
      stack.push_back(n);
    }
  }
}

/// Free pixels, thickest first (to 1/16 pixel), then row by row.
std::vector<cv::Point> by_falling_thickness(const cv::Mat& thickness) {
  double largest = 0;
  cv::minMaxLoc(thickness, nullptr, &largest);
  const auto bucket_of = [](float value) { return static_cast<size_t>(value * 16.0f); };
  std::vector<std::vector<cv::Point>> buckets(bucket_of(static_cast<float>(largest)) + 1);
  for (int y = 0; y < thickness.rows; ++y)
    for (int x = 0; x < thickness.cols; ++x)
      if (const float value = thickness.at<float>(y, x); value > 0) buckets[bucket_of(value)].emplace_back(x, y);
  std::vector<cv::Point> order;
  order.reserve(thickness.total());
  for (auto bucket = buckets.rbegin(); bucket != buckets.rend(); ++bucket)
    order.insert(order.end(), bucket->begin(), bucket->end());
  return order;
}

cv::Mat peel(const cv::Mat& thickness, double door_ratio) {
  const std::vector<cv::Point> order = by_falling_thickness(thickness);
  cv::Mat labels(thickness.size(), CV_32SC1, cv::Scalar(0));
  std::vector<cv::Point> stack;
  int next = 0;
  for (const cv::Point& seed : order)
    if (labels.at<int>(seed) == 0) {
      const auto least = std::max(static_cast<float>(door_ratio) * thickness.at<float>(seed), 1e-6f);
      flood(thickness, seed, least, ++next, labels, stack);
    }
  return labels;
}

struct Absorption {
  int zone = 0;
  int into = 0;
  double depth = std::numeric_limits<double>::infinity();  ///< depth over what is allowed; below 1 is absorbed
};

/// How shallow a zone is, and the neighbour it hangs on to.
Absorption shallowness(int id, const Zone& zone, double typical, const SegmentationParams& params) {
  Absorption found{id, 0, std::numeric_limits<double>::infinity()};
  double widest = 0, sum = 0;
  for (const auto& [other, contact] : zone.contacts) {
    const double chord = contact.chord();
    sum += contact.length;
    if (contact.length > widest) {
      widest = contact.length;
      found.into = other;
      found.depth = zone.area / (chord * chord) / params.niche_depth;
    }
  }
  if (zone.contacts.empty()) return found;
  if (zone.contacts.size() >= 2) {
    const double share = sum / (sum + zone.wall_sides);
    found.depth = std::min(found.depth, params.door_contact / std::max(share, 1e-9));
  }
  const double least_area = params.min_room_ratio * typical * typical;
  if (zone.area < least_area || zone.peak < params.min_clearance_px)
    found.depth = std::min(found.depth, zone.area / (least_area + zone.area + 1));
  return found;
}

/// Gives shallow zones to their neighbours, shallowest first; what a merge changes is looked at again.
void absorb_shallow(ZoneGraph& graph, double typical, const SegmentationParams& params) {
  using Key = std::tuple<double, double, int>;  // depth, area, zone
  std::set<Key> queue;
  std::map<int, Key> keys;
  const auto refresh = [&](int id) {
    if (const auto old = keys.find(id); old != keys.end()) queue.erase(old->second);
    const Zone& zone = graph.zones().at(id);
    const Key key{shallowness(id, zone, typical, params).depth, zone.area, id};
    keys[id] = key;
    queue.insert(key);
  };
  for (const auto& [id, zone] : graph.zones()) refresh(id);
  while (!queue.empty() && std::get<0>(*queue.begin()) < 1) {
    const int id = std::get<2>(*queue.begin());
    const int into = shallowness(id, graph.zones().at(id), typical, params).into;
    queue.erase(queue.begin());
    keys.erase(id);
    graph.merge(id, into);
    refresh(into);
    for (const auto& [other, contact] : graph.zones().at(into).contacts) refresh(other);
  }
}

}  // namespace

cv::Mat constriction_labels(const cv::Mat& structure, const SegmentationParams& params) {
  const cv::Mat thickness = local_thickness(clearance_image(structure));
  cv::Mat labels = peel(thickness, params.door_ratio);
  ZoneGraph graph(labels, thickness);
  absorb_shallow(graph, median_thickness(thickness), params);
  graph.relabel(labels);
  return labels;
}

}  // namespace smokemap
