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

std::optional<ActionName> parse_navigation_server(const std::string& topic) {
  constexpr std::string_view kPrefix = "rq/", kSuffix = "/_action/send_goalRequest", kName = "navigate_to_pose";
  if (!topic.starts_with(kPrefix) || !topic.ends_with(kSuffix)) return std::nullopt;
  if (topic.size() <= kPrefix.size() + kSuffix.size()) return std::nullopt;
  const std::string action = topic.substr(kPrefix.size(), topic.size() - kPrefix.size() - kSuffix.size());
  if (action.front() == '/' || action.substr(action.rfind('/') + 1) != kName) return std::nullopt;
  const std::size_t first = action.find('/');
  return ActionName{first == std::string::npos ? kLoneRobot : action.substr(0, first), action};
}

bool is_robot_name(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && name.size() <= 64 && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace smokemap
