#include "recording/ros_messages.hpp"

#include <cmath>

#include "maps/frame_tree.hpp"
#include "maps/radar_image.hpp"
#include "recording/cdr.hpp"

namespace smokemap {
namespace {

constexpr Stamp kNanosecondsPerSecond = 1'000'000'000;

Stamp read_stamp(CdrReader& cdr) {
  const auto seconds = cdr.number<std::int32_t>();
  const auto nanoseconds = cdr.number<std::uint32_t>();
  return seconds * kNanosecondsPerSecond + nanoseconds;
}

void write_stamp(CdrWriter& cdr, Stamp stamp) {
  Stamp seconds = stamp / kNanosecondsPerSecond;
  if (stamp % kNanosecondsPerSecond < 0) --seconds;
  cdr.number(static_cast<std::int32_t>(seconds));
  cdr.number(static_cast<std::uint32_t>(stamp - seconds * kNanosecondsPerSecond));
}

void write_header(CdrWriter& cdr, Stamp stamp, const std::string& frame) {
  write_stamp(cdr, stamp);
  cdr.string(frame);
}

Eigen::Vector3d read_vector(CdrReader& cdr) {
  const auto x = cdr.number<double>(), y = cdr.number<double>(), z = cdr.number<double>();
  return {x, y, z};
}

Eigen::Quaterniond read_quaternion(CdrReader& cdr) {
  const auto x = cdr.number<double>(), y = cdr.number<double>(), z = cdr.number<double>(), w = cdr.number<double>();
  return {w, x, y, z};
}

void write_doubles(CdrWriter& cdr, std::initializer_list<double> values) {
  for (const double value : values) cdr.number(value);
}

}  // namespace

std::optional<RosScan> decode_scan(std::span<const std::uint8_t> bytes) {
  CdrReader cdr(bytes);
  RosScan message;
  LaserScan& scan = message.scan;
  scan.stamp = read_stamp(cdr);
  message.frame = cdr.string();
  scan.angle_min_rad = cdr.number<float>();
  cdr.number<float>();  // angle_max: follows from the number of ranges, which is what drivers get right
  scan.angle_increment_rad = cdr.number<float>();
  scan.time_increment_s = cdr.number<float>();
  cdr.number<float>();  // scan_time
  scan.range_min_m = cdr.number<float>();
  scan.range_max_m = cdr.number<float>();
  scan.ranges_m = cdr.numbers<float>();
  scan.intensities = cdr.numbers<float>();
  if (!cdr.ok()) return std::nullopt;
  return message;
}

std::optional<RosOdometry> decode_odometry(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCovarianceBytes = 36 * sizeof(double);
  CdrReader cdr(bytes);
  RosOdometry message;
  message.odometry.stamp = read_stamp(cdr);
  message.frame = cdr.string();
  message.child_frame = cdr.string();
  const Eigen::Vector3d position = read_vector(cdr);
  const Eigen::Quaterniond orientation = read_quaternion(cdr);
  cdr.skip(kCovarianceBytes);
  message.odometry.speed_mps = read_vector(cdr).x();
  message.odometry.turn_rate_radps = read_vector(cdr).z();
  if (!cdr.ok()) return std::nullopt;
  const auto heading = heading_of(orientation);
  message.odometry.T_odom_robot = Pose2(position.x(), position.y(), heading.value_or(std::nan("")));
  return message;
}

std::optional<std::vector<RosTransform>> decode_transforms(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kLeastBytes = 8 + 2 * 5 + 7 * sizeof(double);
  CdrReader cdr(bytes);
  std::vector<RosTransform> transforms(cdr.length(kLeastBytes));
  for (RosTransform& transform : transforms) {
    transform.stamp = read_stamp(cdr);
    transform.parent = cdr.string();
    transform.child = cdr.string();
    transform.translation = read_vector(cdr);
    transform.rotation = read_quaternion(cdr);
  }
  if (!cdr.ok()) return std::nullopt;
  return transforms;
}

std::optional<RosRadar> decode_radar(std::span<const std::uint8_t> bytes) {
  CdrReader cdr(bytes);
  RosRadar message;
  const Stamp stamp = read_stamp(cdr);
  message.frame = cdr.string();
  const auto height = cdr.number<std::uint32_t>();
  const auto width = cdr.number<std::uint32_t>();
  const std::string encoding = cdr.string();
  const bool big_endian = cdr.number<std::uint8_t>() != 0;
  const auto step = cdr.number<std::uint32_t>();
  const auto data = cdr.numbers<std::uint8_t>();
  if (!cdr.ok() || encoding != "32FC1" || big_endian || height > kMostRadarAzimuths ||
      width > kMostRadarBins + kRadarRowHeader || step != width * sizeof(float) || data.size() % sizeof(float) != 0)
    return std::nullopt;
  std::vector<float> rows(data.size() / sizeof(float));
  if (!rows.empty()) std::memcpy(rows.data(), data.data(), data.size());
  auto sweep = from_radar_rows(rows, static_cast<int>(height), static_cast<int>(width));
  if (!sweep) return std::nullopt;
  message.sweep = std::move(*sweep);
  message.sweep.stamp = stamp;
  return message;
}

std::vector<std::uint8_t> encode_scan(const LaserScan& scan, const std::string& frame) {
  const auto steps = static_cast<double>(scan.ranges_m.empty() ? 0 : scan.ranges_m.size() - 1);
  CdrWriter cdr;
  write_header(cdr, scan.stamp, frame);
  cdr.number(static_cast<float>(scan.angle_min_rad));
  cdr.number(static_cast<float>(scan.angle_min_rad + steps * scan.angle_increment_rad));
  cdr.number(static_cast<float>(scan.angle_increment_rad));
  cdr.number(static_cast<float>(scan.time_increment_s));
  cdr.number(static_cast<float>(steps * scan.time_increment_s));
  cdr.number(static_cast<float>(scan.range_min_m));
  cdr.number(static_cast<float>(scan.range_max_m));
  cdr.numbers<float>(scan.ranges_m);
  cdr.numbers<float>(scan.intensities);
  return cdr.bytes();
}

std::vector<std::uint8_t> encode_odometry(const Odometry& odometry, const std::string& frame,
                                          const std::string& child_frame) {
  const Pose2& pose = odometry.T_odom_robot;
  CdrWriter cdr;
  write_header(cdr, odometry.stamp, frame);
  cdr.string(child_frame);
  write_doubles(cdr, {pose.x(), pose.y(), 0, 0, 0, std::sin(pose.heading() / 2), std::cos(pose.heading() / 2)});
  for (int i = 0; i < 36; ++i) cdr.number(0.0);
  write_doubles(cdr, {odometry.speed_mps, 0, 0, 0, 0, odometry.turn_rate_radps});
  for (int i = 0; i < 36; ++i) cdr.number(0.0);
  return cdr.bytes();
}

std::vector<std::uint8_t> encode_transforms(std::span<const RosTransform> transforms) {
  CdrWriter cdr;
  cdr.number(static_cast<std::uint32_t>(transforms.size()));
  for (const RosTransform& transform : transforms) {
    write_header(cdr, transform.stamp, transform.parent);
    cdr.string(transform.child);
    const auto& [t, q] = std::pair(transform.translation, transform.rotation);
    write_doubles(cdr, {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
  }
  return cdr.bytes();
}

std::vector<std::uint8_t> encode_radar(const RadarSweep& sweep, const std::string& frame) {
  const std::vector<float> rows = to_radar_rows(sweep);
  CdrWriter cdr;
  write_header(cdr, sweep.stamp, frame);
  const auto width = static_cast<std::uint32_t>(sweep.bins + kRadarRowHeader);
  cdr.number(static_cast<std::uint32_t>(sweep.azimuths));
  cdr.number(width);
  cdr.string("32FC1");
  cdr.number(std::uint8_t{0});
  cdr.number(static_cast<std::uint32_t>(width * sizeof(float)));
  cdr.numbers<std::uint8_t>({reinterpret_cast<const std::uint8_t*>(rows.data()), rows.size() * sizeof(float)});
  return cdr.bytes();
}

std::vector<std::uint8_t> encode_pose(const Pose2& pose, const std::string& frame, Stamp stamp) {
  CdrWriter cdr;
  write_header(cdr, stamp, frame);
  write_doubles(cdr, {pose.x(), pose.y(), 0, 0, 0, std::sin(pose.heading() / 2), std::cos(pose.heading() / 2)});
  return cdr.bytes();
}

std::vector<std::uint8_t> encode_string(const std::string& text) {
  CdrWriter cdr;
  cdr.string(text);
  return cdr.bytes();
}

}  // namespace smokemap
