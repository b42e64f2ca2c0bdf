// The fuzzy opening gives every pixel the radius of the largest disc of free space over it. Its levels form zones.
// Zones that follow the outline of another one are ripples of its rim and fall to it, but the edge they leave behind
// remembers how low they were: across a door nothing is merged. Then zones of similar value flow together, from the
// highest down.
#include "segmentation/maoris.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/check.hpp"
#include "segmentation/regions.hpp"
#include "segmentation/thickness.hpp"

namespace smokemap {
namespace {

constexpr size_t kMaxMaorisPixels = size_t{16} << 20;
constexpr int kLevelStep = 5;
constexpr int kDiscOffset_px = 1;
constexpr int kNoMinimum = 256;

struct Passage {
  int minimum = kNoMinimum;  ///< lowest value of the zones that were fused between the two
  bool is_breakable = true;
};

struct OpeningZone {
  int value = 0;
  int area = 0;
  std::vector<cv::Point> outline;  ///< pixels with a side to another zone or a wall
  std::map<int, Passage> passages;
};

class OpeningGraph {
 public:
  OpeningGraph(const cv::Mat& levels, const MaorisParams& params) : params_(params) {
    collect_zones(levels);
    for (int y = 0; y < labels_.rows; ++y)
      for (int x = 0; x < labels_.cols; ++x) look_at(x, y);
  }

  cv::Mat segment() {
    absorb_smaller(params_.least_zone_px);
    remove_ripples();
    mark_doors();
    flow_together();
    absorb_doors();
    absorb_smaller(params_.least_room_px);
    for (auto label = labels_.begin<int>(); label != labels_.end<int>(); ++label) *label = root(*label);
    return labels_;
  }

 private:
  /// 4-connected areas of one level.
  void collect_zones(const cv::Mat& levels) {
    labels_ = cv::Mat(levels.size(), CV_32SC1, cv::Scalar(0));
    parent_.assign(1, 0);
    for (int y = 0; y < levels.rows; ++y)
      for (int x = 0; x < levels.cols; ++x) {
        const int level = levels.at<unsigned char>(y, x);
        if (level == 0 || labels_.at<int>(y, x) != 0) continue;
        const int id = static_cast<int>(parent_.size());
        parent_.push_back(id);
        zones_[id].value = level;
        fill(levels, {x, y}, id);
      }
  }

  void fill(const cv::Mat& levels, const cv::Point& seed, int id) {
    std::vector<cv::Point> stack(1, seed);
    labels_.at<int>(seed) = id;
    while (!stack.empty()) {
      const cv::Point p = stack.back();
      stack.pop_back();
      ++zones_[id].area;
      for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
        const cv::Point n = p + step;
        if (label_at(n) != 0 || !is_inside(n) || levels.at<unsigned char>(n) != zones_[id].value) continue;
        labels_.at<int>(n) = id;
        stack.push_back(n);
      }
    }
  }

  bool is_inside(const cv::Point& p) const { return p.x >= 0 && p.y >= 0 && p.x < labels_.cols && p.y < labels_.rows; }
  int label_at(const cv::Point& p) const { return is_inside(p) ? labels_.at<int>(p) : 0; }
  int zone_at(const cv::Point& p) const { return root(label_at(p)); }

  int root(int id) const {
    while (parent_[static_cast<size_t>(id)] != id) {
      int& up = parent_[static_cast<size_t>(id)];
      id = up = parent_[static_cast<size_t>(up)];
    }
    return id;
  }

  void look_at(int x, int y) {
    const int id = labels_.at<int>(y, x);
    if (id == 0) return;
    OpeningZone& zone = zones_[id];
    bool is_outline = false;
    for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
      const int other = label_at(cv::Point(x, y) + step);
      is_outline = is_outline || other != id;
      if (other != 0 && other != id) zone.passages[other];
    }
    if (is_outline) zone.outline.emplace_back(x, y);
  }

  bool is_on_outline(const cv::Point& p, int id) const {
    return zone_at(p + cv::Point(1, 0)) != id || zone_at(p + cv::Point(0, 1)) != id ||
           zone_at(p - cv::Point(1, 0)) != id || zone_at(p - cv::Point(0, 1)) != id;
  }

  /// Share of the outline that has a pixel of the neighbour within 3x3, for every neighbour.
  std::map<int, double> contact_shares(int id) const {
    std::map<int, double> shares;
    const OpeningZone& zone = zones_.at(id);
    for (const cv::Point& p : zone.outline) {
      std::set<int> near;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) near.insert(zone_at(p + cv::Point(dx, dy)));
      for (const int other : near)
        if (other != 0 && other != id) shares[other] += 1;
    }
    for (auto& [other, share] : shares)
      share = std::floor(100 * share / static_cast<double>(zone.outline.size())) / 100;
    return shares;
  }

  /// `from` becomes part of `into`, which keeps its value. Passages remember `low`.
  void fuse(int from, int into, int low) {
    OpeningZone gone = std::move(zones_.at(from));
    zones_.erase(from);
    OpeningZone& kept = zones_.at(into);
    kept.area += gone.area;
    for (auto& [other, passage] : gone.passages) {
      zones_.at(other).passages.erase(from);
      if (other == into) continue;
      Passage& merged = kept.passages[other];
      merged.minimum = std::min({merged.minimum, passage.minimum, low});
      merged.is_breakable = merged.is_breakable && passage.is_breakable;
      zones_.at(other).passages[into] = merged;
    }
    parent_[static_cast<size_t>(from)] = into;
    kept.outline.insert(kept.outline.end(), gone.outline.begin(), gone.outline.end());
    std::erase_if(kept.outline, [&](const cv::Point& p) { return !is_on_outline(p, into); });
  }

  /// Zones too small fall to the neighbour closest in value.
  void absorb_smaller(int least) {
    std::vector<int> small;
    for (const auto& [id, zone] : zones_)
      if (zone.area < least) small.push_back(id);
    for (const int id : small)
      if (const int into = closest(id, [](int) { return true; }); into != 0 && zones_.at(id).area < least)
        fuse(id, into, kNoMinimum);
  }

  template <typename Allowed>
  int closest(int id, Allowed allowed) const {
    const OpeningZone& zone = zones_.at(id);
    int best = 0, least = std::numeric_limits<int>::max();
    for (const auto& [other, passage] : zone.passages) {
      const int difference = std::abs(zones_.at(other).value - zone.value);
      if (difference < least && allowed(other)) best = other, least = difference;
    }
    return best;
  }

  /// Highest first; of equal ones the smallest, then the one found last. Neighbours of what was fused come again at the
  /// end of the queue.
  void remove_ripples() {
    std::vector<int> order;
    for (const auto& [id, zone] : zones_) order.push_back(id);
    std::sort(order.begin(), order.end(), [&](int one, int two) {
      const OpeningZone &a = zones_.at(one), &b = zones_.at(two);
      return std::make_tuple(-a.value, a.area, -one) < std::make_tuple(-b.value, b.area, -two);
    });
    std::deque<int> queue(order.begin(), order.end());
    std::set<int> pending(order.begin(), order.end());
    while (!queue.empty()) {
      const int id = queue.front();
      queue.pop_front();
      pending.erase(id);
      if (!zones_.contains(id)) continue;
      const std::map<int, double> shares = contact_shares(id);
      const int into = closest(id, [&](int other) {
        const auto share = shares.find(other);
        return share != shares.end() && share->second >= params_.ripple_share;
      });
      if (into == 0) continue;
      const std::map<int, Passage> passages = zones_.at(id).passages;
      fuse(id, into, zones_.at(id).value);
      for (const auto& [other, passage] : passages)
        if (pending.insert(other).second) queue.push_back(other);
    }
  }

  void mark_doors() {
    for (auto& [id, zone] : zones_)
      for (auto& [other, passage] : zone.passages) {
        const double higher = std::max(zone.value, zones_.at(other).value);
        passage.is_breakable = passage.minimum > higher * (1 - params_.threshold);
      }
  }

  bool alike(int one, int two) const {
    const double low = std::min(zones_.at(one).value, zones_.at(two).value);
    return low >= std::max(zones_.at(one).value, zones_.at(two).value) * (1 - params_.threshold);
  }

  /// A third zone beside one of them that is like the other.
  bool has_mediator(int current, int next) const {
    for (const auto& [from, to] : {std::pair(next, current), std::pair(current, next)})
      for (const auto& [other, passage] : zones_.at(from).passages)
        if (other != to && passage.is_breakable && alike(other, to)) return true;
    return false;
  }

  bool flows(int current, int next) const {
    const double low = std::min(zones_.at(current).value, zones_.at(next).value);
    const double high = std::max(zones_.at(current).value, zones_.at(next).value);
    if (alike(current, next)) return true;
    return low >= high * (1 - params_.threshold - params_.margin) && has_mediator(current, next);
  }

  /// From the highest zones down, everything that hangs together by similar values becomes one.
  void flow_together() {
    std::set<std::tuple<int, int, int>> seeds;  // minus value, minus area, minus zone
    for (const auto& [id, zone] : zones_) seeds.insert({-zone.value, -zone.area, -id});
    std::map<int, int> room_of;
    for (const auto& [value, area, minus_seed] : seeds) {
      const int seed = -minus_seed;
      if (room_of.contains(seed)) continue;
      std::vector<int> open(1, seed);
      room_of[seed] = seed;
      while (!open.empty()) {
        const int current = open.back();
        open.pop_back();
        for (const auto& [next, passage] : zones_.at(current).passages) {
          if (!passage.is_breakable || room_of.contains(next) || !flows(current, next)) continue;
          room_of[next] = seed;
          open.push_back(next);
        }
      }
    }
    for (const auto& [id, room] : room_of)
      if (id != room) fuse(id, room, kNoMinimum);
  }

  /// What is mostly outline against rooms is a door between them.
  void absorb_doors() {
    std::map<int, double> contact;
    for (const auto& [id, zone] : zones_)
      for (const auto& [other, share] : contact_shares(id)) contact[id] += share;
    const std::map<int, double> before = contact;
    for (const auto& [id, share] : before) {
      if (contact.at(id) <= params_.door_share || zones_.at(id).passages.empty()) continue;
      int into = zones_.at(id).passages.begin()->first;
      for (const auto& [other, passage] : zones_.at(id).passages)
        if (contact.contains(other) && contact.at(other) < params_.door_share) into = other;
      fuse(id, into, kNoMinimum);
      double sum = 0;
      for (const auto& [other, part] : contact_shares(into)) sum += part;
      contact[into] = sum;
    }
  }

  const MaorisParams& params_;
  cv::Mat labels_;
  mutable std::vector<int> parent_;
  std::map<int, OpeningZone> zones_;
};

/// Thickness in whole pixels, as 1..255 of the largest in the map, rounded up to steps of five. The authors paint their
/// discs one pixel up and to the left of their centres, with which their results were made: the rim of free space at
/// the right and below has no level.
cv::Mat opening_levels(const cv::Mat& free_space) {
  const cv::Mat centred = fuzzy_opening(clearance_image(free_space));
  cv::Mat thickness(centred.size(), CV_32FC1, cv::Scalar(0));
  const cv::Rect all(0, 0, centred.cols - kDiscOffset_px, centred.rows - kDiscOffset_px);
  if (all.area() > 0) centred(all + cv::Point(kDiscOffset_px, kDiscOffset_px)).copyTo(thickness(all));
  thickness.setTo(0, free_space != 255);
  double largest = 1;
  cv::minMaxLoc(thickness, nullptr, &largest);
  cv::Mat levels(free_space.size(), CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < levels.rows; ++y)
    for (int x = 0; x < levels.cols; ++x) {
      const double radius = thickness.at<float>(y, x);
      if (radius <= 0) continue;
      const int value = std::max(1, static_cast<int>(std::lround(255 * radius / largest)));
      levels.at<unsigned char>(y, x) =
          static_cast<unsigned char>(std::min(255, (value + kLevelStep - 1) / kLevelStep * kLevelStep));
    }
  return levels;
}

}  // namespace

Result<Ok> MaorisParams::validate() const {
  return ParamCheck("MaorisParams")
      .in_range("threshold", threshold, 0, 1)
      .in_range("margin", margin, 0, 1)
      .in_range("ripple_share", ripple_share, 0, 1)
      .in_range("door_share", door_share, 0, 1)
      .in_range("least_zone_px", least_zone_px, 0, 1e6)
      .in_range("least_room_px", least_room_px, 0, 1e6)
      .result();
}

MaorisParams maoris_params(MapKind kind) {
  MaorisParams params;
  if (kind == MapKind::kSketch) params.door_share = 0.60;
  return params;
}

Result<Segmentation> segment_maoris(const cv::Mat& free_space, const MaorisParams& params) {
  if (const Result<Ok> valid = params.validate(); !valid) return valid.error();
  if (free_space.total() > kMaxMaorisPixels)
    return fail(Errc::kTooLarge, "the map has more than 16 megapixels: reduce it first");
  if (const Result<Ok> sound = check_free_space(free_space); !sound) return sound.error();
  cv::Mat labels = OpeningGraph(opening_levels(free_space), params).segment();
  // The authors leave the rim and crumbs without a region; here every free pixel has one.
  double last = 0;
  grow_labels(free_space, labels);
  cv::minMaxLoc(labels, nullptr, &last);
  label_rest(free_space, static_cast<int>(last) + 1, labels);
  sweep_crumbs(labels, params.least_room_px);
  return described(labels);
}

}  // namespace smokemap
