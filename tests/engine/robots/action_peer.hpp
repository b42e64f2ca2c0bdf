#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robots/dds_domain.hpp"
#include "robots/ros_convert.hpp"
#include "robots/ros_service.hpp"
#include "robots/wait_thread.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/result_matchers.hpp"
#include "tests/support/ros_domain.hpp"

namespace smokemap::test {

/// A robot's navigator as Nav2 would be it, in either wire format: takes goals, says what the test tells it to.
class ActionPeer {
 public:
  using GoalId = std::array<std::uint8_t, 16>;
  struct Asked {
    GoalId id{};
    Pose2 T_frame_goal;
    std::string frame;
  };

  ActionPeer(const std::string& action, bool headed, bool accepting = true, bool replying = true)
      : domain_(*DdsDomain::open(ros_domain())),
        participant_(*domain_->participant()),
        accepting_(accepting),
        replying_(replying),
        thread_(participant_.get(), 1.0, [] {}) {
    const std::string base = action + "/_action/";
    EXPECT_TRUE(get_result_.open(participant_.get(), base + "get_result", true, headed));
    EXPECT_TRUE(cancel_.open(participant_.get(), base + "cancel_goal", true, headed));
    status_topic_ = topic("rt/" + base + "status", &action_msgs_msg_dds__GoalStatusArray__desc);
    feedback_topic_ = topic("rt/" + base + "feedback", &nav2_msgs_action_dds__NavigateToPose_FeedbackMessage__desc);
    status_ = DdsEntity(dds_create_writer(participant_.get(), status_topic_.get(), latched_qos(1).get(), nullptr));
    feedback_ = DdsEntity(dds_create_writer(participant_.get(), feedback_topic_.get(), state_qos(10).get(), nullptr));
    // Last: by this one the action is found.
    EXPECT_TRUE(send_goal_.open(participant_.get(), base + "send_goal", true, headed));
    thread_.on_data(send_goal_.reader(), [this] { on_goal(); });
    thread_.on_data(get_result_.reader(), [this] { on_result_wanted(); });
    thread_.on_data(cancel_.reader(), [this] { on_cancel(); });
    thread_.start();
  }
  ~ActionPeer() { thread_.stop(); }
  ActionPeer(const ActionPeer&) = delete;
  ActionPeer& operator=(const ActionPeer&) = delete;

  void say_status(const GoalId& id, RosGoalStatus status) const {
    action_msgs_msg_dds__GoalStatus_ entry{};
    entry.goal_info.goal_id = wire(id);
    entry.status = static_cast<std::int8_t>(status);
    GoalStatusesMsg message{{1, 1, &entry, false}};
    EXPECT_EQ(dds_write(status_.get(), &message), DDS_RETCODE_OK);
  }
  void say_feedback(const GoalId& id, double remaining_m, double eta_s) const {
    NavigationFeedbackMsg message{};
    const std::string frame = "map";
    message.goal_id = wire(id);
    message.current_pose = ros_pose(Pose2(), frame, 1);
    message.estimated_time_remaining = to_ros_time(from_seconds(eta_s));
    message.number_of_recoveries = 2;
    message.distance_remaining = static_cast<float>(remaining_m);
    EXPECT_EQ(dds_write(feedback_.get(), &message), DDS_RETCODE_OK);
  }
  /// The result of the goal whose result was asked for last.
  void give_result(RosGoalStatus status) const {
    const auto asked = results.all();
    ASSERT_FALSE(asked.empty());
    EXPECT_TRUE(get_result_.write(asked.back(), {static_cast<std::int8_t>(status), 0}));
  }
  /// A reply to nobody's question, as another client of the same server would get it.
  void answer_somebody_else(bool accepted) const { EXPECT_TRUE(send_goal_.write({4711, 1}, {accepted, {0, 0}})); }

  Mailbox<Asked> goals;
  Mailbox<GoalId> cancels;
  Mailbox<ServiceHeader> results;

 private:
  static unique_identifier_msgs_msg_dds__UUID_ wire(const GoalId& id) {
    unique_identifier_msgs_msg_dds__UUID_ sent;
    std::memcpy(sent.bytes, id.data(), id.size());
    return sent;
  }
  static GoalId id_of(const unique_identifier_msgs_msg_dds__UUID_& sent) {
    GoalId id;
    std::memcpy(id.data(), sent.bytes, id.size());
    return id;
  }
  DdsEntity topic(const std::string& name, const dds_topic_descriptor_t* type) const {
    return DdsEntity(dds_create_topic(participant_.get(), type, name.c_str(), nullptr, nullptr));
  }
  void on_goal() {
    send_goal_.take([this](const ServiceHeader& header, const SendGoalRequest& request) {
      if (replying_) {
        EXPECT_TRUE(send_goal_.write(header, {accepting_, {0, 0}}));
      }
      const auto pose = to_pose(request.pose);
      goals.put({id_of(request.goal_id), pose ? *pose : Pose2(), text_of(request.pose.header.frame_id)});
    });
  }
  void on_result_wanted() {
    get_result_.take([this](const ServiceHeader& header, const GetResultRequest&) { results.put(header); });
  }
  void on_cancel() {
    cancel_.take([this](const ServiceHeader& header, const CancelGoalRequest& request) {
      cancels.put(id_of(request.goal_info.goal_id));
      EXPECT_TRUE(cancel_.write(header, {0, {0, 0, nullptr, false}}));
    });
  }

  std::shared_ptr<DdsDomain> domain_;
  DdsEntity participant_;
  bool accepting_, replying_;
  ServiceEnd<decltype(kSendGoalReply), decltype(kSendGoalRequest)> send_goal_{kSendGoalReply, kSendGoalRequest};
  ServiceEnd<decltype(kGetResultReply), decltype(kGetResultRequest)> get_result_{kGetResultReply, kGetResultRequest};
  ServiceEnd<decltype(kCancelGoalReply), decltype(kCancelGoalRequest)> cancel_{kCancelGoalReply, kCancelGoalRequest};
  DdsEntity status_topic_, feedback_topic_, status_, feedback_;
  WaitThread thread_;
};

}  // namespace smokemap::test
