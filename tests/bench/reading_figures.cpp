#include "tests/bench/reading_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace smokemap::bench {
namespace {

constexpr double kMayMean_s = 0.011;  ///< as in RelationError: stamps in steps of 10 ms
constexpr double kOnePlace_m = 0.03;
constexpr std::size_t kFolds = 5;
constexpr int kRounds = 12;

/// Between two scans: moved on by odometry from both, blended.
std::vector<Pose2> poses_of_readings(const Trajectory& trajectory, const std::vector<std::size_t>& reading_of_scan,
                                     const std::vector<Odometry>& odometry) {
  std::vector<Pose2> poses(odometry.size());
  const auto carried = [&](std::size_t scan, std::size_t to) {
    return trajectory[scan].T_map_robot *
           (odometry[reading_of_scan[scan]].T_odom_robot.inverse() * odometry[to].T_odom_robot);
  };
  for (std::size_t scan = 0; scan < trajectory.size(); ++scan) {
    const std::size_t from = reading_of_scan[scan];
    const bool last = scan + 1 == trajectory.size();
    const std::size_t to = last ? odometry.size() : reading_of_scan[scan + 1];
    for (std::size_t r = scan == 0 ? 0 : from; r < to; ++r) {
      const double share = static_cast<double>(r - std::min(r, from)) / static_cast<double>(to - from);
      poses[r] = last || r < from ? carried(scan, r) : interpolate(carried(scan, r), carried(scan + 1, r), share);
    }
  }
  return poses;
}

/// Which reading each stamp means, and how far that leaves the relations off.
class Readings {
 public:
  Readings(const std::vector<Pose2>& poses, const std::vector<Odometry>& odometry,
           const std::vector<PoseRelation>& relations)
      : poses_(poses), relations_(relations) {
    std::multimap<Stamp, std::size_t> by_stamp;
    for (std::size_t r = 0; r < odometry.size(); ++r) by_stamp.emplace(odometry[r].stamp, r);
    for (const PoseRelation& relation : relations)
      for (const Stamp stamp : {relation.from, relation.to})
        if (index_.emplace(stamp, candidates_.size()).second) add_stamp(stamp, by_stamp);
    of_stamp_.resize(candidates_.size());
    for (std::size_t k = 0; k < relations.size(); ++k) {
      ends_.emplace_back(index_.at(relations[k].from), index_.at(relations[k].to));
      of_stamp_[ends_.back().first].push_back(k);
      of_stamp_[ends_.back().second].push_back(k);
    }
  }
  std::size_t stamps() const { return candidates_.size(); }
  std::size_t ambiguous() const {
    return static_cast<std::size_t>(std::count_if(candidates_.begin(), candidates_.end(), [&](const auto& all) {
      return std::any_of(all.begin(), all.end(), [&](std::size_t r) {
        return (poses_[r].translation() - poses_[all.front()].translation()).norm() > kOnePlace_m;
      });
    }));
  }
  Pose2 error(std::size_t relation, const std::vector<std::size_t>& chosen) const {
    const auto [from, to] = ends_[relation];
    return relations_[relation].T_from_to.inverse() * (poses_[chosen[from]].inverse() * poses_[chosen[to]]);
  }
  /// One stamp after another takes the reading that leaves its relations, but those of one fold, least off.
  std::vector<std::size_t> choose(std::size_t without_fold) const {
    std::vector<std::size_t> chosen = nearest_;
    bool changed = true;
    for (int round = 0; round < kRounds && changed; ++round) {
      changed = false;
      for (std::size_t s = 0; s < candidates_.size(); ++s) changed = improve(s, without_fold, chosen) || changed;
    }
    return chosen;
  }

 private:
  void add_stamp(Stamp stamp, const std::multimap<Stamp, std::size_t>& by_stamp) {
    std::vector<std::size_t> all;
    Stamp least = std::numeric_limits<Stamp>::max();
    std::size_t nearest = 0;
    const auto consider = [&](const auto& entry) {
      const Stamp apart = std::abs(entry.first - stamp);
      if (apart < least) least = apart, nearest = entry.second;
    };
    const auto begin = by_stamp.lower_bound(stamp - from_seconds(kMayMean_s)),
               end = by_stamp.upper_bound(stamp + from_seconds(kMayMean_s));
    for (auto entry = begin; entry != end; ++entry) all.push_back(entry->second), consider(*entry);
    if (begin != by_stamp.begin()) consider(*std::prev(begin));
    if (end != by_stamp.end()) consider(*end);
    if (all.empty()) all.push_back(nearest);
    std::sort(all.begin(), all.end());
    candidates_.push_back(std::move(all));
    nearest_.push_back(nearest);
  }
  bool improve(std::size_t stamp, std::size_t without_fold, std::vector<std::size_t>& chosen) const {
    const auto off = [&] {
      double sum = 0;
      for (const std::size_t k : of_stamp_[stamp])
        if (k % kFolds != without_fold) sum += error(k, chosen).translation().norm();
      return sum;
    };
    const std::size_t before = chosen[stamp];
    std::size_t best = before;
    double least = off();
    for (const std::size_t candidate : candidates_[stamp]) {
      chosen[stamp] = candidate;
      if (const double sum = off(); sum < least - 1e-9) least = sum, best = candidate;
    }
    chosen[stamp] = best;
    return best != before;
  }

  const std::vector<Pose2>& poses_;
  const std::vector<PoseRelation>& relations_;
  std::map<Stamp, std::size_t> index_;
  std::vector<std::vector<std::size_t>> candidates_;  ///< by stamp
  std::vector<std::size_t> nearest_;
  std::vector<std::pair<std::size_t, std::size_t>> ends_;  ///< by relation: its stamps
  std::vector<std::vector<std::size_t>> of_stamp_;         ///< relations
};

}  // namespace

ReadingFigures told_by_relations(const Trajectory& trajectory, const std::vector<std::size_t>& reading_of_scan,
                                 const std::vector<Odometry>& odometry, const std::vector<PoseRelation>& relations) {
  ReadingFigures figures;
  if (trajectory.empty() || odometry.empty() || relations.empty()) return figures;
  const std::vector<Pose2> poses = poses_of_readings(trajectory, reading_of_scan, odometry);
  const Readings readings(poses, odometry, relations);
  figures.stamps = readings.stamps();
  figures.ambiguous = readings.ambiguous();
  const auto count = static_cast<double>(relations.size());
  const std::vector<std::size_t> by_all = readings.choose(kFolds);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const std::vector<std::size_t> by_others = readings.choose(fold);
    for (std::size_t k = fold; k < relations.size(); k += kFolds) {
      const Pose2 off = readings.error(k, by_others), best = readings.error(k, by_all);
      figures.mean_m += off.translation().norm() / count;
      figures.most_m = std::max(figures.most_m, off.translation().norm());
      figures.mean_rad += std::abs(off.heading()) / count;
      figures.best_mean_m += best.translation().norm() / count;
      figures.best_most_m = std::max(figures.best_most_m, best.translation().norm());
      figures.best_mean_rad += std::abs(best.heading()) / count;
    }
  }
  return figures;
}

}  // namespace smokemap::bench
