// Rooms by peeling. The local thickness is nearly constant inside a room and inside a corridor. First, basins: two wide
// places are parted where the clearance between them falls below `pinch_ratio` of the lesser one (a door). Then, within
// a basin and from the thickest place on, a room is everything connected to it that is at least `step_ratio` as thick;
// the thickest remaining place starts the next room (a corridor that opens into a hall has no door, only a step). Left
// over are corners, window recesses and door slots: pieces that are shallow compared with the opening through which
// they hang on to a neighbour. They are given back to it, shallowest first. Only ratios are used, so neither the
// resolution nor the largest hall matters.
#include "segmentation/constriction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "core/check.hpp"
#include "segmentation/furniture.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/straighten.hpp"
#include "segmentation/thickness.hpp"
#include "segmentation/zones.hpp"

namespace smokemap {
namespace {

constexpr std::array<std::array<int, 2>, 4> kSides = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// Pixels above zero, largest first (to 1/16 pixel), then row by row.
std::vector<cv::Point> by_falling_value(const cv::Mat& image) {
  double largest = 0;
  cv::minMaxLoc(image, nullptr, &largest);
  const auto bucket_of = [](float value) { return static_cast<size_t>(value * 16.0f); };
  std::vector<size_t> place(bucket_of(static_cast<float>(largest)) + 1, 0);
  for (int y = 0; y < image.rows; ++y)
    for (const float* value = image.ptr<float>(y); value != image.ptr<float>(y) + image.cols; ++value)
      if (*value > 0) ++place[bucket_of(*value)];
  size_t count = 0;
  for (auto bucket = place.rbegin(); bucket != place.rend(); ++bucket) {
    count += *bucket;
    *bucket = count - *bucket;  // where its first pixel goes
  }
  std::vector<cv::Point> order(count);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (const float value = image.ptr<float>(y)[x]; value > 0) order[place[bucket_of(value)]++] = {x, y};
  return order;
}

/// Basins of the clearance that are more than `pinch_ratio` deep. CV_32SC1, 0 = not free.
cv::Mat find_basins(const cv::Mat& clearance, const std::vector<cv::Point>& order, double pinch_ratio) {
  cv::Mat basins(clearance.size(), CV_32SC1, cv::Scalar(0));
  std::vector<int> parent(1, 0);
  std::vector<float> peak(1, 0);
  const auto root = [&](int id) {
    while (parent[static_cast<size_t>(id)] != id)
      id = parent[static_cast<size_t>(id)] = parent[static_cast<size_t>(parent[static_cast<size_t>(id)])];
    return id;
  };
  for (const cv::Point& p : order) {
    const float here = clearance.at<float>(p);
    int own = 0;
    for (const auto& side : kSides) {
      const cv::Point n(p.x + side[0], p.y + side[1]);
      if (n.x < 0 || n.y < 0 || n.x >= basins.cols || n.y >= basins.rows || basins.at<int>(n) == 0) continue;
      const int other = root(basins.at<int>(n));
      if (own == 0 || own == other) {
        own = other;
        continue;
      }
      const int high = peak[static_cast<size_t>(own)] >= peak[static_cast<size_t>(other)] ? own : other;
      const int low = high == own ? other : own;
      if (here >= static_cast<float>(pinch_ratio) * peak[static_cast<size_t>(low)])
        parent[static_cast<size_t>(low)] = high;
      own = high;
    }
    if (own == 0) {
      own = static_cast<int>(parent.size());
      parent.push_back(own);
      peak.push_back(here);
    }
    basins.at<int>(p) = own;
  }
  for (const cv::Point& p : order) basins.at<int>(p) = root(basins.at<int>(p));
  return basins;
}

/// Everything 4-connected to `seed` in its basin, not yet labelled and at least `least` thick, becomes `id`.
void flood(const cv::Mat& thickness, const cv::Mat& basins, cv::Point seed, float least, int id, cv::Mat& labels,
           std::vector<cv::Point>& stack) {
  stack.assign(1, seed);
  labels.at<int>(seed) = id;
  const int basin = basins.at<int>(seed);
  while (!stack.empty()) {
    const cv::Point p = stack.back();
    stack.pop_back();
    for (const auto& side : kSides) {
      const cv::Point n(p.x + side[0], p.y + side[1]);
      if (n.x < 0 || n.y < 0 || n.x >= labels.cols || n.y >= labels.rows) continue;
      if (labels.at<int>(n) != 0 || basins.at<int>(n) != basin || thickness.at<float>(n) < least) continue;
      labels.at<int>(n) = id;
      stack.push_back(n);
    }
  }
}

cv::Mat peel(const cv::Mat& clearance, const cv::Mat& thickness, const ConstrictionParams& params) {
  const std::vector<cv::Point> order = by_falling_value(thickness);
  const cv::Mat basins = find_basins(clearance, by_falling_value(clearance), params.pinch_ratio);
  cv::Mat labels(thickness.size(), CV_32SC1, cv::Scalar(0));
  std::vector<cv::Point> stack;
  int next = 0;
  for (const cv::Point& seed : order)
    if (labels.at<int>(seed) == 0) {
      const auto least = std::max(static_cast<float>(params.step_ratio) * thickness.at<float>(seed), 1e-6f);
      flood(thickness, basins, seed, least, ++next, labels, stack);
    }
  return labels;
}

struct Peeling {
  int zone = 0;
  int into = 0;
  double depth = std::numeric_limits<double>::infinity();  ///< depth over what is allowed; below 1 is absorbed
};

/// How shallow a zone is, and the neighbour it hangs on to.
Peeling peeled_depth(int id, const ZoneGraph& graph, double typical, const ConstrictionParams& params) {
  const Zone& zone = graph.zones().at(id);
  Peeling found{id, 0, std::numeric_limits<double>::infinity()};
  double widest = 0, highest = 0, second = 0;
  for (const auto& [other, contact] : zone.contacts) {
    const double peak = graph.zones().at(other).peak;
    second = std::max(second, std::min(highest, peak));
    highest = std::max(highest, peak);
    if (contact.length <= widest) continue;
    widest = contact.length;
    found.into = other;
  }
  if (zone.contacts.empty()) return found;
  const double chord = zone.contacts.at(found.into).chord();
  const double depth = zone.area / (chord * chord);
  const bool is_between_wider = zone.peak < params.pinch_ratio * second;
  found.depth = depth / (is_between_wider ? params.door_depth : params.niche_depth);
  // Wide open towards a neighbour of its own width: one corridor or room, parted by a wiggle of its walls.
  for (const auto& [other, contact] : zone.contacts) {
    const double peak = graph.zones().at(other).peak;
    const double narrower = std::min(zone.peak, peak), wider = std::max(zone.peak, peak);
    if (narrower < params.step_ratio * wider || contact.chord() < 2 * params.open_ratio * narrower) continue;
    const double closeness = 1 - 0.1 * narrower / wider;  // after the shallow ones, most alike first
    if (closeness < found.depth) found.depth = closeness, found.into = other;
  }
  const double least_area = params.min_room_ratio * typical * typical;
  if (zone.area < least_area || zone.peak < params.min_clearance_px)
    found.depth = std::min(found.depth, zone.area / (least_area + zone.area + 1));
  return found;
}

/// Gives shallow zones to their neighbours, shallowest first; what a merge changes is looked at again.
void give_back_shallow(ZoneGraph& graph, double typical, const ConstrictionParams& params) {
  using Key = std::tuple<double, double, int>;  // depth, area, zone
  std::set<Key> queue;
  std::map<int, Key> keys;
  const auto refresh = [&](int id) {
    if (const auto old = keys.find(id); old != keys.end()) queue.erase(old->second);
    const Zone& zone = graph.zones().at(id);
    const Key key{peeled_depth(id, graph, typical, params).depth, zone.area, id};
    keys[id] = key;
    queue.insert(key);
  };
  for (const auto& [id, zone] : graph.zones()) refresh(id);
  while (!queue.empty() && std::get<0>(*queue.begin()) < 1) {
    const int id = std::get<2>(*queue.begin());
    const int into = peeled_depth(id, graph, typical, params).into;
    queue.erase(queue.begin());
    keys.erase(id);
    graph.merge(id, into);
    refresh(into);
    for (const auto& [other, contact] : graph.zones().at(into).contacts) refresh(other);
  }
}

/// Regions up to, and without, straight borders.
struct RoughRegions {
  cv::Mat labels;  ///< CV_32SC1, 0 = not free, ids from 1 without order
  double typical_thickness_px = 0;
};

RoughRegions find_rough_regions(const cv::Mat& structure, const ConstrictionParams& params) {
  const cv::Mat clearance = clearance_image(structure);
  const cv::Mat thickness = local_thickness(clearance);
  RoughRegions rough{peel(clearance, thickness, params), typical_thickness(thickness)};
  ZoneGraph graph(rough.labels, clearance);
  give_back_shallow(graph, rough.typical_thickness_px, params);
  graph.relabel(rough.labels);
  return rough;
}

}  // namespace

Result<Ok> ConstrictionParams::validate() const {
  return ParamCheck("ConstrictionParams")
      .in_range("pinch_ratio", pinch_ratio, 0.1, 0.99)
      .in_range("step_ratio", step_ratio, 0.1, 0.99)
      .in_range("niche_depth", niche_depth, 0, 10)
      .in_range("door_depth", door_depth, 0, 100)
      .in_range("open_ratio", open_ratio, 0.1, 10)
      .in_range("min_room_ratio", min_room_ratio, 0, 100)
      .in_range("min_clearance_px", min_clearance_px, 0, 1000)
      .in_range("crumb_ratio", crumb_ratio, 0, 1)
      .in_range("clutter_ratio", clutter_ratio, 0, 10)
      .result();
}

ConstrictionParams matching_segmentation_params() {
  ConstrictionParams params;
  params.min_room_ratio = 0.05;
  params.crumb_ratio = 0.01;
  return params;
}

Result<Segmentation> segment_by_constrictions(const cv::Mat& free_space, const ConstrictionParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (const Result<Ok> sound = check_free_space(free_space); !sound) return sound.error();
  const cv::Mat structure = structure_of(free_space, params.clutter_ratio).free_space;
  const RoughRegions rough = find_rough_regions(structure, params);
  cv::Mat labels = straighten_borders(rough.labels, structure);
  labels.setTo(0, free_space != 255);
  labels = connected_regions(labels);
  double regions = 0;
  cv::minMaxLoc(labels, nullptr, &regions);
  const double least_room = params.min_room_ratio * rough.typical_thickness_px * rough.typical_thickness_px;
  sweep_crumbs(labels, std::max(least_room, params.crumb_ratio * cv::countNonZero(labels) / regions));
  return described(labels);
}

}  // namespace smokemap
