#include "recording/carmen_log.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <vector>

namespace smokemap {
namespace {

/// Words of one line, each taken once; after the first word that does not fit, everything fails.
class CarmenLine {
 public:
  explicit CarmenLine(std::string_view line) : rest_(line) {}

  std::string_view word() {
    const std::size_t begin = rest_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) {
      ok_ = false;
      return {};
    }
    const std::size_t end = std::min(rest_.find_first_of(" \t\r", begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

  double number() {
    const std::string_view text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) ok_ = false;
    return value;
  }

  /// A length, then as many numbers; believed only as far as the line has characters for them.
  std::vector<float> numbers() {
    const double count = number();
    if (!ok_ || count < 0 || count > static_cast<double>(rest_.size())) {
      ok_ = false;
      return {};
    }
    std::vector<float> values(static_cast<std::size_t>(count));
    for (float& value : values) value = static_cast<float>(number());
    return values;
  }

  Pose2 pose() {
    const double x = number(), y = number(), heading = number();
    return {x, y, heading};
  }

  bool ok() const { return ok_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

struct CarmenScan {
  LaserScan scan;
  Pose2 T_odom_laser;
  Pose2 T_odom_robot;
  bool fov_known = false;  ///< angles are in the record itself
  bool is_flaser = true;
};

Stamp read_carmen_stamp(CarmenLine& line) { return from_seconds(std::clamp(line.number(), -9e9, 9e9)); }

std::optional<CarmenScan> read_flaser(CarmenLine& line) {
  CarmenScan read;
  read.scan.ranges_m = line.numbers();
  read.T_odom_laser = line.pose();
  read.T_odom_robot = line.pose();
  read.scan.stamp = read_carmen_stamp(line);
  if (!line.ok()) return std::nullopt;
  return read;
}

std::optional<CarmenScan> read_robotlaser(CarmenLine& line) {
  CarmenScan read;
  read.is_flaser = false;
  read.fov_known = true;
  line.number();  // type
  read.scan.angle_min_rad = line.number();
  line.number();  // field of view
  read.scan.angle_increment_rad = line.number();
  read.scan.range_max_m = line.number();
  line.number(), line.number();  // accuracy, remission mode
  read.scan.ranges_m = line.numbers();
  read.scan.intensities = line.numbers();
  if (read.scan.intensities.size() != read.scan.ranges_m.size()) read.scan.intensities.clear();
  read.T_odom_laser = line.pose();
  read.T_odom_robot = line.pose();
  for (int i = 0; i < 5; ++i) line.number();  // speeds, safety distances, turn axis
  read.scan.stamp = read_carmen_stamp(line);
  if (!line.ok()) return std::nullopt;
  return read;
}

/// Everything between reading lines and the finished log.
struct CarmenParts {
  SensorLog log;
  std::vector<CarmenScan> scans;          ///< in file order
  std::vector<std::size_t> item_of_scan;  ///< its place in log.items
  std::optional<double> fov_deg, range_max_m;
};

void read_line(std::string_view text, CarmenParts& parts) {
  CarmenLine line(text);
  const std::string_view keyword = line.word();
  if (keyword.empty() || keyword.front() == '#') return;
  if (keyword == "FLASER" || keyword == "ROBOTLASER1") {
    auto scan = keyword == "FLASER" ? read_flaser(line) : read_robotlaser(line);
    if (!scan) return void(++parts.log.dropped["damaged " + std::string(keyword)]);
    parts.log.items.emplace_back(Odometry{scan->scan.stamp, "robot", scan->T_odom_robot, 0, 0});
    parts.item_of_scan.push_back(parts.log.items.size());
    parts.log.items.emplace_back(LaserScan{});
    parts.scans.push_back(std::move(*scan));
  } else if (keyword == "ODOM") {
    Odometry odometry{0, "robot", line.pose(), 0, 0};
    odometry.speed_mps = line.number();
    odometry.turn_rate_radps = line.number();
    line.number();  // acceleration
    odometry.stamp = read_carmen_stamp(line);
    if (!line.ok()) return void(++parts.log.dropped["damaged ODOM"]);
    parts.log.items.emplace_back(odometry);
  } else if (keyword == "PARAM") {
    const std::string_view name = line.word();
    const double value =
        name.starts_with("laser_front_laser_fov") || name == "robot_front_laser_max" ? line.number() : 0;
    if (line.ok() && value > 0) (name == "robot_front_laser_max" ? parts.range_max_m : parts.fov_deg) = value;
  } else {
    ++parts.log.dropped["record not used: " + std::string(keyword.substr(0, 32))];
  }
}

/// The one pose of the laser on the robot, if all scans agree about it.
std::optional<Pose2> laser_mount(const std::vector<CarmenScan>& scans) {
  constexpr double kSameM = 0.002, kSameRad = 0.002, kMostM = 2.0;
  std::optional<Pose2> mount;
  for (const CarmenScan& scan : scans) {
    const Pose2 T_robot_laser = scan.T_odom_robot.inverse() * scan.T_odom_laser;
    if (!mount) mount = T_robot_laser;
    if ((T_robot_laser.translation() - mount->translation()).norm() > kSameM ||
        std::abs(wrap_angle(T_robot_laser.heading() - mount->heading())) > kSameRad)
      return std::nullopt;
  }
  return mount && mount->translation().norm() < kMostM ? mount : std::nullopt;
}

/// See the header. The value itself already means "no return": classify() counts ranges below range_max as hits.
double range_limit(const CarmenParts& parts) {
  constexpr double kLmsLimitM = 80, kPlsLimitM = 50;
  constexpr std::size_t kAgainAndAgain = 10;
  float largest = 0;
  std::size_t times = 0;
  for (const CarmenScan& scan : parts.scans)
    for (const float range : scan.scan.ranges_m) {
      if (range > largest) largest = range, times = 0;
      times += range == largest;
    }
  double limit = largest >= kLmsLimitM ? kLmsLimitM : largest >= kPlsLimitM ? kPlsLimitM : 0;
  if (parts.range_max_m && (limit == 0 || *parts.range_max_m < limit)) limit = *parts.range_max_m;
  if (limit > 0) return limit;
  return times >= kAgainAndAgain ? largest : std::nextafter(largest, std::numeric_limits<float>::infinity());
}

void set_angles(LaserScan& scan, double fov_rad) {
  const std::size_t beams = scan.ranges_m.size();
  const double steps = static_cast<double>(beams % 2 == 1 && beams > 1 ? beams - 1 : beams);
  scan.angle_min_rad = -fov_rad / 2;
  scan.angle_increment_rad = fov_rad / std::max(1.0, steps);
}

SensorLog assemble(CarmenParts parts) {
  SensorLog& log = parts.log;
  log.format = "carmen";
  const bool has_flaser =
      std::any_of(parts.scans.begin(), parts.scans.end(), [](const auto& s) { return s.is_flaser; });
  std::set<std::size_t> left_out;
  const double limit_m = range_limit(parts);
  const auto mount = laser_mount(parts.scans);
  if (!mount && !parts.scans.empty())
    log.warnings.emplace_back(
        "the poses of laser and robot disagree from scan to scan: taking the laser to sit at the middle");
  const auto leave_out = [&](std::size_t i, const std::string& reason) {
    ++log.dropped[reason];
    left_out.insert({parts.item_of_scan[i], parts.item_of_scan[i] - 1});
  };
  for (std::size_t i = 0; i < parts.scans.size(); ++i) {
    CarmenScan& read = parts.scans[i];
    if (read.is_flaser != has_flaser) {
      leave_out(i, "ROBOTLASER1 beside FLASER");
      continue;
    }
    read.scan.robot = "robot";
    if (!read.fov_known) set_angles(read.scan, radians(parts.fov_deg.value_or(180)));
    if (!(read.scan.range_max_m > 0 && read.scan.range_max_m < limit_m)) read.scan.range_max_m = limit_m;
    read.scan.T_robot_laser = mount.value_or(Pose2());
    if (const auto sound = check(read.scan); !sound)
      leave_out(i, sound.error().message);
    else
      log.items[parts.item_of_scan[i]] = std::move(read.scan);
  }
  std::size_t at = 0;
  if (!left_out.empty()) std::erase_if(log.items, [&](const LogItem&) { return left_out.contains(at++); });
  return std::move(log);
}

}  // namespace

bool looks_like_carmen(std::string_view text) {
  constexpr std::size_t kLook = 65'536;
  text = text.substr(0, kLook);
  for (const std::string_view keyword : {"FLASER ", "ODOM ", "PARAM ", "ROBOTLASER1 ", "# CARMEN"}) {
    if (text.starts_with(keyword)) return true;
    if (text.starts_with('#') && text.find("\n" + std::string(keyword)) != std::string_view::npos) return true;
  }
  return false;
}

Result<SensorLog> read_carmen(std::string_view text) {
  CarmenParts parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    read_line(text.substr(0, end), parts);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  SensorLog log = assemble(std::move(parts));
  if (log.items.empty()) return fail(Errc::kDegenerate, "a CARMEN log without scans or odometry");
  return log;
}

}  // namespace smokemap
