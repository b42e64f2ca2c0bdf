#include "robots/topic_table.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "robots/ros_names.hpp"

namespace smokemap {

/// The topic of that type in the robot's namespace: the wanted name first, then (unless only that will do) the first by
/// name.
std::string TopicTable::choose(const Endpoints& endpoints, const std::string& robot, const char* type,
                               const char* wanted, bool only_wanted) {
  std::string best;
  for (const auto& [id, endpoint] : endpoints) {
    if (endpoint.type != type) continue;
    const auto name = parse_dds_topic(endpoint.topic);
    if (!name || name->robot != robot || (only_wanted && name->last_word != wanted)) continue;
    const auto rank = [&](const std::string& topic) {
      return std::tuple(!topic.ends_with("/" + std::string(wanted)), topic);
    };
    if (best.empty() || rank(endpoint.topic) < rank(best)) best = endpoint.topic;
  }
  return best;
}

/// The maker of a DDS writes its number into the first bytes of every identifier. Only the two whose services are known
/// are trusted with goals by action: the others are given theirs on goal_pose.
void TopicTable::find_navigation(RobotTopics& robot, const std::string& name_space) const {
  constexpr std::array<std::uint8_t, 2> kCyclone{0x01, 0x10}, kFast{0x01, 0x0f};
  if (!robot.navigation.empty()) return;
  for (const auto& [id, endpoint] : readers_) {
    if (endpoint.type != kSendGoalTypeName) continue;
    const auto name = parse_navigation_server(endpoint.topic);
    const std::array<std::uint8_t, 2> vendor{id[0], id[1]};
    if (!name || name->robot != name_space || (vendor != kCyclone && vendor != kFast)) continue;
    if (!robot.navigation.empty() && robot.navigation <= name->action) continue;
    robot.navigation = name->action;
    robot.headed_services = vendor == kCyclone;
  }
}

void TopicTable::complete(RobotTopics& robot, const std::string& name_space) const {
  const auto fill = [](std::string& topic, const std::string& found) {
    if (topic.empty()) topic = found;
  };
  fill(robot.odometry, choose(writers_, name_space, kOdometryTypeName, "odom", false));
  fill(robot.radar, choose(writers_, name_space, kImageTypeName, "radar", true));
  fill(robot.moving_transforms, choose(writers_, name_space, kTransformsTypeName, "tf", true));
  fill(robot.goal, choose(readers_, name_space, kPoseTypeName, "goal_pose", true));
  find_navigation(robot, name_space);
  if (!robot.velocity.empty()) return;
  robot.velocity = choose(readers_, name_space, kTwistStampedTypeName, "cmd_vel", true);
  robot.stamped_velocity = !robot.velocity.empty();
  fill(robot.velocity, choose(readers_, name_space, kTwistTypeName, "cmd_vel", true));
}

std::vector<RobotTopics> TopicTable::robots() const {
  std::set<std::string> names;
  for (const auto& [id, endpoint] : writers_)
    if (endpoint.type == kScanTypeName)
      if (const auto name = parse_dds_topic(endpoint.topic)) names.insert(name->robot);
  std::vector<RobotTopics> robots;
  for (const std::string& name : names) {
    RobotTopics robot;
    robot.robot = name;
    robot.scan = choose(writers_, name, kScanTypeName, "scan", false);
    complete(robot, name);
    const bool shares = names.size() == 1 && name != kLoneRobot;
    if (shares) complete(robot, kLoneRobot);
    for (const std::string& name_space : {name, std::string(kLoneRobot)}) {
      const std::string topic = choose(writers_, name_space, kTransformsTypeName, "tf_static", true);
      if (!topic.empty() && (robot.fixed_transforms.empty() || robot.fixed_transforms[0] != topic))
        robot.fixed_transforms.push_back(topic);
    }
    robots.push_back(std::move(robot));
  }
  return robots;
}

OfferedQos TopicTable::offer(const std::string& topic) const {
  OfferedQos weakest{true, true};
  bool any = false;
  for (const auto& [id, endpoint] : writers_) {
    if (endpoint.topic != topic) continue;
    any = true;
    weakest.reliable = weakest.reliable && endpoint.offer.reliable;
    weakest.transient_local = weakest.transient_local && endpoint.offer.transient_local;
  }
  return any ? weakest : OfferedQos{};
}

bool TopicTable::writes(const DdsGuid& participant, const std::string& topic) const {
  return std::any_of(writers_.begin(), writers_.end(), [&](const auto& writer) {
    return writer.second.participant == participant && writer.second.topic == topic;
  });
}

}  // namespace smokemap
