#pragma once

#include <array>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "geometry/pose2.hpp"
#include "robots/navigation_report.hpp"
#include "robots/ros_service.hpp"
#include "robots/wait_thread.hpp"

namespace smokemap {

/// Speaks nav2_msgs/action/NavigateToPose to one robot: sends a goal, follows it to its end, calls it off.
///
/// What happens to a goal is believed from the action's status and feedback topics, which name the goal; replies to
/// services name only the question, and without headers not even that. A goal that nothing answers within
/// `answer_within_s` counts as unanswered and is never sent again in another form.
class NavigateClient {
 public:
  struct Server {
    std::string robot;
    std::string action;  ///< "fox/navigate_to_pose"
    bool headed = true;  ///< rmw_cyclonedds; false: rmw_fastrtps
    bool operator==(const Server&) const = default;
  };
  struct Goal {
    Pose2 T_frame_goal;
    std::string frame;
  };

  /// Listens on `thread`; lives and dies there. kIo when DDS refuses.
  static Result<std::unique_ptr<NavigateClient>> open(Server server, dds_entity_t participant, WaitThread& thread,
                                                      std::shared_ptr<const Clock> clock);
  ~NavigateClient();
  NavigateClient(const NavigateClient&) = delete;
  NavigateClient& operator=(const NavigateClient&) = delete;

  const Server& server() const { return server_; }

  /// Any thread, as all below. A goal before it is given up for this one; reports carry `number`.
  Result<Ok> send(std::uint64_t number, const Goal& goal);
  /// Calls off every goal of this robot, whoever sent it.
  Result<Ok> cancel_all();

  /// Call a few times a second. The goal that was not answered in time, once.
  std::optional<Goal> tick(Stamp now);
  /// What has happened since the last call; of feedback only the newest.
  std::vector<NavigationReport> take_reports();
  /// The server has gone: a goal that has not ended is reported as unanswered.
  void abandon();

 private:
  using GoalId = std::array<std::uint8_t, 16>;
  struct Active {
    std::uint64_t number = 0;
    GoalId id{};
    Goal goal;
    Stamp sent_at = 0;
    bool answered = false;  ///< the robot named it, or accepted it
    bool refused = false;   ///< a reply without a header said no: perhaps to somebody else
    NavigationReport report;
  };
  /// A question whose reply is awaited.
  struct Question {
    std::int64_t number = 0;
    std::uint64_t goal = 0;
  };

  NavigateClient(Server server, WaitThread& thread, std::shared_ptr<const Clock> clock);
  bool open_ends(dds_entity_t participant);
  void on_accepted_or_not();
  void on_result();
  void on_status();
  void on_feedback();
  std::optional<Question> answered_question(std::deque<Question>& asked, const ServiceHeader& header) const;
  /// Takes a state over; a goal that has ended stays so.
  void enter(NavigationState state);
  void report(const NavigationReport& news);
  void ask_for_result();
  ServiceHeader next_header();

  const Server server_;
  WaitThread& thread_;
  const std::shared_ptr<const Clock> clock_;
  ServiceEnd<decltype(kSendGoalRequest), decltype(kSendGoalReply)> send_goal_{kSendGoalRequest, kSendGoalReply};
  ServiceEnd<decltype(kGetResultRequest), decltype(kGetResultReply)> get_result_{kGetResultRequest, kGetResultReply};
  ServiceEnd<decltype(kCancelGoalRequest), decltype(kCancelGoalReply)> cancel_{kCancelGoalRequest, kCancelGoalReply};
  DdsEntity status_topic_, feedback_topic_, status_, feedback_;
  std::uint64_t client_ = 0;

  std::mutex mutex_;
  std::int64_t questions_ = 0;
  std::deque<Question> asked_goals_, asked_results_;
  std::optional<Active> active_;
  std::vector<NavigationReport> reports_;
};

}  // namespace smokemap
