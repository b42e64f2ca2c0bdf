#include "robots/ros_names.hpp"

#include <algorithm>

namespace smokemap {

std::string dds_topic(const std::string& robot, const std::string& name) {
  return robot == kLoneRobot ? "rt/" + name : "rt/" + robot + "/" + name;
}

std::optional<RosName> parse_dds_topic(const std::string& topic) {
  constexpr std::string_view kPrefix = "rt/";
  if (!topic.starts_with(kPrefix) || topic.ends_with('/') || topic.size() == kPrefix.size()) return std::nullopt;
  if (topic.find("/_action/") != std::string::npos) return std::nullopt;
  const std::string name = topic.substr(kPrefix.size());
  const std::size_t first = name.find('/');
  if (first == std::string::npos) return RosName{kLoneRobot, name};
  if (first == 0) return std::nullopt;
  return RosName{name.substr(0, first), name.substr(name.rfind('/') + 1)};
}

bool is_robot_name(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && name.size() <= 64 && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace smokemap
