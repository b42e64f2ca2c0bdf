#include "features/wall_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <unordered_map>

#include "core/check.hpp"

namespace smokemap {
namespace {

constexpr double kFarthest_m = 1e6;  ///< what is said to lie farther, or nowhere, is no hit

/// A hit with the direction of the surface around it.
struct DirectedHit {
  Point2 p = Point2::Zero();
  Point2 normal = Point2::Zero();  ///< towards where it was seen from; zero = no direction
  int aligned = 0;                 ///< neighbours with the same direction
  bool used = false;
  bool failed_as_seed = false;
};

struct FittedLine {
  Point2 mean = Point2::Zero();
  Point2 normal = Point2::UnitX();
  double rms_across_m = 0;
  double rms_along_m = 0;
};

FittedLine fit_line(const std::vector<DirectedHit>& hits, const std::vector<std::size_t>& members) {
  FittedLine line;
  for (const std::size_t i : members) line.mean += hits[i].p / static_cast<double>(members.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const std::size_t i : members) {
    const Point2 d = hits[i].p - line.mean;
    scatter += d * d.transpose() / static_cast<double>(members.size());
  }
  const double half_gap = std::hypot(0.5 * (scatter(0, 0) - scatter(1, 1)), scatter(0, 1)),
               middle = 0.5 * scatter.trace();
  const double along = 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  line.normal = {-std::sin(along), std::cos(along)};
  line.rms_across_m = std::sqrt(std::max(0.0, middle - half_gap));
  line.rms_along_m = std::sqrt(std::max(0.0, middle + half_gap));
  return line;
}

/// Hits by square cells; neighbours lie in the 3 x 3 cells around.
class HitCells {
 public:
  HitCells(const std::vector<PosedHit>& hits, double cell_m) : cell_m_(cell_m) {
    for (std::size_t i = 0; i < hits.size(); ++i)
      cells_[key(index(hits[i].point.x()), index(hits[i].point.y()))].push_back(i);
  }
  std::vector<std::size_t> near(const std::vector<PosedHit>& hits, const Point2& p) const {
    std::vector<std::size_t> found;
    for (int y = index(p.y()) - 1; y <= index(p.y()) + 1; ++y)
      for (int x = index(p.x()) - 1; x <= index(p.x()) + 1; ++x) {
        const auto cell = cells_.find(key(x, y));
        if (cell == cells_.end()) continue;
        for (const std::size_t i : cell->second)
          if ((hits[i].point - p).squaredNorm() <= cell_m_ * cell_m_) found.push_back(i);
      }
    return found;
  }

 private:
  int index(double v) const { return static_cast<int>(std::floor(v / cell_m_)); }
  static std::int64_t key(int x, int y) {
    return static_cast<std::int64_t>((static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) |
                                     static_cast<std::uint32_t>(y));
  }
  double cell_m_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

std::vector<DirectedHit> with_directions(const std::vector<PosedHit>& hits, const WallLineParams& params) {
  std::vector<DirectedHit> directed(hits.size());
  const HitCells cells(hits, params.neighbourhood_m);
  std::vector<std::vector<std::size_t>> near(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) directed[i].p = hits[i].point;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    near[i] = cells.near(hits, hits[i].point);
    if (near[i].size() < 3) continue;
    const FittedLine line = fit_line(directed, near[i]);
    if (line.rms_along_m < 2 * line.rms_across_m) continue;
    const bool towards = line.normal.dot(hits[i].seen_from - hits[i].point) >= 0;
    directed[i].normal = towards ? line.normal : Point2(-line.normal);
  }
  const double least_cosine = std::cos(params.tolerance_rad);
  for (std::size_t i = 0; i < hits.size(); ++i)
    for (const std::size_t j : near[i])
      directed[i].aligned += directed[i].normal.dot(directed[j].normal) > least_cosine;
  return directed;
}

/// Unused hits on the line, in order along it, from the seed as far as no gap is too long.
std::vector<std::size_t> members_of(const std::vector<DirectedHit>& hits, const FittedLine& line, const Point2& seed,
                                    double least_cosine, const WallLineParams& params) {
  const Point2 along(line.normal.y(), -line.normal.x());
  std::vector<std::pair<double, std::size_t>> on_line;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].used || hits[i].normal.dot(line.normal) < least_cosine) continue;
    if (std::abs(line.normal.dot(hits[i].p - line.mean)) > params.tolerance_m) continue;
    on_line.emplace_back(along.dot(hits[i].p - seed), i);
  }
  std::sort(on_line.begin(), on_line.end());
  const auto middle = std::lower_bound(on_line.begin(), on_line.end(), std::make_pair(0.0, std::size_t{0}));
  std::vector<std::size_t> members;
  double last = 0;
  for (auto hit = middle; hit != on_line.end() && hit->first - last <= params.largest_gap_m; ++hit) {
    members.push_back(hit->second);
    last = hit->first;
  }
  last = 0;
  for (auto hit = middle; hit != on_line.begin() && last - (hit - 1)->first <= params.largest_gap_m; --hit) {
    members.push_back((hit - 1)->second);
    last = (hit - 1)->first;
  }
  return members;
}

WallLine wall_of(const std::vector<DirectedHit>& hits, const FittedLine& line, const std::vector<std::size_t>& members,
                 const WallLineParams& params) {
  const Point2 along(line.normal.y(), -line.normal.x());  // free space, where the normal points, is on its left
  double from = 0, to = 0;
  for (const std::size_t i : members) {
    const double s = along.dot(hits[i].p - line.mean);
    from = std::min(from, s);
    to = std::max(to, s);
  }
  WallLine wall;
  wall.segment = {line.mean + from * along, line.mean + to * along};
  wall.support = static_cast<int>(members.size());
  wall.roughness_m = line.rms_across_m;
  // Neighbouring hits share their errors: one independent measurement every quarter of a metre.
  const double independent = std::clamp((to - from) / 0.25, 2.0, static_cast<double>(members.size()));
  const double sigma_hit = std::max(params.sigma_hit_m, line.rms_across_m);
  wall.sigma_m = sigma_hit / std::sqrt(independent);
  wall.sigma_rad = sigma_hit * std::sqrt(12.0 / independent) / std::max(to - from, 1e-3);
  return wall;
}

}  // namespace

Result<Ok> WallLineParams::validate() const {
  return ParamCheck("WallLineParams")
      .in_range("neighbourhood_m", neighbourhood_m, 0.02, 5)
      .positive("tolerance_m", tolerance_m)
      .in_range("tolerance_rad", tolerance_rad, 0.01, 1.5)
      .positive("largest_gap_m", largest_gap_m)
      .positive("min_length_m", min_length_m)
      .in_range("min_support", min_support, 3, 1e6)
      .positive("sigma_hit_m", sigma_hit_m)
      .result();
}

std::vector<WallLine> find_wall_lines(const std::vector<PosedHit>& all, const WallLineParams& params) {
  std::vector<PosedHit> hits;
  std::copy_if(all.begin(), all.end(), std::back_inserter(hits), [](const PosedHit& hit) {
    return hit.point.cwiseAbs().maxCoeff() < kFarthest_m && hit.seen_from.cwiseAbs().maxCoeff() < kFarthest_m;
  });
  std::vector<DirectedHit> directed = with_directions(hits, params);
  std::vector<std::size_t> seeds(hits.size());
  std::iota(seeds.begin(), seeds.end(), std::size_t{0});
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](std::size_t a, std::size_t b) { return directed[a].aligned > directed[b].aligned; });
  std::vector<WallLine> walls;
  for (const std::size_t seed : seeds) {
    DirectedHit& start = directed[seed];
    if (start.used || start.failed_as_seed || start.normal.squaredNorm() < 0.5) continue;
    FittedLine line{start.p, start.normal, 0, 0};
    std::vector<std::size_t> members;
    for (int round = 0; round < 3; ++round) {
      // Near a corner the local direction turns: the last round takes these hits too.
      members = members_of(directed, line, start.p, round < 2 ? std::cos(params.tolerance_rad) : 0.5, params);
      if (members.size() < 3) break;
      const Point2 side = line.normal;
      line = fit_line(directed, members);
      if (line.normal.dot(side) < 0) line.normal = -line.normal;
    }
    const bool enough = members.size() >= static_cast<std::size_t>(params.min_support);
    const WallLine wall = enough ? wall_of(directed, line, members, params) : WallLine{};
    const bool is_wall = enough && wall.segment.length() >= params.min_length_m;
    start.failed_as_seed = true;
    for (const std::size_t i : members) (is_wall ? directed[i].used : directed[i].failed_as_seed) = true;
    if (is_wall) walls.push_back(wall);
  }
  std::stable_sort(walls.begin(), walls.end(),
                   [](const WallLine& a, const WallLine& b) { return a.segment.length() > b.segment.length(); });
  return walls;
}

}  // namespace smokemap
