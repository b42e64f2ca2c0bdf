#include "recording/ros_log_builder.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace smokemap {
namespace {

std::string base_name(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

/// "/robot1/laser/scan" -> "robot1/laser".
std::string namespace_of(const std::string& topic) {
  const std::size_t first = topic.starts_with('/') ? 1 : 0;
  const std::size_t last = topic.rfind('/');
  return last == std::string::npos || last < first ? "" : topic.substr(first, last - first);
}

/// The namespace that two topics share, whole words only.
std::string common_namespace(const std::string& topic_a, const std::string& topic_b) {
  const std::string a = namespace_of(topic_a) + "/", b = namespace_of(topic_b) + "/";
  const auto differ = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  const std::string same(a.begin(), differ);
  const std::size_t last = same.rfind('/');
  return last == std::string::npos ? "" : same.substr(0, last);
}

std::string robot_name(const std::string& name_space) { return name_space.empty() ? "robot" : name_space; }

bool is_odometry_frame(const std::string& frame) { return frame.ends_with("odom"); }

}  // namespace

void RosLogBuilder::add(const std::string& topic, const std::string& type, std::span<const std::uint8_t> cdr) {
  if (type == kLaserScanType) {
    if (auto scan = decode_scan(cdr)) return keep(topic_index(topic, Kind::kScan), std::move(*scan));
  } else if (type == kOdometryType) {
    if (auto odometry = decode_odometry(cdr)) return keep(topic_index(topic, Kind::kOdometry), std::move(*odometry));
  } else if (type == kTransformsType) {
    if (auto transforms = decode_transforms(cdr)) return add_transforms(topic, *transforms);
  } else if (type == kImageType) {
    if (auto radar = decode_radar(cdr)) return keep(topic_index(topic, Kind::kRadar), std::move(*radar));
    return drop("picture that is no radar sweep");
  } else {
    return drop("type not used: " + type);
  }
  drop("damaged message of " + topic);
}

int RosLogBuilder::topic_index(const std::string& name, Kind kind) {
  for (std::size_t i = 0; i < topics_.size(); ++i)
    if (topics_[i].name == name && topics_[i].kind == kind) return static_cast<int>(i);
  topics_.push_back({name, kind, 0, "", false, ""});
  return static_cast<int>(topics_.size()) - 1;
}

void RosLogBuilder::keep(int topic, std::variant<RosScan, RosOdometry, RosRadar> message) {
  Topic& known = topics_[static_cast<std::size_t>(topic)];
  ++known.messages;
  if (const auto* odometry = std::get_if<RosOdometry>(&message)) known.base_frame = odometry->child_frame;
  records_.push_back({topic, std::move(message)});
}

void RosLogBuilder::add_transforms(const std::string& topic, const std::vector<RosTransform>& transforms) {
  const bool is_fixed = base_name(topic) == "tf_static";
  auto& [fixed, fixed_or_seen] = frames_[namespace_of(topic)];
  for (const RosTransform& t : transforms) {
    if (is_fixed) {
      fixed.set(t.parent, t.child, t.translation, t.rotation);
      fixed_or_seen.set(t.parent, t.child, t.translation, t.rotation);
    } else if (is_odometry_frame(t.parent)) {
      RosOdometry message{t.parent, t.child, {}};
      message.odometry.stamp = t.stamp;
      message.odometry.T_odom_robot =
          Pose2(t.translation.x(), t.translation.y(), heading_of(t.rotation).value_or(std::nan("")));
      keep(topic_index(topic, Kind::kTransformOdometry), std::move(message));
    } else if (!is_odometry_frame(t.child) && !fixed_or_seen.lookup(t.parent, t.child)) {
      fixed_or_seen.set(t.parent, t.child, t.translation, t.rotation);
    }
  }
}

int RosLogBuilder::best_odometry(const Topic& sensor) const {
  // A robot of its own name space beats a shared one; an odometry topic beats tf; "odom" beats other names; then the
  // fullest.
  int best = -1;
  std::tuple<std::size_t, bool, bool, std::size_t> best_rank;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const Topic& topic = topics_[i];
    if (topic.kind != Kind::kOdometry && topic.kind != Kind::kTransformOdometry) continue;
    const std::string shared = common_namespace(sensor.name, topic.name);
    const auto belongs_to_another = [&](const Topic& other) {
      return other.kind == sensor.kind && common_namespace(other.name, topic.name).size() > shared.size();
    };
    if (std::any_of(topics_.begin(), topics_.end(), belongs_to_another)) continue;
    const std::tuple rank{shared.size(), topic.kind == Kind::kOdometry, base_name(topic.name) == "odom",
                          topic.messages};
    if (best < 0 || rank > best_rank) best = static_cast<int>(i), best_rank = rank;
  }
  return best;
}

void RosLogBuilder::choose_odometry() {
  const auto is_sensor = [](const Topic& t) { return t.kind == Kind::kScan || t.kind == Kind::kRadar; };
  for (Topic& topic : topics_) {
    if (!is_sensor(topic)) continue;
    const int odometry = best_odometry(topic);
    if (odometry < 0) {
      topic.robot = robot_name(namespace_of(topic.name));
      continue;
    }
    Topic& chosen = topics_[static_cast<std::size_t>(odometry)];
    topic.robot = chosen.used ? chosen.robot : robot_name(common_namespace(topic.name, chosen.name));
    chosen.robot = topic.robot;
    chosen.used = true;
    base_frames_[topic.robot] = chosen.base_frame;
  }
  if (std::any_of(topics_.begin(), topics_.end(), is_sensor)) return;
  const auto is_topic = [](const Topic& t) { return t.kind == Kind::kOdometry; };
  const bool has_topic = std::any_of(topics_.begin(), topics_.end(), is_topic);
  for (Topic& topic : topics_) {
    topic.robot = robot_name(namespace_of(topic.name));
    topic.used = has_topic == is_topic(topic);
  }
}

void RosLogBuilder::choose_sensors(Kind kind) {
  std::map<std::string, Topic*> chosen;
  for (Topic& topic : topics_) {
    if (topic.kind != kind) continue;
    Topic*& best = chosen[topic.robot];
    const auto rank = [](const Topic& t) { return std::tuple(base_name(t.name) == "scan", t.messages); };
    if (!best || rank(topic) > rank(*best)) best = &topic;
  }
  for (const auto& [robot, topic] : chosen) topic->used = true;
}

/// In the robot's own transforms, else in the shared ones; what is fixed before what was only seen.
std::optional<SensorMount> RosLogBuilder::find_mount(const std::string& robot, const std::string& base,
                                                     const std::string& sensor) {
  for (const std::string& name_space : {robot, std::string()}) {
    const Frames& frames = frames_[name_space];
    if (auto mount = frames.fixed.mount(base, sensor)) return mount;
    if (auto mount = frames.fixed_or_seen.mount(base, sensor)) return mount;
  }
  return std::nullopt;
}

SensorMount RosLogBuilder::mount_of(const std::string& robot, const std::string& sensor_frame) {
  constexpr double kMostTiltRad = 0.1;
  const auto [known, is_new] = mounts_.try_emplace(robot + "|" + sensor_frame);
  if (!is_new) return known->second;
  std::optional<SensorMount> mount;
  for (const std::string& base : {base_frames_[robot], std::string("base_link"), std::string("base_footprint")})
    if (!mount && !base.empty()) mount = find_mount(robot, base, sensor_frame);
  if (!mount) {
    warn("no fixed transform to " + sensor_frame + ": taking the sensor of " + robot +
         " to sit at the middle of the robot, looking ahead");
  } else {
    known->second = *mount;
    if (mount->tilt_rad > kMostTiltRad)
      warn("the sensor " + sensor_frame + " of " + robot + " is tilted: walls will be bent");
  }
  return known->second;
}

void RosLogBuilder::emit(Record record) {
  const Topic& topic = topics_[static_cast<std::size_t>(record.topic)];
  if (!topic.used) return drop("topic not chosen: " + topic.name);
  if (auto* scan = std::get_if<RosScan>(&record.message)) {
    const SensorMount mount = mount_of(topic.robot, scan->frame);
    scan->scan.robot = topic.robot;
    scan->scan.T_robot_laser = mount.T_robot_sensor;
    if (mount.upside_down) scan->scan.angle_min_rad *= -1, scan->scan.angle_increment_rad *= -1;
    if (const auto sound = check(scan->scan); !sound) return drop(sound.error().message);
    log_.items.emplace_back(std::move(scan->scan));
  } else if (auto* odometry = std::get_if<RosOdometry>(&record.message)) {
    odometry->odometry.robot = topic.robot;
    if (topic.kind == Kind::kTransformOdometry && odometry->child_frame != topic.base_frame) return;
    if (!odometry->odometry.T_odom_robot.is_finite()) return drop("odometry that is not finite");
    log_.items.emplace_back(std::move(odometry->odometry));
  } else if (auto* radar = std::get_if<RosRadar>(&record.message)) {
    const SensorMount mount = mount_of(topic.robot, radar->frame);
    radar->sweep.robot = topic.robot;
    radar->sweep.T_robot_radar = mount.T_robot_sensor;
    if (mount.upside_down) radar->sweep.azimuth_min_rad *= -1, radar->sweep.azimuth_increment_rad *= -1;
    log_.items.emplace_back(std::move(radar->sweep));
  }
}

SensorLog RosLogBuilder::finish(std::string format) && {
  log_.format = std::move(format);
  choose_odometry();
  choose_sensors(Kind::kScan);
  choose_sensors(Kind::kRadar);
  log_.items.reserve(records_.size());
  for (Record& record : records_) emit(std::move(record));
  return std::move(log_);
}

}  // namespace smokemap
