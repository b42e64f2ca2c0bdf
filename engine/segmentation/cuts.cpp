// Where a person would draw the boundary of a room: from a corner that points into free space to another one (a door
// between two wall ends), straight on in the direction of a wall (a door beside a crossing wall, the mouth of a
// corridor), or to the nearest wall opposite. Far more of them than there are rooms; cut_selection.cpp chooses.
#include "segmentation/cuts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace smokemap {
namespace {

constexpr size_t kNearestCuts = 8;        ///< to other walls, kept for every corner
constexpr size_t kMostTried = 40;         ///< nearest places of walls looked at for a free line of sight
constexpr double kCollinear_cos = 0.96;   ///< a wall runs on in the direction of a cut
constexpr double kFullSupport = 1.0 / 3;  ///< a wall that runs on for this share of the cut supports it fully
constexpr double kLeastCut_px = 2;
constexpr double kLookAlong = 1.5;       ///< lengths of the cut within which its sides are measured
constexpr double kLookAway = 4;          ///< lengths of the cut within which the clearance behind it is asked
constexpr double kExtentQuantile = 0.7;  ///< a niche or slot beside a cut does not make its side wide

bool is_free(const cv::Mat& structure, const cv::Point& p) {
  const bool inside = p.x >= 0 && p.y >= 0 && p.x < structure.cols && p.y < structure.rows;
  return inside && structure.at<unsigned char>(p) == 255;
}

cv::Point rounded(const cv::Point2d& p) {
  return {static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))};
}

/// How far one gets from `from` in `direction` (unit) through free space, at most `limit`.
double walk(const cv::Mat& structure, const cv::Point2d& from, const cv::Point2d& direction, double limit) {
  for (double way = 0; way < limit; way += 1)
    if (!is_free(structure, rounded(from + (way + 1) * direction))) return way;
  return limit;
}

struct WallPlace {
  cv::Point p;
  size_t ring = 0;
  double along_px = 0;
  bool is_corner = false;
};

/// Where one arrives going straight from wall to wall: the last free pixel near `to`, or nothing if something is in
/// the way. The polygons of the walls may be `tolerance` off. Past a corner the way may go on along its wall.
std::optional<cv::Point> arrive(const cv::Mat& structure, const cv::Point& from, const WallPlace& to,
                                double tolerance) {
  const double distance = cv::norm(to.p - from);
  const cv::Point2d direction = cv::Point2d(to.p - from) * (1 / distance);
  const double most = distance + tolerance + 2, least = std::max(kLeastCut_px, distance - tolerance - 2);
  const double way = walk(structure, from, direction, most);
  if (way >= most && to.is_corner) return to.p;
  if (way < least || way >= most) return std::nullopt;
  return rounded(cv::Point2d(from) + way * direction);
}

/// Finds the walls near a place: the walls that begin at corner `second` of ring `first`, sorted into squares.
class WallIndex {
 public:
  using Wall = std::pair<size_t, size_t>;

  WallIndex(const std::vector<WallRing>& rings, cv::Size size, double square_px)
      : square_(std::max(8.0, square_px)),
        cols_(static_cast<int>(size.width / square_) + 1),
        rows_(static_cast<int>(size.height / square_) + 1),
        squares_(static_cast<size_t>(cols_) * static_cast<size_t>(rows_)) {
    for (size_t ring = 0; ring < rings.size(); ++ring)
      for (size_t i = 0; i < rings[ring].corners.size(); ++i) {
        const auto& corners = rings[ring].corners;
        insert({ring, i}, corners[i].p, corners[(i + 1) % corners.size()].p);
      }
  }

  /// Walls within `reach` of `p` (and some more), each once, in order.
  std::vector<Wall> near(const cv::Point& p, double reach) const {
    std::vector<Wall> found;
    each_square(p, p, reach, [&](size_t s) { found.insert(found.end(), squares_[s].begin(), squares_[s].end()); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  void insert(const Wall& wall, const cv::Point& a, const cv::Point& b) {
    const cv::Point low(std::min(a.x, b.x), std::min(a.y, b.y)), high(std::max(a.x, b.x), std::max(a.y, b.y));
    each_square(low, high, 0, [&](size_t s) { squares_[s].push_back(wall); });
  }

  template <typename Visit>
  void each_square(const cv::Point& low, const cv::Point& high, double reach, Visit visit) const {
    const auto square = [&](double value, int count) {
      return std::clamp(static_cast<int>(std::floor(value / square_)), 0, count - 1);
    };
    for (int y = square(low.y - reach, rows_); y <= square(high.y + reach, rows_); ++y)
      for (int x = square(low.x - reach, cols_); x <= square(high.x + reach, cols_); ++x)
        visit(static_cast<size_t>(y) * static_cast<size_t>(cols_) + static_cast<size_t>(x));
  }

  double square_;
  int cols_, rows_;
  std::vector<std::vector<Wall>> squares_;
};

class CutFinder {
 public:
  CutFinder(const cv::Mat& structure, const std::vector<WallRing>& rings, const CutSearch& search)
      : structure_(structure), rings_(rings), search_(search), index_(rings, structure.size(), search.longest_px / 4) {}

  std::vector<Cut> find() {
    for (size_t ring = 0; ring < rings_.size(); ++ring)
      for (size_t i = 0; i < rings_[ring].corners.size(); ++i)
        if (rings_[ring].corners[i].is_reflex) {
          cut_to_near_walls(ring, i);
          cut_along_walls(ring, i);
        }
    return std::move(cuts_);
  }

 private:
  using Place = std::pair<double, WallPlace>;  // distance

  const WallCorner& corner(size_t ring, size_t i) const {
    const auto& corners = rings_[ring].corners;
    return corners[i % corners.size()];
  }

  /// A cut across a shallow dent of one wall parts nothing.
  bool goes_round(const WallPlace& from, const WallPlace& to) const {
    if (from.ring != to.ring) return true;
    return rings_[from.ring].way_px(from.along_px, to.along_px) >= search_.least_detour * cv::norm(to.p - from.p);
  }

  /// 0..1: whether a wall runs on at `place` against `direction` (unit, into free space).
  double support_at(const cv::Point& place, const cv::Point2d& direction, double length) const {
    const double reach = search_.tolerance_px + 2;
    double best = 0;
    for (const auto& [ring, i] : index_.near(place, reach)) {
      const cv::Point begin = corner(ring, i).p, end = corner(ring, i + 1).p;
      for (const auto& [near, far] : {std::pair(begin, end), std::pair(end, begin)}) {
        const cv::Point2d wall = far - near;
        const double size = cv::norm(wall);
        if (cv::norm(near - place) <= reach && -wall.dot(direction) >= kCollinear_cos * size)
          best = std::max(best, size);
      }
    }
    return std::min(1.0, best / (kFullSupport * length));
  }

  void cut_to_near_walls(size_t ring, size_t i) {
    const WallPlace from{corner(ring, i).p, ring, corner(ring, i).along_px, true};
    std::vector<Place> places;
    for (const auto& [other, j] : index_.near(from.p, search_.longest_px)) add_places(from, other, j, places);
    const size_t count = std::min(places.size(), kMostTried);
    std::partial_sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count), places.end(),
                      [](const Place& one, const Place& two) {
                        return std::tie(one.first, one.second.p.y, one.second.p.x) <
                               std::tie(two.first, two.second.p.y, two.second.p.x);
                      });
    size_t kept = 0;
    for (size_t k = 0; k < count && kept < kNearestCuts; ++k) {
      const std::optional<cv::Point> end = arrive(structure_, from.p, places[k].second, search_.tolerance_px);
      if (!end) continue;
      ++kept;
      const double length = cv::norm(*end - from.p);
      const cv::Point2d direction = cv::Point2d(*end - from.p) * (1 / length);
      const double support = support_at(from.p, direction, length) + support_at(*end, -direction, length);
      cuts_.push_back({from.p, *end, length, support});
    }
  }

  /// The corner at which a wall begins, if it is reflex, and the place of the wall right opposite `from`.
  void add_places(const WallPlace& from, size_t ring, size_t j, std::vector<Place>& places) const {
    const WallCorner& begin = corner(ring, j);
    const auto consider = [&](const WallPlace& place) {
      const double distance = cv::norm(place.p - from.p);
      if (distance >= kLeastCut_px && distance <= search_.longest_px && goes_round(from, place))
        places.push_back({distance, place});
    };
    if (begin.is_reflex) consider({begin.p, ring, begin.along_px, true});
    const cv::Point2d wall = corner(ring, j + 1).p - begin.p;
    const double size = cv::norm(wall);
    if (size < 2) return;
    const double along = cv::Point2d(from.p - begin.p).dot(wall) / size;
    if (along < 1 || along > size - 1) return;
    consider({rounded(cv::Point2d(begin.p) + (along / size) * wall), ring, begin.along_px + along});
  }

  void cut_along_walls(size_t ring, size_t i) {
    const WallCorner& here = corner(ring, i);
    const size_t count = rings_[ring].corners.size();
    for (const size_t j : {i + 1, i + count - 1}) {
      const cv::Point2d wall = here.p - corner(ring, j).p;
      const double size = cv::norm(wall);
      if (size < 3) continue;
      const cv::Point2d direction = wall * (1 / size);
      const double way = walk(structure_, here.p, direction, search_.longest_px);
      if (way < kLeastCut_px || way >= search_.longest_px) continue;
      const cv::Point end = rounded(cv::Point2d(here.p) + way * direction);
      cuts_.push_back({here.p, end, way, std::min(1.0, size / (kFullSupport * way))});
    }
  }

  const cv::Mat& structure_;
  const std::vector<WallRing>& rings_;
  const CutSearch& search_;
  WallIndex index_;
  std::vector<Cut> cuts_;
};

}  // namespace

std::vector<Cut> candidate_cuts(const cv::Mat& structure, const std::vector<WallRing>& rings, const CutSearch& search) {
  return CutFinder(structure, rings, search).find();
}

CutSides look_beside(const cv::Mat& structure, const cv::Mat& clearance, const Cut& cut) {
  CutSides sides;
  const cv::Point2d middle = 0.5 * cv::Point2d(cut.a + cut.b);
  const cv::Point2d along = cv::Point2d(cut.b - cut.a) * (1 / cut.length_px);
  const cv::Point2d across(-along.y, along.x);
  const double stride = std::max(1.0, cut.length_px / 16), limit = 3 * cut.length_px;
  std::vector<double> extents;
  for (size_t side = 0; side < 2; ++side) {
    const cv::Point2d away = side == 0 ? across : -across;
    extents.clear();
    for (double way = 2; way <= kLookAway * cut.length_px + 2; way += stride) {
      const cv::Point2d at = middle + way * away;
      const cv::Point pixel = rounded(at);
      if (!is_free(structure, pixel)) break;
      sides.clearance_px[side] = std::max(sides.clearance_px[side], static_cast<double>(clearance.at<float>(pixel)));
      if (way > kLookAlong * cut.length_px + 2) continue;
      extents.push_back(1 + walk(structure, at, along, limit) + walk(structure, at, -along, limit));
    }
    if (extents.empty()) continue;
    const auto rank = static_cast<std::ptrdiff_t>(kExtentQuantile * static_cast<double>(extents.size() - 1));
    std::nth_element(extents.begin(), extents.begin() + rank, extents.end());
    sides.extent_px[side] = extents[static_cast<size_t>(rank)];
  }
  return sides;
}

}  // namespace smokemap
