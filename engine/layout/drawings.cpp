#include "layout/drawings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace smokemap {
namespace {

constexpr std::size_t kMostDrawings = 12;
constexpr double kFarReach = 4.5;         ///< times the widest opening: how far parts of one floor may be apart
constexpr double kPostReachInside = 3.5;  ///< the same for a piece of wall inside the drawing, in line with another
constexpr int kLeastPiers = 3;            ///< of a front: pieces of one line
constexpr double kLeastScore = 0.02;      ///< of the best drawing's: below are frames, legends and words

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[std::max(of(a), of(b))] = std::min(of(a), of(b)); }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<InkStroke> members_of(const std::vector<InkStroke>& strokes, const std::vector<std::size_t>& members) {
  std::vector<InkStroke> picked;
  picked.reserve(members.size());
  for (const std::size_t i : members) picked.push_back(strokes[i]);
  return picked;
}

void append(std::vector<InkStroke>& to, const std::vector<InkStroke>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Letters are short, frames and boxes of text are thin and have neither partitions nor windows.
bool could_be_a_wing(const std::vector<InkStroke>& walls, const StrokeRegion& region, double thickness_px,
                     double side_px) {
  double longest = region.longest_line, thickness = 0, length = 0;
  std::map<int, int> pieces_of_line;
  int pieces = 0;
  for (const std::size_t m : region.members) {
    if (walls[m].line >= 0) pieces = std::max(pieces, ++pieces_of_line[walls[m].line]);
    longest = std::max(longest, walls[m].length());
    thickness += walls[m].thickness_px * walls[m].length();
    length += walls[m].length();
  }
  const bool built = region.junctions > static_cast<int>(region.members.size()) || pieces >= kLeastPiers;
  return longest > 0.05 * side_px && built && thickness > 0.6 * thickness_px * length;
}

/// The two carry each other on: in line, with their ends facing each other.
bool in_line(const InkStroke& one, const InkStroke& two, double reach_px) {
  if (line_angle_between(one.axis.heading(), two.axis.heading()) > radians(4)) return false;
  const double side = 0.5 * std::max(one.thickness_px, two.thickness_px) + 1;
  const double low = std::min(one.thickness_px, two.thickness_px);
  return std::abs(signed_line_distance(one.axis, two.axis.midpoint())) < side && 2 * side < 5 * low + 2 &&
         gap_between(one.axis, two.axis) < reach_px;
}

bool of_one_line(const InkStroke& one, const InkStroke& two) { return one.line >= 0 && one.line == two.line; }

bool alike(double one, double two) { return std::min(one, two) > 0.7 * std::max(one, two); }

/// Parts of one floor far apart: the piece carries on walls of the building in two directions. (Another floor on the
/// sheet is at most lined up in one.)
/// @param least_px  shorter walls may line up by chance, as words do
bool lines_up_twice(const std::vector<InkStroke>& piece, const std::vector<InkStroke>& building, double reach_px,
                    double least_px) {
  std::vector<double> headings;
  for (const auto& m : piece)
    for (const auto& b : building)
      if (std::min(m.length(), b.length()) > least_px && alike(m.thickness_px, b.thickness_px) &&
          in_line(m, b, reach_px))
        headings.push_back(b.axis.heading());
  return std::any_of(headings.begin(), headings.end(),
                     [&](double h) { return line_angle_between(h, headings.front()) > radians(45); });
}

/// Moves the best region, and what belongs to it, out of `walls`.
Drawing take_best(std::vector<InkStroke>& walls, double thickness_px, double reach_px, double side_px) {
  const auto regions = connected_regions(walls, reach_px, side_px);
  if (regions.empty()) return {};
  std::vector<bool> adopted(regions.size(), false);
  std::vector<InkStroke> building = members_of(walls, regions.front().members);
  adopted[0] = true;
  Point2 low = regions.front().low, high = regions.front().high;
  const auto any_pair = [&](const StrokeRegion& region, const auto& holds) {
    return std::any_of(region.members.begin(), region.members.end(), [&](std::size_t m) {
      return std::any_of(building.begin(), building.end(), [&](const InkStroke& b) { return holds(walls[m], b); });
    });
  };
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t r = 1; r < regions.size(); ++r) {
      if (adopted[r]) continue;
      const Point2 new_low = low.cwiseMin(regions[r].low), new_high = high.cwiseMax(regions[r].high);
      const bool grows = (new_high - new_low).prod() > 1.15 * (high - low).prod();
      const bool carries_on = any_pair(regions[r], [&](const InkStroke& m, const InkStroke& b) {
        return of_one_line(m, b) || in_line(m, b, 1.3 * reach_px);
      });
      const auto far = [&] {
        return lines_up_twice(members_of(walls, regions[r].members), building, kFarReach * reach_px, 0.05 * side_px);
      };
      // A post between two windows.
      const auto inside = [&] {
        return !grows && any_pair(regions[r], [&](const InkStroke& m, const InkStroke& b) {
          return alike(m.thickness_px, b.thickness_px) && b.length() > 2 * b.thickness_px &&
                 in_line(b, m, kPostReachInside * reach_px);
        });
      };
      if (!carries_on && !(regions[r].length > 0.1 * side_px && far()) && !inside()) {
        if (std::max(regions[r].length, regions[r].longest_line) < 0.03 * side_px) continue;
        if (grows && !could_be_a_wing(walls, regions[r], thickness_px, side_px)) continue;
        if (!any_pair(regions[r],
                      [&](const InkStroke& m, const InkStroke& b) { return gap_between(m.axis, b.axis) < reach_px; }))
          continue;
      }
      append(building, members_of(walls, regions[r].members));
      adopted[r] = grown = true;
      low = new_low, high = new_high;
    }
  }
  std::vector<InkStroke> left;
  for (std::size_t r = 1; r < regions.size(); ++r)
    if (!adopted[r]) append(left, members_of(walls, regions[r].members));
  walls = std::move(left);
  return {std::move(building), low, high, regions.front().score()};
}

}  // namespace

double gap_between(const Segment2& one, const Segment2& two) {
  if (intersection(one, two)) return 0;
  return std::min({distance(one, two.a), distance(one, two.b), distance(two, one.a), distance(two, one.b)});
}

std::vector<StrokeRegion> connected_regions(const std::vector<InkStroke>& strokes, double bridge_px, double side_px) {
  Groups groups(strokes.size());
  std::vector<int> junctions(strokes.size(), 0);
  for (std::size_t i = 0; i < strokes.size(); ++i)
    for (std::size_t j = i + 1; j < strokes.size(); ++j) {
      const auto &one = strokes[i], &two = strokes[j];
      const double touch = 0.5 * (one.thickness_px + two.thickness_px) + 3;
      const double reach = 0.5 * (one.length() + two.length()) + std::max(bridge_px, touch);
      if ((one.axis.midpoint() - two.axis.midpoint()).squaredNorm() > reach * reach) continue;
      const double gap = gap_between(one.axis, two.axis);
      const double turn = line_angle_between(one.axis.heading(), two.axis.heading());
      if (gap <= touch && turn > radians(20) && std::min(one.length(), two.length()) > 0.015 * side_px)
        junctions[i] += 1;
      const bool continues = turn < radians(5) && std::abs(signed_line_distance(one.axis, two.axis.midpoint())) < touch;
      if (gap <= touch || (continues && gap <= bridge_px)) groups.join(i, j);
    }
  std::map<int, double> line_length;
  for (const auto& s : strokes) line_length[s.line] += s.line >= 0 ? s.length() : 0;
  std::vector<StrokeRegion> by_root(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    auto& region = by_root[groups.of(i)];
    region.members.push_back(i);
    if (strokes[i].length() > 0.015 * side_px) region.length += strokes[i].length();
    region.longest_line = std::max(region.longest_line, line_length[strokes[i].line]);
    region.junctions += junctions[i];
    for (const Point2& end : {strokes[i].axis.a, strokes[i].axis.b})
      region.low = region.low.cwiseMin(end), region.high = region.high.cwiseMax(end);
  }
  std::vector<StrokeRegion> regions;
  for (auto& region : by_root)
    if (!region.members.empty()) regions.push_back(std::move(region));
  std::stable_sort(regions.begin(), regions.end(),
                   [](const StrokeRegion& a, const StrokeRegion& b) { return a.score() > b.score(); });
  return regions;
}

std::vector<Drawing> rank_drawings(const std::vector<InkStroke>& walls, double thickness_px, double reach_px,
                                   double side_px) {
  std::vector<Drawing> drawings;
  std::vector<InkStroke> left = walls;
  while (!left.empty() && drawings.size() < kMostDrawings) {
    Drawing next = take_best(left, thickness_px, reach_px, side_px);
    if (!drawings.empty() && !(next.score > kLeastScore * drawings.front().score)) break;
    drawings.push_back(std::move(next));
  }
  return drawings;
}

std::size_t drawing_at(const std::vector<Drawing>& drawings, const Point2& p) {
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t d = 0; d < drawings.size(); ++d) {
    const Point2 size = drawings[d].high - drawings[d].low;
    const Point2 outside = (drawings[d].low - p).cwiseMax(p - drawings[d].high).cwiseMax(0.0);
    const double cost = outside.norm() > 0 ? 1e12 * outside.norm() : size.prod();
    if (cost < least) least = cost, best = d;
  }
  return best;
}

}  // namespace smokemap
