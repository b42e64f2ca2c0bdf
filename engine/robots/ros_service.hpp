#pragma once

#include <dds/dds.h>

#include <string>

#include "robots/dds_entity.hpp"
#include "robots/ros_qos.hpp"
#include "ros2.h"

namespace smokemap {

using ServiceHeader = headed_Header;

/// How one message of a service looks on the wire: alone, or behind a header, under the same type name.
template <typename Body, typename HeadedBody>
struct ServiceMessage {
  using Plain = Body;
  using Headed = HeadedBody;
  const dds_topic_descriptor_t* plain;
  const dds_topic_descriptor_t* headed;
};

/// One end of a ROS 2 service: writes `Out`, reads `In`. Clients and servers differ in which is the request.
///
/// There is no one wire format for services. rmw_cyclonedds begins request and reply with who asked and the number of
/// the question; rmw_fastrtps puts that where Cyclone's C API cannot reach, and the message stands alone. Whoever opens
/// an end must know which of the two the other side speaks: a header sent to Fast DDS is misread as lengths.
template <typename Out, typename In>
class ServiceEnd {
 public:
  ServiceEnd(Out out, In in) : out_(out), in_(in) {}

  /// @param service "fox/navigate_to_pose/_action/send_goal"
  bool open(dds_entity_t participant, const std::string& service, bool is_server, bool headed) {
    headed_ = headed;
    const std::string request = "rq/" + service + "Request", reply = "rr/" + service + "Reply";
    out_topic_ = topic(participant, out_, is_server ? reply : request);
    in_topic_ = topic(participant, in_, is_server ? request : reply);
    if (!out_topic_ || !in_topic_) return false;
    writer_ = DdsEntity(dds_create_writer(participant, out_topic_.get(), state_qos(10).get(), nullptr));
    reader_ = DdsEntity(dds_create_reader(participant, in_topic_.get(), state_qos(10).get(), nullptr));
    return writer_ && reader_;
  }

  bool write(const ServiceHeader& header, const typename Out::Plain& body) const {
    const typename Out::Headed whole{header, body};
    return dds_write(writer_.get(), headed_ ? static_cast<const void*>(&whole) : &body) == DDS_RETCODE_OK;
  }

  /// Calls `use(const ServiceHeader&, const In::Plain&)` for what has come; without headers a zero one.
  template <typename Use>
  void take(Use&& use) const {
    if (headed_)
      take_all<typename In::Headed>(reader_.get(), [&](const auto& m, const auto&) { use(m.header, m.body); });
    else
      take_all<typename In::Plain>(reader_.get(), [&](const auto& m, const auto&) { use(ServiceHeader{0, 0}, m); });
  }

  dds_entity_t reader() const { return reader_.get(); }
  bool is_headed() const { return headed_; }

 private:
  template <typename Type>
  DdsEntity topic(dds_entity_t participant, const Type& type, const std::string& name) const {
    dds_topic_descriptor_t described = headed_ ? *type.headed : *type.plain;
    described.m_typename = type.plain->m_typename;
    return DdsEntity(dds_create_topic(participant, &described, name.c_str(), nullptr, nullptr));
  }

  Out out_;
  In in_;
  bool headed_ = false;
  DdsEntity out_topic_, in_topic_;
  DdsEntity writer_, reader_;
};

// The services of NavigateToPose.
using SendGoalRequest = nav2_msgs_action_dds__NavigateToPose_SendGoal_Request_;
using SendGoalReply = nav2_msgs_action_dds__NavigateToPose_SendGoal_Response_;
using GetResultRequest = nav2_msgs_action_dds__NavigateToPose_GetResult_Request_;
using GetResultReply = nav2_msgs_action_dds__NavigateToPose_GetResult_Response_;
using CancelGoalRequest = action_msgs_srv_dds__CancelGoal_Request_;
using CancelGoalReply = action_msgs_srv_dds__CancelGoal_Response_;
using NavigationFeedbackMsg = nav2_msgs_action_dds__NavigateToPose_FeedbackMessage_;
using GoalStatusesMsg = action_msgs_msg_dds__GoalStatusArray_;

inline constexpr ServiceMessage<SendGoalRequest, headed_SendGoalRequest> kSendGoalRequest{
    &nav2_msgs_action_dds__NavigateToPose_SendGoal_Request__desc, &headed_SendGoalRequest_desc};
inline constexpr ServiceMessage<SendGoalReply, headed_SendGoalReply> kSendGoalReply{
    &nav2_msgs_action_dds__NavigateToPose_SendGoal_Response__desc, &headed_SendGoalReply_desc};
inline constexpr ServiceMessage<GetResultRequest, headed_GetResultRequest> kGetResultRequest{
    &nav2_msgs_action_dds__NavigateToPose_GetResult_Request__desc, &headed_GetResultRequest_desc};
inline constexpr ServiceMessage<GetResultReply, headed_GetResultReply> kGetResultReply{
    &nav2_msgs_action_dds__NavigateToPose_GetResult_Response__desc, &headed_GetResultReply_desc};
inline constexpr ServiceMessage<CancelGoalRequest, headed_CancelGoalRequest> kCancelGoalRequest{
    &action_msgs_srv_dds__CancelGoal_Request__desc, &headed_CancelGoalRequest_desc};
inline constexpr ServiceMessage<CancelGoalReply, headed_CancelGoalReply> kCancelGoalReply{
    &action_msgs_srv_dds__CancelGoal_Response__desc, &headed_CancelGoalReply_desc};

/// GoalStatus of action_msgs.
enum class RosGoalStatus : std::int8_t {
  kUnknown = 0,
  kAccepted = 1,
  kExecuting = 2,
  kCancelling = 3,
  kSucceeded = 4,
  kCancelled = 5,
  kAborted = 6
};

}  // namespace smokemap
