#include "slam/reading_poses.hpp"

#include <unordered_set>

#include "core/expect.hpp"

namespace smokemap {
namespace {

/// Half a tick of a clock of hundredths, and what rounding to the microsecond may add.
constexpr Stamp kOneMoment = 5'500'000;

/// The last scan at or before each reading, the first at or after it; nothing where there is none.
struct Around {
  std::optional<std::size_t> before, after;  ///< indices of readings
};

std::vector<Around> scans_around(const std::vector<Reading>& readings) {
  std::vector<Around> around(readings.size());
  std::optional<std::size_t> scan;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (readings[i].pose_of_scan) scan = i;
    around[i].before = scan;
  }
  scan.reset();
  for (std::size_t i = readings.size(); i-- > 0;) {
    if (readings[i].pose_of_scan) scan = i;
    around[i].after = scan;
  }
  return around;
}

class Carrier {
 public:
  Carrier(const std::vector<Reading>& readings, const Trajectory& scans)
      : readings_(readings), scans_(scans), around_(scans_around(readings)) {}

  std::optional<StampedPose> pose_at(std::size_t i) const {
    const Around& near = around_[i];
    if (!near.before) return std::nullopt;
    StampedPose pose = scan_pose(*near.before);
    pose.stamp = readings_[i].stamp;
    if (*near.before == i) return pose;
    const auto from_before = carried(*near.before, i);
    if (!from_before) return std::nullopt;
    pose.T_map_robot = *from_before;
    const auto from_after = near.after ? carried(*near.after, i) : std::nullopt;
    if (from_after)
      pose.T_map_robot =
          interpolate(*from_before, *from_after,
                      static_cast<double>(i - *near.before) / static_cast<double>(*near.after - *near.before));
    return pose;
  }

 private:
  const StampedPose& scan_pose(std::size_t reading) const { return scans_[*readings_[reading].pose_of_scan]; }
  std::optional<Pose2> carried(std::size_t scan, std::size_t to) const {
    const auto &T_odom_scan = readings_[scan].T_odom_robot, &T_odom_to = readings_[to].T_odom_robot;
    if (!T_odom_scan || !T_odom_to) return std::nullopt;
    return scan_pose(scan).T_map_robot * (T_odom_scan->inverse() * *T_odom_to);
  }

  const std::vector<Reading>& readings_;
  const Trajectory& scans_;
  std::vector<Around> around_;
};

/// Of poses [begin, end), headings about the first's.
Pose2 mean_of(const Trajectory& poses, std::size_t begin, std::size_t end) {
  Point2 away = Point2::Zero();
  double turn = 0;
  const Pose2& first = poses[begin].T_map_robot;
  for (std::size_t i = begin; i < end; ++i) {
    away += poses[i].T_map_robot.translation() - first.translation();
    turn += wrap_angle(poses[i].T_map_robot.heading() - first.heading());
  }
  const auto count = static_cast<double>(end - begin);
  return {first.translation() + away / count, first.heading() + turn / count};
}

}  // namespace

Trajectory poses_of_readings(const std::vector<Reading>& readings, const Trajectory& scans) {
  for (const Reading& reading : readings) ENGINE_EXPECT(!reading.pose_of_scan || *reading.pose_of_scan < scans.size());
  const Carrier carrier(readings, scans);
  Trajectory poses;
  for (std::size_t i = 0; i < readings.size(); ++i)
    if (const auto pose = carrier.pose_at(i)) poses.push_back(*pose);
  Trajectory moments;
  std::unordered_set<Stamp> written;
  for (std::size_t begin = 0, end = 0; begin < poses.size(); begin = end) {
    while (end < poses.size() && std::abs(poses[end].stamp - poses[begin].stamp) <= kOneMoment) ++end;
    const Pose2 mean = mean_of(poses, begin, end);
    for (std::size_t i = begin; i < end; ++i)
      if (written.insert(poses[i].stamp).second)
        moments.push_back({poses[i].stamp, end - begin > 1 ? mean : poses[i].T_map_robot, poses[i].covariance});
  }
  return moments;
}

}  // namespace smokemap
