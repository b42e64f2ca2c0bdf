#include "recording/trajectory_tum.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "maps/frame_tree.hpp"
#include "recording/file_bytes.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kMostTrajectoryBytes = std::size_t{1} << 30;

std::string tum_stamp(Stamp stamp) {
  constexpr Stamp kSecond = 1'000'000'000;
  std::array<char, 40> text;
  const bool negative = stamp < 0;
  const std::uint64_t size = negative ? 0 - static_cast<std::uint64_t>(stamp) : static_cast<std::uint64_t>(stamp);
  std::snprintf(text.data(), text.size(), "%s%" PRIu64 ".%09" PRIu64, negative ? "-" : "", size / kSecond,
                size % kSecond);
  return text.data();
}

/// Eight numbers with blanks between; false on anything else.
bool read_tum_line(std::string_view line, std::array<double, 8>& numbers, std::string_view& stamp_text) {
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size())); };
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    skip_blanks();
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), numbers[i]);
    if (error != std::errc() || !std::isfinite(numbers[i])) return false;
    const auto length = static_cast<std::size_t>(end - line.data());
    if (i == 0) stamp_text = line.substr(0, length);
    line.remove_prefix(length);
  }
  skip_blanks();
  return line.empty();
}

/// A double holds today's time to a quarter of a microsecond: read the digits instead.
Stamp exact_stamp(std::string_view text, double seconds) {
  const std::size_t dot = text.find('.');
  if (text.find_first_not_of("0123456789.-") != std::string_view::npos) return from_seconds(seconds);
  std::int64_t whole = 0, fraction = 0;
  const bool negative = text.starts_with('-');
  const std::string_view digits = text.substr(negative, std::min(dot, text.size()) - negative);
  if (std::from_chars(digits.data(), digits.data() + digits.size(), whole).ec != std::errc() || whole > 9'000'000'000)
    return from_seconds(seconds);
  std::string after(dot == std::string_view::npos ? "" : text.substr(dot + 1, 9));
  after.resize(9, '0');
  std::from_chars(after.data(), after.data() + after.size(), fraction);
  const Stamp stamp = whole * 1'000'000'000 + fraction;
  return negative ? -stamp : stamp;
}

}  // namespace

std::string to_tum(const Trajectory& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 80);
  std::array<char, 768> line;  // the largest double has 309 digits before its point
  for (const StampedPose& pose : trajectory) {
    const Pose2& T = pose.T_map_robot;
    const int length = std::snprintf(line.data(), line.size(), " %.6f %.6f 0 0 0 %.9f %.9f\n", T.x(), T.y(),
                                     std::sin(T.heading() / 2), std::cos(T.heading() / 2));
    text += tum_stamp(pose.stamp);
    text.append(line.data(), static_cast<std::size_t>(length));
  }
  return text;
}

Result<Trajectory> from_tum(std::string_view text) {
  Trajectory trajectory;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos || line[begin] == '#') continue;
    std::array<double, 8> n{};
    std::string_view stamp_text;
    const bool read = read_tum_line(line, n, stamp_text);
    const auto heading = heading_of(Eigen::Quaterniond(n[7], n[4], n[5], n[6]));
    if (!read || !heading || std::abs(n[0]) > 9e9)
      return fail(Errc::kCorrupt, "line " + std::to_string(number) + " of the trajectory is not t x y z qx qy qz qw");
    trajectory.push_back({exact_stamp(stamp_text, n[0]), Pose2(n[1], n[2], *heading), Eigen::Matrix3d::Zero()});
  }
  return trajectory;
}

Result<Ok> write_tum(const Trajectory& trajectory, const std::filesystem::path& path) {
  return write_file(path, to_tum(trajectory));
}

Result<Trajectory> read_tum(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMostTrajectoryBytes);
  if (!bytes) return bytes.error();
  return from_tum({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
}

}  // namespace smokemap
