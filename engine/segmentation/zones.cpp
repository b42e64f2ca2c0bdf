#include "segmentation/zones.hpp"

#include <algorithm>
#include <cmath>

#include "core/expect.hpp"

namespace smokemap {

double ZoneContact::chord() const { return std::min(std::hypot(box.width, box.height), static_cast<double>(length)); }

void ZoneContact::add(const cv::Point& pixel) {
  const cv::Rect own(pixel.x, pixel.y, 1, 1);
  box = length == 0 ? own : (box | own);
  ++length;
}

void ZoneContact::add(const ZoneContact& other) {
  box = length == 0 ? other.box : (box | other.box);
  length += other.length;
}

ZoneGraph::ZoneGraph(const cv::Mat& labels, const cv::Mat& clearance) {
  int last = 0, known = 0;
  Zone* zone = nullptr;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int id = labels.at<int>(y, x);
      if (id == 0) continue;
      last = std::max(last, id);
      if (id != known) zone = &zones_[known = id];
      zone->area += 1;
      if (!clearance.empty()) zone->peak = std::max(zone->peak, static_cast<double>(clearance.at<float>(y, x)));
      for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
        const cv::Point n(x + step.x, y + step.y);
        const bool inside = n.x >= 0 && n.y >= 0 && n.x < labels.cols && n.y < labels.rows;
        const int other = inside ? labels.at<int>(n) : 0;
        if (other != 0 && other != id) zone->contacts[other].add(cv::Point(x, y));
      }
    }
  parent_.resize(static_cast<size_t>(last) + 1);
  for (int id = 0; id <= last; ++id) parent_[static_cast<size_t>(id)] = id;
}

void ZoneGraph::merge(int from, int into) {
  ENGINE_EXPECT(from != into && zones_.contains(from) && zones_.contains(into));
  Zone gone = std::move(zones_.at(from));
  zones_.erase(from);
  Zone& kept = zones_.at(into);
  kept.area += gone.area;
  kept.peak = std::max(kept.peak, gone.peak);
  for (const auto& [other, contact] : gone.contacts) {
    if (other == into) continue;
    kept.contacts[other].add(contact);
    std::map<int, ZoneContact>& theirs = zones_.at(other).contacts;
    theirs[into].add(theirs.at(from));
    theirs.erase(from);
  }
  kept.contacts.erase(from);
  parent_[static_cast<size_t>(from)] = into;
}

int ZoneGraph::root(int id) const {
  while (parent_[static_cast<size_t>(id)] != id) {
    int& up = parent_[static_cast<size_t>(id)];
    up = parent_[static_cast<size_t>(up)];
    id = up;
  }
  return id;
}

void ZoneGraph::relabel(cv::Mat& labels) const {
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      int& id = labels.at<int>(y, x);
      if (id != 0) id = root(id);
    }
}

}  // namespace smokemap
