#include "robots/robot_commander.hpp"

#include <utility>

#include "robots/ros_convert.hpp"
#include "robots/ros_qos.hpp"

namespace smokemap {

void RobotCommander::Writer::open(const std::string& name, bool is_stamped, const dds_topic_descriptor_t* type,
                                  dds_entity_t participant) {
  if (topic_name == name && stamped == is_stamped) return;
  writer = DdsEntity();
  topic = DdsEntity();
  topic_name = name;
  stamped = is_stamped;
  if (name.empty()) return;
  topic = DdsEntity(dds_create_topic(participant, type, name.c_str(), nullptr, nullptr));
  if (topic) writer = DdsEntity(dds_create_writer(participant, topic.get(), state_qos(10).get(), nullptr));
}

void RobotCommander::adopt(const RobotTopics& topics, dds_entity_t participant, WaitThread& thread,
                           const std::shared_ptr<const Clock>& clock) {
  robot_ = topics.robot;
  velocity_.open(
      topics.velocity, topics.stamped_velocity,
      topics.stamped_velocity ? &geometry_msgs_msg_dds__TwistStamped__desc : &geometry_msgs_msg_dds__Twist__desc,
      participant);
  goal_.open(topics.goal, true, &geometry_msgs_msg_dds__PoseStamped__desc, participant);
  const NavigateClient::Server server{topics.robot, topics.navigation, topics.headed_services};
  if (navigation_ && navigation_->server() == server) return;
  if (navigation_) {
    navigation_->abandon();
    for (NavigationReport& report : navigation_->take_reports()) last_words_.push_back(std::move(report));
    navigation_.reset();
  }
  if (topics.navigation.empty()) return;
  auto opened = NavigateClient::open(server, participant, thread, clock);
  if (opened) navigation_ = std::move(*opened);
}

std::vector<NavigationReport> RobotCommander::tick(Stamp now) {
  std::vector<NavigationReport> reports = std::exchange(last_words_, {});
  if (!navigation_) return reports;
  const auto unanswered = navigation_->tick(now);
  if (unanswered && goal_.writer)
    (void)write_goal(goal_.writer.get(), unanswered->T_frame_goal, unanswered->frame, now);
  for (NavigationReport& report : navigation_->take_reports()) reports.push_back(std::move(report));
  return reports;
}

Result<Ok> RobotCommander::drive(double speed_mps, double turn_rate_radps, Stamp now) const {
  if (!velocity_.writer) return fail(Errc::kNotFound, "nobody takes velocities for " + robot_);
  const bool sent = velocity_.stamped ? write_twist_stamped(velocity_.writer.get(), speed_mps, turn_rate_radps, now)
                                      : write_twist(velocity_.writer.get(), speed_mps, turn_rate_radps);
  if (!sent) return fail(Errc::kIo, "the network did not take the velocity for " + robot_);
  return Ok{};
}

Result<bool> RobotCommander::send_goal(std::uint64_t number, const NavigateClient::Goal& goal, Stamp now) {
  if (navigation_) {
    if (const auto sent = navigation_->send(number, goal); !sent) return sent.error();
    return true;
  }
  if (!goal_.writer) return fail(Errc::kNotFound, "nobody takes goals for " + robot_);
  if (!write_goal(goal_.writer.get(), goal.T_frame_goal, goal.frame, now))
    return fail(Errc::kIo, "the network did not take the goal for " + robot_);
  return false;
}

Result<Ok> RobotCommander::cancel_goals() { return navigation_ ? navigation_->cancel_all() : Result<Ok>(Ok{}); }

}  // namespace smokemap
