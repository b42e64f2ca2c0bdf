#include "slam/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace smokemap {
namespace {

constexpr double kSameStamp_s = 1e-4;    ///< an estimate this near to a log record is that record's
constexpr double kRecordStamp_s = 0.02;  ///< a relation's stamp this near to a record means that record
constexpr double kStampStep_s = 0.011;   ///< records this near to a stamp may all be meant: stamps in steps of 10 ms
constexpr double kOnePlace_m = 0.03, kOnePlace_rad = 0.02;

ErrorSpread spread_of(std::vector<double> errors) {
  ErrorSpread spread;
  if (errors.empty()) return spread;
  const auto count = static_cast<double>(errors.size());
  spread.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  double squares = 0;
  for (const double e : errors) squares += (e - spread.mean) * (e - spread.mean);
  spread.stddev = std::sqrt(squares / count);
  std::sort(errors.begin(), errors.end());
  spread.most = errors.back();
  spread.median =
      errors.size() % 2 ? errors[errors.size() / 2] : 0.5 * (errors[errors.size() / 2 - 1] + errors[errors.size() / 2]);
  return spread;
}

Trajectory by_stamp(Trajectory poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  return poses;
}

/// Index of the entry nearest in time; the earlier of two equally near.
template <typename Stamped>
std::size_t nearest_in_time(const std::vector<Stamped>& sorted, Stamp stamp) {
  const auto after =
      std::lower_bound(sorted.begin(), sorted.end(), stamp, [](const Stamped& s, Stamp t) { return s.stamp < t; });
  if (after == sorted.begin()) return 0;
  const auto i = static_cast<std::size_t>(after - sorted.begin());
  if (after == sorted.end() || stamp - sorted[i - 1].stamp <= after->stamp - stamp) return i - 1;
  return i;
}

double apart_s(Stamp a, Stamp b) { return std::abs(to_seconds(a - b)); }

/// The estimate at any stamp, helped by odometry between estimates.
class PoseLookup {
 public:
  PoseLookup(const Trajectory& estimate, const std::vector<Odometry>& odometry, double longest_gap_s)
      : poses_(by_stamp(estimate)), odometry_(odometry), longest_gap_s_(longest_gap_s) {
    for (std::size_t i = 0; i < odometry.size(); ++i) records_.push_back({odometry[i].stamp, i});
    std::stable_sort(records_.begin(), records_.end(),
                     [](const Record& a, const Record& b) { return a.stamp < b.stamp; });
    // Of readings that share a stamp but not a place nobody knows which one the estimate belongs to.
    for (std::size_t i = 0; i < odometry.size(); ++i) {
      const StampedPose& pose = poses_[nearest_in_time(poses_, odometry[i].stamp)];
      if (apart_s(pose.stamp, odometry[i].stamp) < kSameStamp_s && one_place(odometry[i].stamp, kSameStamp_s))
        estimated_.push_back({i, pose.T_map_robot});
    }
  }

  std::optional<Pose2> at(Stamp stamp) const {
    const StampedPose& nearest = poses_[nearest_in_time(poses_, stamp)];
    const double gap_s = apart_s(nearest.stamp, stamp);
    if (gap_s <= kSameStamp_s || estimated_.empty())
      return gap_s <= longest_gap_s_ ? std::optional(nearest.T_map_robot) : std::nullopt;
    const Record& record = records_[nearest_in_time(records_, stamp)];
    if (apart_s(record.stamp, stamp) < kRecordStamp_s) return moved_by_odometry(record.index);
    return gap_s <= longest_gap_s_ ? std::optional(nearest.T_map_robot) : std::nullopt;
  }

  /// Whether all readings that the stamp may mean were taken at one place.
  bool is_clear(Stamp stamp) const { return one_place(stamp, kStampStep_s); }

 private:
  struct Record {
    Stamp stamp = 0;
    std::size_t index = 0;  ///< in file order
  };
  struct Estimated {
    std::size_t index = 0;
    Pose2 T_map_robot;
  };

  /// Whether there are readings within `step_s` of the stamp, all taken at one place.
  bool one_place(Stamp stamp, double step_s) const {
    const Stamp step = from_seconds(step_s);
    auto record = std::lower_bound(records_.begin(), records_.end(), stamp - step,
                                   [](const Record& r, Stamp t) { return r.stamp < t; });
    if (record == records_.end() || record->stamp > stamp + step) return false;
    const Pose2 T_first_odom = odometry_[record->index].T_odom_robot.inverse();
    for (; record != records_.end() && record->stamp <= stamp + step; ++record) {
      const Pose2 moved = T_first_odom * odometry_[record->index].T_odom_robot;
      if (moved.translation().norm() > kOnePlace_m || std::abs(moved.heading()) > kOnePlace_rad) return false;
    }
    return true;
  }

  Pose2 moved_by_odometry(std::size_t index) const {
    const auto after = std::lower_bound(estimated_.begin(), estimated_.end(), index,
                                        [](const Estimated& e, std::size_t i) { return e.index < i; });
    const Estimated& next = after == estimated_.end() ? estimated_.back() : *after;
    const Estimated& last = after == estimated_.begin() ? next : *(after - 1);
    const auto carried = [&](const Estimated& from) {
      return from.T_map_robot * (odometry_[from.index].T_odom_robot.inverse() * odometry_[index].T_odom_robot);
    };
    if (next.index <= last.index) return carried(last);
    return interpolate(carried(last), carried(next),
                       static_cast<double>(index - last.index) / static_cast<double>(next.index - last.index));
  }

  Trajectory poses_;
  const std::vector<Odometry>& odometry_;
  double longest_gap_s_;
  std::vector<Record> records_;
  std::vector<Estimated> estimated_;  ///< in file order
};

/// The truth at a stamp, between its neighbours.
Pose2 interpolated(const Trajectory& sorted, Stamp stamp) {
  const auto after =
      std::lower_bound(sorted.begin(), sorted.end(), stamp, [](const StampedPose& s, Stamp t) { return s.stamp < t; });
  if (after == sorted.end()) return sorted.back().T_map_robot;
  if (after == sorted.begin() || after->stamp == stamp) return after->T_map_robot;
  const StampedPose& before = *(after - 1);
  return interpolate(before.T_map_robot, after->T_map_robot,
                     to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp));
}

/// The rigid motion that takes `from` onto `to` in least squares.
Pose2 best_alignment(const std::vector<Point2>& from, const std::vector<Point2>& to) {
  Point2 mean_from = Point2::Zero(), mean_to = Point2::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    mean_from += from[i] / static_cast<double>(from.size());
    mean_to += to[i] / static_cast<double>(to.size());
  }
  double dot = 0, cross = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Point2 a = from[i] - mean_from, b = to[i] - mean_to;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
  }
  const Pose2 turn(0, 0, std::atan2(cross, dot));
  return {mean_to - turn * mean_from, turn.heading()};
}

}  // namespace

Result<RelationError> relation_error(const Trajectory& estimate, const std::vector<PoseRelation>& relations,
                                     const std::vector<Odometry>& odometry, double longest_gap_s) {
  if (estimate.empty()) return fail(Errc::kDegenerate, "no estimated pose");
  const PoseLookup lookup(estimate, odometry, longest_gap_s);
  RelationError result;
  std::vector<double> translation, rotation, clear_translation, clear_rotation;
  for (const PoseRelation& relation : relations) {
    const auto from = lookup.at(relation.from), to = lookup.at(relation.to);
    if (!from || !to) {
      ++result.missing;
      continue;
    }
    const Pose2 error = relation.T_from_to.inverse() * (from->inverse() * *to);
    translation.push_back(error.translation().norm());
    rotation.push_back(std::abs(error.heading()));
    if (!lookup.is_clear(relation.from) || !lookup.is_clear(relation.to)) continue;
    clear_translation.push_back(translation.back());
    clear_rotation.push_back(rotation.back());
  }
  if (translation.empty()) return fail(Errc::kDegenerate, "no relation has poses at both of its stamps");
  result.relations = translation.size();
  result.translation_m = spread_of(translation);
  result.rotation_rad = spread_of(rotation);
  result.clear = clear_translation.size();
  result.clear_translation_m = spread_of(clear_translation);
  result.clear_rotation_rad = spread_of(clear_rotation);
  return result;
}

Result<AbsoluteError> absolute_error(const Trajectory& estimate, const Trajectory& truth, const Point2& p_robot_lever,
                                     double longest_gap_s) {
  const Trajectory sorted = by_stamp(truth);
  std::vector<Point2> ours, theirs;
  std::vector<double> turn_apart;
  for (const StampedPose& pose : estimate) {
    if (sorted.empty() || apart_s(sorted[nearest_in_time(sorted, pose.stamp)].stamp, pose.stamp) > longest_gap_s)
      continue;
    const Pose2 real = interpolated(sorted, pose.stamp);
    ours.push_back(pose.T_map_robot * p_robot_lever);
    theirs.push_back(real.translation());
    turn_apart.push_back(pose.T_map_robot.heading() - real.heading());
  }
  if (ours.size() < 2) return fail(Errc::kDegenerate, "fewer than two poses at stamps of the truth");
  const Pose2 T_truth_ours = best_alignment(ours, theirs);
  AbsoluteError error;
  double squares = 0, turn_squares = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double away = (T_truth_ours * ours[i] - theirs[i]).norm(),
                 turned = wrap_angle(turn_apart[i] + T_truth_ours.heading());
    squares += away * away;
    turn_squares += turned * turned;
    error.mean_m += away / static_cast<double>(ours.size());
    error.most_m = std::max(error.most_m, away);
    if (i > 0) error.path_m += (theirs[i] - theirs[i - 1]).norm();
  }
  error.poses = ours.size();
  error.rmse_m = std::sqrt(squares / static_cast<double>(ours.size()));
  error.rotation_rmse_rad = std::sqrt(turn_squares / static_cast<double>(ours.size()));
  return error;
}

Result<DisplacementError> displacement_error(const Trajectory& estimate, const Trajectory& truth,
                                             double longest_gap_s) {
  const Trajectory ours = by_stamp(estimate), theirs = by_stamp(truth);
  std::vector<std::pair<const StampedPose*, const StampedPose*>> matched;
  std::vector<bool> used(theirs.size(), false);
  for (const StampedPose& pose : ours) {
    if (theirs.empty()) break;
    std::optional<std::size_t> best;
    const auto middle = static_cast<std::ptrdiff_t>(nearest_in_time(theirs, pose.stamp));
    const auto consider = [&](std::ptrdiff_t i) {
      if (i < 0 || i >= static_cast<std::ptrdiff_t>(theirs.size())) return false;
      const auto at = static_cast<std::size_t>(i);
      if (apart_s(theirs[at].stamp, pose.stamp) > longest_gap_s) return false;
      if (!used[at] && (!best || apart_s(theirs[at].stamp, pose.stamp) < apart_s(theirs[*best].stamp, pose.stamp)))
        best = at;
      return true;
    };
    for (std::ptrdiff_t i = middle; consider(i);) ++i;
    for (std::ptrdiff_t i = middle - 1; consider(i);) --i;
    if (!best) continue;
    used[*best] = true;
    matched.emplace_back(&pose, &theirs[*best]);
  }
  if (matched.size() < 2) return fail(Errc::kDegenerate, "fewer than two poses at stamps of the truth");
  std::vector<double> lengths, turns;
  for (std::size_t i = 1; i < matched.size(); ++i) {
    const Pose2 our_step = matched[i - 1].first->T_map_robot.inverse() * matched[i].first->T_map_robot;
    const Pose2 true_step = matched[i - 1].second->T_map_robot.inverse() * matched[i].second->T_map_robot;
    lengths.push_back(std::abs(our_step.translation().norm() - true_step.translation().norm()));
    turns.push_back(std::abs(wrap_angle(our_step.heading() - true_step.heading())));
  }
  return DisplacementError{spread_of(lengths), spread_of(turns), lengths.size()};
}

}  // namespace smokemap
