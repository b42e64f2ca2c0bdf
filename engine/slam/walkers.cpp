#include "slam/walkers.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr std::ptrdiff_t kMostDropouts = 2;  ///< beams without an answer within one thing
constexpr double kStepsTogether = 3;         ///< and hits so many beam widths apart are one thing

Point2 end_of(const HitRanges& hits, std::ptrdiff_t beam) {
  return hits.at(beam) * Point2(std::cos(hits.angle(beam)), std::sin(hits.angle(beam)));
}

/// Does the scan end on this side of a piece, go on behind it, or before it?
enum class Side { kEnd, kBehind, kBefore };

Side side_of(const HitRanges& hits, std::ptrdiff_t end, std::ptrdiff_t beside, double apart_m) {
  if (!hits.full_turn() && (beside < 0 || beside >= hits.beams())) return Side::kEnd;
  const double other = hits.at(beside);
  return other <= 0 || other > hits.at(end) + apart_m ? Side::kBehind : Side::kBefore;
}

}  // namespace

std::vector<Walkers::Island> Walkers::pieces(const HitRanges& hits) const {
  const auto hang_together = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    const double reach_m =
        std::max(params_.together_m, kStepsTogether * std::min(hits.at(a), hits.at(b)) * std::abs(hits.step_rad()));
    return b - a <= kMostDropouts + 1 && (end_of(hits, a) - end_of(hits, b)).norm() <= reach_m;
  };
  std::vector<Island> found;
  for (std::ptrdiff_t i = 0; i < hits.beams(); ++i) {
    if (hits.at(i) <= 0) continue;
    if (!found.empty() && hang_together(found.back().last, i))
      found.back().last = i;
    else
      found.push_back({i, i});
  }
  if (hits.full_turn() && found.size() > 1 && hang_together(found.back().last, found.front().first + hits.beams())) {
    found.back().last = found.front().last + hits.beams();
    found.erase(found.begin());
  }
  return found;
}

/// From near to far: who stands half behind another small thing is one as well.
std::vector<Walkers::Island> Walkers::islands(const HitRanges& hits) const {
  std::vector<Island> small = pieces(hits);
  std::erase_if(small, [&](const Island& piece) {
    return (end_of(hits, piece.first) - end_of(hits, piece.last)).norm() > params_.widest_m;
  });
  std::stable_sort(small.begin(), small.end(), [&](const Island& a, const Island& b) {
    return hits.at(a.first) + hits.at(a.last) < hits.at(b.first) + hits.at(b.last);
  });
  std::vector<bool> taken(static_cast<std::size_t>(hits.beams()), false);
  const auto beam = [&](std::ptrdiff_t i) {
    return static_cast<std::size_t>((i % hits.beams() + hits.beams()) % hits.beams());
  };
  std::vector<Island> found;
  for (const Island& piece : small) {
    const Side left = side_of(hits, piece.first, piece.first - 1, params_.apart_m),
               right = side_of(hits, piece.last, piece.last + 1, params_.apart_m);
    const bool half_hidden = (left == Side::kBehind && right == Side::kBefore && taken[beam(piece.last + 1)]) ||
                             (right == Side::kBehind && left == Side::kBefore && taken[beam(piece.first - 1)]);
    if (!half_hidden && (left != Side::kBehind || right != Side::kBehind)) continue;
    for (std::ptrdiff_t i = piece.first; i <= piece.last; ++i) taken[beam(i)] = true;
    found.push_back(piece);
  }
  return found;
}

Walkers::Place Walkers::place_in(const View& view, const Island& island, const HitRanges& hits,
                                 const Pose2& T_way_laser, double way_m) const {
  const Pose2 T_then_now = view.T_way_laser.inverse() * T_way_laser;
  const double within_m = params_.same_place_m + params_.wheels_share * (way_m - view.way_m);
  int asked = 0, taken = 0, free = 0;
  for (std::ptrdiff_t i = island.first; i <= island.last; ++i) {
    if (hits.at(i) <= 0) continue;
    ++asked;
    const Point2 p = T_then_now * end_of(hits, i);
    const std::ptrdiff_t beam = view.hits.beam_along(std::atan2(p.y(), p.x()));
    bool is_taken = false, is_free = false, is_hidden = false;
    for (std::ptrdiff_t b = beam - 1; b <= beam + 2; ++b) {
      const double range = view.hits.at(b);
      if (range <= 0) continue;
      const double behind_m = range - p.norm();
      is_taken = is_taken || std::abs(behind_m) <= within_m;
      (behind_m > 0 ? is_free : is_hidden) = true;
    }
    taken += is_taken;
    free += is_free && !is_taken && !is_hidden;
  }
  if (2 * taken > asked) return Place::kTaken;
  return 2 * free > asked ? Place::kFree : Place::kHidden;
}

const Walkers::View* Walkers::from_back(double way_m, double least_m) const {
  for (auto view = views_.rbegin(); view != views_.rend(); ++view)
    if (way_m - view->way_m >= least_m) return &*view;
  return nullptr;
}

WalkerView Walkers::look(const LaserScan& scan, const HitRanges& hits, const Pose2& T_way_robot) const {
  WalkerView seen{std::vector<bool>(scan.ranges_m.size(), false), std::vector<bool>(scan.ranges_m.size(), false)};
  const double way_m = way_until(T_way_robot);
  const Pose2 T_way_laser = T_way_robot * scan.T_robot_laser;
  std::ptrdiff_t hit = 0, unproven = 0;
  for (std::ptrdiff_t i = 0; i < hits.beams(); ++i) hit += hits.at(i) > 0;
  for (const Island& island : islands(hits)) {
    bool stands = true, moves = false;
    for (const double back_m : {params_.proof_m, 0.5 * params_.proof_m}) {
      const View* view = from_back(way_m, back_m);
      const Place place = view ? place_in(*view, island, hits, T_way_laser, way_m) : Place::kHidden;
      stands = stands && place == Place::kTaken;
      moves = moves || place == Place::kFree;
    }
    if (stands) continue;
    for (std::ptrdiff_t i = island.first; i <= island.last; ++i) {
      const auto beam = static_cast<std::size_t>(i % hits.beams());
      seen.unproven[beam] = true;
      seen.moving[beam] = moves;
      unproven += hits.at(i) > 0;
    }
  }
  if (static_cast<double>(unproven) > params_.most_share * static_cast<double>(hit)) seen.unproven = seen.moving;
  return seen;
}

/// Summed over the scans kept: a robot that stands and whose pose trembles drives no way.
double Walkers::way_until(const Pose2& T_way_robot) const {
  if (views_.empty()) return 0;
  return views_.back().way_m + (T_way_robot.translation() - views_.back().T_way_robot.translation()).norm();
}

void Walkers::remember(const LaserScan& scan, HitRanges hits, const Pose2& T_way_robot) {
  const double way_m = way_until(T_way_robot);
  if (!views_.empty() && way_m - views_.back().way_m < params_.same_place_m) return;
  views_.push_back({T_way_robot, T_way_robot * scan.T_robot_laser, way_m, std::move(hits)});
  while (views_.size() > 1 && way_m - views_[1].way_m >= params_.proof_m) views_.pop_front();
}

}  // namespace smokemap
