#include "robots/ros_convert.hpp"

#include <cmath>
#include <cstring>

#include "maps/radar_image.hpp"

namespace smokemap {
namespace {

constexpr Stamp kNanosecondsPerSecond = 1'000'000'000;

/// The C structs want char*, and Cyclone only reads it in a write.
char* borrowed(const std::string& text) { return const_cast<char*>(text.c_str()); }

RosHeaderMsg header_of(Stamp stamp, const std::string& frame) { return {to_ros_time(stamp), borrowed(frame)}; }

dds_sequence_float borrowed(const std::vector<float>& values) {
  const auto length = static_cast<std::uint32_t>(values.size());
  return {length, length, const_cast<float*>(values.data()), false};
}

geometry_msgs_msg_dds__Quaternion_ quaternion_of(double heading) {
  return {0, 0, std::sin(heading / 2), std::cos(heading / 2)};
}

Result<Pose2> planar(double x, double y, const geometry_msgs_msg_dds__Quaternion_& q) {
  const auto heading = heading_of(Eigen::Quaterniond(q.w, q.x, q.y, q.z));
  if (!heading || !std::isfinite(x) || !std::isfinite(y)) return fail(Errc::kCorrupt, "pose that is not finite");
  return Pose2(x, y, *heading);
}

}  // namespace

Stamp to_stamp(const RosTimeMsg& time) { return time.sec * kNanosecondsPerSecond + time.nanosec; }

RosTimeMsg to_ros_time(Stamp stamp) {
  Stamp seconds = stamp / kNanosecondsPerSecond;
  if (stamp % kNanosecondsPerSecond < 0) --seconds;
  return {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(stamp - seconds * kNanosecondsPerSecond)};
}

std::string text_of(const char* text) { return text ? text : ""; }

LaserScan to_scan(const RosScanMsg& message) {
  LaserScan scan;
  scan.stamp = to_stamp(message.header.stamp);
  scan.angle_min_rad = message.angle_min;
  scan.angle_increment_rad = message.angle_increment;
  scan.time_increment_s = message.time_increment;
  scan.range_min_m = message.range_min;
  scan.range_max_m = message.range_max;
  scan.ranges_m.assign(message.ranges._buffer, message.ranges._buffer + message.ranges._length);
  scan.intensities.assign(message.intensities._buffer, message.intensities._buffer + message.intensities._length);
  return scan;
}

Result<Odometry> to_odometry(const RosOdometryMsg& message) {
  const auto& pose = message.pose.pose;
  const auto planar_pose = planar(pose.position.x, pose.position.y, pose.orientation);
  if (!planar_pose) return planar_pose.error();
  Odometry odometry;
  odometry.stamp = to_stamp(message.header.stamp);
  odometry.T_odom_robot = *planar_pose;
  odometry.speed_mps = message.twist.linear.x;
  odometry.turn_rate_radps = message.twist.angular.z;
  if (!std::isfinite(odometry.speed_mps) || !std::isfinite(odometry.turn_rate_radps))
    return fail(Errc::kCorrupt, "odometry with a speed that is not finite");
  return odometry;
}

Result<Odometry> to_odometry(const RosTransformMsg& message) {
  const auto& t = message.transform;
  const auto pose = planar(t.translation.x, t.translation.y, t.rotation);
  if (!pose) return pose.error();
  return Odometry{to_stamp(message.header.stamp), "", *pose, 0, 0};
}

Result<RadarSweep> to_sweep(const RosImageMsg& message) {
  if (text_of(message.encoding) != "32FC1" || message.is_bigendian != 0 || message.height > kMostRadarAzimuths ||
      message.width > kMostRadarBins + kRadarRowHeader || message.step != message.width * sizeof(float) ||
      message.data._length != std::size_t{message.step} * message.height)
    return fail(Errc::kCorrupt, "picture that is no radar sweep");
  std::vector<float> rows(message.data._length / sizeof(float));
  if (!rows.empty()) std::memcpy(rows.data(), message.data._buffer, message.data._length);
  auto sweep = from_radar_rows(rows, static_cast<int>(message.height), static_cast<int>(message.width));
  if (sweep) sweep->stamp = to_stamp(message.header.stamp);
  return sweep;
}

Result<Pose2> to_pose(const RosPoseMsg& message) {
  return planar(message.pose.position.x, message.pose.position.y, message.pose.orientation);
}

int add_transforms(const RosTransformsMsg& message, FrameTree& tree) {
  int refused = 0;
  for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
    const RosTransformMsg& sent = message.transforms._buffer[i];
    const auto& [t, q] = std::pair(sent.transform.translation, sent.transform.rotation);
    refused += !tree.set(text_of(sent.header.frame_id), text_of(sent.child_frame_id), {t.x, t.y, t.z},
                         Eigen::Quaterniond(q.w, q.x, q.y, q.z));
  }
  return refused;
}

bool write_scan(dds_entity_t writer, const LaserScan& scan, const std::string& frame) {
  const auto steps = static_cast<double>(scan.ranges_m.empty() ? 0 : scan.ranges_m.size() - 1);
  RosScanMsg message{};
  message.header = header_of(scan.stamp, frame);
  message.angle_min = static_cast<float>(scan.angle_min_rad);
  message.angle_max = static_cast<float>(scan.angle_min_rad + steps * scan.angle_increment_rad);
  message.angle_increment = static_cast<float>(scan.angle_increment_rad);
  message.time_increment = static_cast<float>(scan.time_increment_s);
  message.scan_time = static_cast<float>(steps * scan.time_increment_s);
  message.range_min = static_cast<float>(scan.range_min_m);
  message.range_max = static_cast<float>(scan.range_max_m);
  message.ranges = borrowed(scan.ranges_m);
  message.intensities = borrowed(scan.intensities);
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

bool write_odometry(dds_entity_t writer, const Odometry& odometry, const std::string& frame,
                    const std::string& child_frame) {
  const Pose2& pose = odometry.T_odom_robot;
  RosOdometryMsg message{};
  message.header = header_of(odometry.stamp, frame);
  message.child_frame_id = borrowed(child_frame);
  message.pose.pose.position = {pose.x(), pose.y(), 0};
  message.pose.pose.orientation = quaternion_of(pose.heading());
  message.twist.linear = {odometry.speed_mps, 0, 0};
  message.twist.angular = {0, 0, odometry.turn_rate_radps};
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

bool write_sweep(dds_entity_t writer, const RadarSweep& sweep, const std::string& frame) {
  std::vector<float> rows = to_radar_rows(sweep);
  const std::string encoding = "32FC1";
  RosImageMsg message{};
  message.header = header_of(sweep.stamp, frame);
  message.height = static_cast<std::uint32_t>(sweep.azimuths);
  message.width = static_cast<std::uint32_t>(sweep.bins + kRadarRowHeader);
  message.encoding = borrowed(encoding);
  message.step = static_cast<std::uint32_t>(message.width * sizeof(float));
  const auto bytes = static_cast<std::uint32_t>(rows.size() * sizeof(float));
  message.data = {bytes, bytes, reinterpret_cast<std::uint8_t*>(rows.data()), false};
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

RosPoseMsg ros_pose(const Pose2& T_frame_goal, const std::string& frame, Stamp stamp) {
  RosPoseMsg message{};
  message.header = header_of(stamp, frame);
  message.pose.position = {T_frame_goal.x(), T_frame_goal.y(), 0};
  message.pose.orientation = quaternion_of(T_frame_goal.heading());
  return message;
}

bool write_goal(dds_entity_t writer, const Pose2& T_frame_goal, const std::string& frame, Stamp stamp) {
  const RosPoseMsg message = ros_pose(T_frame_goal, frame, stamp);
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

bool write_twist(dds_entity_t writer, double speed_mps, double turn_rate_radps) {
  const RosTwistMsg message{{speed_mps, 0, 0}, {0, 0, turn_rate_radps}};
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

bool write_twist_stamped(dds_entity_t writer, double speed_mps, double turn_rate_radps, Stamp stamp) {
  const std::string frame = "base_link";
  const RosTwistStampedMsg message{header_of(stamp, frame), {speed_mps, 0, 0}, {0, 0, turn_rate_radps}};
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

bool write_transforms(dds_entity_t writer, const std::vector<NamedTransform>& transforms) {
  std::vector<RosTransformMsg> messages(transforms.size());
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    const NamedTransform& named = transforms[i];
    messages[i].header = header_of(named.stamp, named.parent);
    messages[i].child_frame_id = borrowed(named.child);
    messages[i].transform.translation = {named.T_parent_child.x(), named.T_parent_child.y(), 0};
    messages[i].transform.rotation = quaternion_of(named.T_parent_child.heading());
  }
  RosTransformsMsg message{};
  const auto length = static_cast<std::uint32_t>(messages.size());
  message.transforms = {length, length, messages.data(), false};
  return dds_write(writer, &message) == DDS_RETCODE_OK;
}

}  // namespace smokemap
