#include "segmentation/rooms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>

#include "segmentation/furniture.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/zones.hpp"

namespace smokemap {
namespace {

constexpr int kRim_px = 2;          ///< not-free margin round the picture, so that no step looks outside
constexpr double kLeastArea = 0.1;  ///< of a candidate for a room, in squares of the usual thickness
constexpr double kThinnest_px = 3;  ///< usual thickness from which rays of one or two pixels are noise

/// Free space with a rim and without rays and gaps of one or two pixels.
cv::Mat smooth(const Structure& structure) {
  cv::Mat padded;
  cv::copyMakeBorder(structure.free_space, padded, kRim_px, kRim_px, kRim_px, kRim_px, cv::BORDER_CONSTANT,
                     cv::Scalar(0));
  if (structure.thickness_px <= kThinnest_px) return padded;
  cv::Mat opened;
  cv::morphologyEx(padded, opened, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  return opened;
}

/// How shallow a zone is, and the neighbour it would belong to.
struct Absorption {
  int into = 0;
  double depth = std::numeric_limits<double>::infinity();  ///< over what is asked of a room; below 1 is none
};

Absorption shallowness(const Zone& zone, double niche_depth, double passage_depth, double least_area) {
  Absorption found;
  double widest = 0;
  for (const auto& [other, contact] : zone.contacts)
    if (contact.chord() > widest) widest = contact.chord(), found.into = other;
  if (found.into == 0) return found;
  found.depth = zone.area / (widest * widest) / (zone.contacts.size() > 1 ? passage_depth : niche_depth);
  if (zone.area < least_area) found.depth = std::min(found.depth, 0.99 * zone.area / least_area);
  return found;
}

/// Gives niches, door slots and other pieces that are no rooms to their neighbours, shallowest first; what a merge
/// changes is looked at again.
void absorb_shallow(ZoneGraph& graph, double niche_depth, double passage_depth, double least_area) {
  using Key = std::tuple<double, double, int>;  // depth, area, zone
  std::set<Key> queue;
  std::map<int, Key> keys;
  const auto look = [&](int id) { return shallowness(graph.zones().at(id), niche_depth, passage_depth, least_area); };
  const auto refresh = [&](int id) {
    if (const auto old = keys.find(id); old != keys.end()) queue.erase(old->second);
    keys[id] = {look(id).depth, graph.zones().at(id).area, id};
    queue.insert(keys[id]);
  };
  for (const auto& [id, zone] : graph.zones()) refresh(id);
  while (!queue.empty() && std::get<0>(*queue.begin()) < 1) {
    const int id = std::get<2>(*queue.begin());
    const int into = look(id).into;
    queue.erase(queue.begin());
    keys.erase(id);
    graph.merge(id, into);
    refresh(into);
    for (const auto& [other, contact] : graph.zones().at(into).contacts) refresh(other);
  }
}

/// Free space in which every piece between the chosen cuts has its own label, the cuts themselves included.
cv::Mat label_pieces(const cv::Mat& smoothed, const cv::Mat& structure, const std::vector<ChosenCut>& cuts) {
  cv::Mat parted = smoothed.clone(), labels;
  for (const ChosenCut& chosen : cuts) draw_cut(chosen.cut, parted);
  const int count = cv::connectedComponents(parted, labels, 4, CV_32S);
  labels = labels(cv::Rect(kRim_px, kRim_px, structure.cols, structure.rows)).clone();
  grow_labels(structure, labels);
  label_rest(structure, count, labels);
  return labels;
}

}  // namespace

Rooms find_rooms(const cv::Mat& free_space, const SegmentationParams& params) {
  const Structure structure = structure_of(free_space, params.clutter_ratio);
  const cv::Mat smoothed = smooth(structure);
  CutSearch search;
  search.longest_px = params.longest_cut_ratio * structure.thickness_px;
  search.tolerance_px = std::max(params.least_tolerance_px, params.tolerance_ratio * structure.thickness_px);
  const std::vector<WallRing> rings = trace_wall_rings(smoothed, search.tolerance_px);
  const double square = structure.thickness_px * structure.thickness_px;
  CutChoice choice = choose_cuts(candidate_cuts(smoothed, rings, search), smoothed, kLeastArea * square, params);

  Rooms rooms{label_pieces(smoothed, structure.free_space, choice.cuts), std::move(choice.cuts)};
  const BoundaryStyle& style = choice.has_doors ? params.with_doors : params.without_doors;
  const double least_area = style.min_room_ratio * square;
  ZoneGraph graph(rooms.labels);
  absorb_shallow(graph, params.niche_depth, style.passage_depth, least_area);
  graph.relabel(rooms.labels);
  rooms.labels.setTo(0, free_space != 255);
  rooms.labels = connected_regions(rooms.labels);
  sweep_crumbs(rooms.labels, least_area);
  return rooms;
}

}  // namespace smokemap
