#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "robots/navigate_client.hpp"
#include "robots/topic_table.hpp"

namespace smokemap {

/// What drives one robot: the writers exist while somebody subscribes, the action's client while a server is there.
///
/// `adopt` and `tick` belong to the gateway's thread; the rest is called by any thread that keeps `adopt` away
/// meanwhile (the gateway's mutex does).
class RobotCommander {
 public:
  /// Opens what the robot newly takes, closes what it no longer does.
  void adopt(const RobotTopics& topics, dds_entity_t participant, WaitThread& thread,
             const std::shared_ptr<const Clock>& clock);
  /// Call a few times a second. A goal that the robot's navigator did not answer goes to goal_pose, where somebody
  /// takes it.
  /// @return what has happened to goals
  std::vector<NavigationReport> tick(Stamp now);

  bool takes_velocity() const { return static_cast<bool>(velocity_.writer); }
  bool takes_goals() const { return navigation_ || goal_.writer; }
  bool navigates() const { return static_cast<bool>(navigation_); }

  Result<Ok> drive(double speed_mps, double turn_rate_radps, Stamp now) const;
  /// @return whether reports will follow
  Result<bool> send_goal(std::uint64_t number, const NavigateClient::Goal& goal, Stamp now);
  /// Nothing to do without a navigator: a goal_pose cannot be called off.
  Result<Ok> cancel_goals();

 private:
  struct Writer {
    std::string topic_name;
    bool stamped = false;
    DdsEntity topic;
    DdsEntity writer;
    void open(const std::string& name, bool is_stamped, const dds_topic_descriptor_t* type, dds_entity_t participant);
  };
  std::string robot_;
  Writer velocity_, goal_;
  std::unique_ptr<NavigateClient> navigation_;
  std::vector<NavigationReport> last_words_;  ///< of navigators that have gone
};

}  // namespace smokemap
