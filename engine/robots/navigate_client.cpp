#include "robots/navigate_client.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/expect.hpp"
#include "robots/ros_convert.hpp"

namespace smokemap {
namespace {

constexpr double kAnswerWithinS = 2.0;
constexpr std::size_t kMostQuestions = 16;  ///< whose replies are awaited; servers that never reply cost no memory

bool same_goal(const unique_identifier_msgs_msg_dds__UUID_& sent, const std::array<std::uint8_t, 16>& id) {
  return std::memcmp(sent.bytes, id.data(), id.size()) == 0;
}

unique_identifier_msgs_msg_dds__UUID_ wire_id(const std::array<std::uint8_t, 16>& id) {
  unique_identifier_msgs_msg_dds__UUID_ sent;
  std::memcpy(sent.bytes, id.data(), id.size());
  return sent;
}

std::optional<NavigationState> state_of(std::int8_t status) {
  switch (static_cast<RosGoalStatus>(status)) {
    case RosGoalStatus::kUnknown:
      return std::nullopt;
    case RosGoalStatus::kAccepted:
      return NavigationState::kAccepted;
    case RosGoalStatus::kExecuting:
      return NavigationState::kDriving;
    case RosGoalStatus::kCancelling:
      return NavigationState::kCancelling;
    case RosGoalStatus::kSucceeded:
      return NavigationState::kArrived;
    case RosGoalStatus::kCancelled:
      return NavigationState::kCancelled;
    case RosGoalStatus::kAborted:
      return NavigationState::kFailed;
  }
  return std::nullopt;  // a number that the message does not define
}

}  // namespace

const char* to_string(NavigationState state) {
  switch (state) {
    case NavigationState::kSent:
      return "sent";
    case NavigationState::kAccepted:
      return "accepted";
    case NavigationState::kDriving:
      return "driving";
    case NavigationState::kCancelling:
      return "cancelling";
    case NavigationState::kArrived:
      return "arrived";
    case NavigationState::kCancelled:
      return "cancelled";
    case NavigationState::kFailed:
      return "failed";
    case NavigationState::kRefused:
      return "refused";
    case NavigationState::kNoAnswer:
      return "no answer";
  }
  broken_promise("a known NavigationState", __FILE__, __LINE__);
}

bool is_final(NavigationState state) { return state >= NavigationState::kArrived; }

NavigateClient::NavigateClient(Server server, WaitThread& thread, std::shared_ptr<const Clock> clock)
    : server_(std::move(server)), thread_(thread), clock_(std::move(clock)) {}

NavigateClient::~NavigateClient() {
  for (const dds_entity_t reader : {send_goal_.reader(), get_result_.reader(), status_.get(), feedback_.get()})
    thread_.forget(reader);
}

Result<std::unique_ptr<NavigateClient>> NavigateClient::open(Server server, dds_entity_t participant,
                                                             WaitThread& thread, std::shared_ptr<const Clock> clock) {
  std::unique_ptr<NavigateClient> client(new NavigateClient(std::move(server), thread, std::move(clock)));
  if (!client->open_ends(participant))
    return fail(Errc::kIo, "the action " + client->server_.action + " does not open");
  return client;
}

bool NavigateClient::open_ends(dds_entity_t participant) {
  const std::string base = server_.action + "/_action/";
  if (!send_goal_.open(participant, base + "send_goal", false, server_.headed) ||
      !get_result_.open(participant, base + "get_result", false, server_.headed) ||
      !cancel_.open(participant, base + "cancel_goal", false, server_.headed))
    return false;
  const auto listen = [&](DdsEntity& topic, DdsEntity& reader, const char* name, const dds_topic_descriptor_t* type,
                          const DdsQos& qos) {
    topic = DdsEntity(dds_create_topic(participant, type, ("rt/" + base + name).c_str(), nullptr, nullptr));
    if (topic) reader = DdsEntity(dds_create_reader(participant, topic.get(), qos.get(), nullptr));
    return static_cast<bool>(reader);
  };
  if (!listen(status_topic_, status_, "status", &action_msgs_msg_dds__GoalStatusArray__desc, latched_qos(1)) ||
      !listen(feedback_topic_, feedback_, "feedback", &nav2_msgs_action_dds__NavigateToPose_FeedbackMessage__desc,
              state_qos(10)))
    return false;
  dds_instance_handle_t own = 0;
  (void)dds_get_instance_handle(send_goal_.reader(), &own);
  client_ = own;
  thread_.on_data(send_goal_.reader(), [this] { on_accepted_or_not(); });
  thread_.on_data(get_result_.reader(), [this] { on_result(); });
  thread_.on_data(status_.get(), [this] { on_status(); });
  thread_.on_data(feedback_.get(), [this] { on_feedback(); });
  return true;
}

void NavigateClient::report(const NavigationReport& news) {
  // Of a stream of feedback only the newest is kept: whoever fetches late has no more to read.
  if (!reports_.empty() && reports_.back().goal == news.goal && reports_.back().state == news.state)
    reports_.back() = news;
  else
    reports_.push_back(news);
}

std::vector<NavigationReport> NavigateClient::take_reports() {
  const std::lock_guard lock(mutex_);
  return std::exchange(reports_, {});
}

void NavigateClient::enter(NavigationState state) {
  if (!active_ || is_final(active_->report.state) || active_->report.state == state) return;
  active_->report.state = state;
  report(active_->report);
}

void NavigateClient::abandon() {
  const std::lock_guard lock(mutex_);
  enter(NavigationState::kNoAnswer);
}

ServiceHeader NavigateClient::next_header() { return {client_, ++questions_}; }

Result<Ok> NavigateClient::send(std::uint64_t number, const Goal& goal) {
  const std::lock_guard lock(mutex_);
  Active next;
  next.number = number;
  std::memcpy(next.id.data(), &client_, sizeof client_);
  std::memcpy(next.id.data() + sizeof client_, &number, sizeof number);
  next.goal = goal;
  next.sent_at = clock_->now();
  next.report.robot = server_.robot;
  next.report.goal = number;
  const ServiceHeader header = next_header();
  SendGoalRequest request{};
  request.goal_id = wire_id(next.id);
  request.pose = ros_pose(goal.T_frame_goal, goal.frame, next.sent_at);
  request.behavior_tree = const_cast<char*>("");
  if (!send_goal_.write(header, request))
    return fail(Errc::kIo, "the network did not take the goal for " + server_.robot);
  enter(NavigationState::kCancelled);  // the robot gives the one before up for the new one
  asked_goals_.push_back({header.number, number});
  if (asked_goals_.size() > kMostQuestions) asked_goals_.pop_front();
  report(next.report);
  active_ = std::move(next);
  return Ok{};
}

Result<Ok> NavigateClient::cancel_all() {
  const std::lock_guard lock(mutex_);
  const CancelGoalRequest everything{};  // no goal and no time: all of them
  if (cancel_.write(next_header(), everything)) return Ok{};
  return fail(Errc::kIo, "the network did not take the cancellation for " + server_.robot);
}

std::optional<NavigateClient::Question> NavigateClient::answered_question(std::deque<Question>& asked,
                                                                          const ServiceHeader& header) const {
  if (server_.headed && header.client != client_) return std::nullopt;
  const auto found = server_.headed ? std::find_if(asked.begin(), asked.end(),
                                                   [&](const Question& q) { return q.number == header.number; })
                                    : asked.begin();
  if (found == asked.end()) return std::nullopt;
  const Question question = *found;
  asked.erase(found);
  return question;
}

void NavigateClient::on_accepted_or_not() {
  const std::lock_guard lock(mutex_);
  send_goal_.take([&](const ServiceHeader& header, const SendGoalReply& reply) {
    const auto question = answered_question(asked_goals_, header);
    if (!question || !active_ || question->goal != active_->number) return;
    if (!reply.accepted && server_.headed) return enter(NavigationState::kRefused);
    active_->refused = !reply.accepted;
    active_->answered = active_->answered || (reply.accepted && server_.headed);
    if (!reply.accepted) return;
    if (active_->report.state == NavigationState::kSent && server_.headed) enter(NavigationState::kAccepted);
    ask_for_result();
  });
}

void NavigateClient::ask_for_result() {
  const ServiceHeader header = next_header();
  (void)get_result_.write(header, {wire_id(active_->id)});
  asked_results_.push_back({header.number, active_->number});
  if (asked_results_.size() > kMostQuestions) asked_results_.pop_front();
}

void NavigateClient::on_result() {
  const std::lock_guard lock(mutex_);
  get_result_.take([&](const ServiceHeader& header, const GetResultReply& reply) {
    const auto question = answered_question(asked_results_, header);
    if (!question || !active_ || question->goal != active_->number || !server_.headed) return;
    if (const auto state = state_of(reply.status); state && is_final(*state)) enter(*state);
  });
}

void NavigateClient::on_status() {
  const std::lock_guard lock(mutex_);
  take_all<GoalStatusesMsg>(status_.get(), [&](const GoalStatusesMsg& message, const dds_sample_info_t&) {
    for (std::uint32_t i = 0; i < message.status_list._length; ++i) {
      const auto& entry = message.status_list._buffer[i];
      if (!active_ || !same_goal(entry.goal_info.goal_id, active_->id)) continue;
      active_->answered = true;
      if (const auto state = state_of(entry.status)) enter(*state);
    }
  });
}

void NavigateClient::on_feedback() {
  const std::lock_guard lock(mutex_);
  take_all<NavigationFeedbackMsg>(feedback_.get(), [&](const NavigationFeedbackMsg& message, const dds_sample_info_t&) {
    if (!active_ || !same_goal(message.goal_id, active_->id) || is_final(active_->report.state)) return;
    active_->answered = true;
    NavigationReport& news = active_->report;
    news.remaining_m = std::isfinite(message.distance_remaining) ? std::max(0.f, message.distance_remaining) : 0;
    news.eta_s = std::max(0.0, to_seconds(to_stamp(message.estimated_time_remaining)));
    news.recoveries = message.number_of_recoveries;
    if (news.state != NavigationState::kCancelling) news.state = NavigationState::kDriving;
    report(news);
  });
}

std::optional<NavigateClient::Goal> NavigateClient::tick(Stamp now) {
  const std::lock_guard lock(mutex_);
  if (!active_ || active_->answered || is_final(active_->report.state)) return std::nullopt;
  if (to_seconds(now - active_->sent_at) < kAnswerWithinS) return std::nullopt;
  const bool refused = active_->refused;
  enter(refused ? NavigationState::kRefused : NavigationState::kNoAnswer);
  return refused ? std::nullopt : std::optional(active_->goal);
}

}  // namespace smokemap
