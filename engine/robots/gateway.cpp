#include "robots/gateway.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "core/check.hpp"
#include "robots/dds_domain.hpp"
#include "robots/robot_commander.hpp"
#include "robots/robot_intake.hpp"
#include "robots/ros_convert.hpp"
#include "robots/ros_names.hpp"
#include "robots/ros_qos.hpp"
#include "robots/topic_sources.hpp"
#include "robots/topic_table.hpp"
#include "robots/wait_thread.hpp"

namespace smokemap {
namespace {

constexpr double kTickSeconds = 0.1;
constexpr int kTransformDepth = 100;

DdsGuid guid_of(const dds_guid_t& guid) {
  DdsGuid id;
  std::copy(std::begin(guid.v), std::end(guid.v), id.begin());
  return id;
}

}  // namespace

Result<Ok> GatewayParams::validate() const {
  return ParamCheck("GatewayParams")
      .in_range("domain", domain, 0, 230)
      .positive("link.stale_after_s", link.stale_after_s)
      .in_range("link.lost_after_s", link.lost_after_s, link.stale_after_s, 3600)
      .in_range("mount_wait_s", mount_wait_s, 0, 60)
      .result();
}

class RobotGateway::Impl {
 public:
  Impl(GatewayParams params, Callbacks callbacks, std::shared_ptr<const Clock> clock, std::shared_ptr<DdsDomain> domain,
       DdsEntity participant)
      : params_(std::move(params)),
        callbacks_(std::move(callbacks)),
        clock_(std::move(clock)),
        domain_(std::move(domain)),
        participant_(std::move(participant)),
        thread_(participant_.get(), kTickSeconds, [this] { tick(); }) {
    dds_guid_t own{};
    (void)dds_get_guid(participant_.get(), &own);
    own_participant_ = guid_of(own);
    watch_discovery(publications_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, true);
    watch_discovery(subscriptions_, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, false);
    thread_.start();
  }
  ~Impl() {
    thread_.stop();
    shown_.clear();  // navigators take their leave of the thread, which goes first of all members
  }

  std::vector<RobotLink> robots() const {
    const std::lock_guard lock(mutex_);
    std::vector<RobotLink> links;
    for (const auto& [id, shown] : shown_) {
      links.push_back(shown.link);
      links.back().link = link_state(shown.link.last_heard, clock_->now(), params_.link);
      links.back().takes_velocity = shown.commander.takes_velocity();
      links.back().takes_goals = shown.commander.takes_goals();
      links.back().navigates = shown.commander.navigates();
    }
    return links;
  }

  std::vector<GatewayAlarm> alarms() const {
    const std::lock_guard lock(mutex_);
    std::vector<GatewayAlarm> alarms;
    for (const auto& [id, alarm] : alarms_) alarms.push_back(alarm);
    return alarms;
  }

  Result<Ok> drive(const std::string& robot, double speed_mps, double turn_rate_radps) {
    if (!std::isfinite(speed_mps) || !std::isfinite(turn_rate_radps))
      return fail(Errc::kInvalidArgument, "a velocity that is not finite");
    const std::lock_guard lock(mutex_);
    const auto shown = shown_.find(robot);
    if (shown == shown_.end()) return fail(Errc::kNotFound, "there is no robot " + robot);
    return shown->second.commander.drive(speed_mps, turn_rate_radps, clock_->now());
  }

  Result<SentGoal> send_goal(const std::string& robot, const Pose2& T_frame_goal, const std::string& frame) {
    if (!T_frame_goal.is_finite()) return fail(Errc::kInvalidArgument, "a goal that is not finite");
    const std::lock_guard lock(mutex_);
    const auto shown = shown_.find(robot);
    if (shown == shown_.end()) return fail(Errc::kNotFound, "there is no robot " + robot);
    const std::uint64_t number = ++goals_;
    const auto followed = shown->second.commander.send_goal(number, {T_frame_goal, frame}, clock_->now());
    if (!followed) return followed.error();
    return SentGoal{number, *followed};
  }

  Result<SentGoal> send_goal_ahead(const std::string& robot, const Pose2& T_robot_goal) {
    Pose2 T_odom_goal;
    std::string frame;
    {
      const std::lock_guard lock(mutex_);
      const auto shown = shown_.find(robot);
      if (shown == shown_.end() || shown->second.link.odom_frame.empty())
        return fail(Errc::kNotFound, robot + " has not said where it is by its odometry");
      T_odom_goal = shown->second.link.T_odom_robot * T_robot_goal;
      frame = shown->second.link.odom_frame;
    }
    return send_goal(robot, T_odom_goal, frame);
  }

  Result<Ok> stop(const std::string& robot) {
    const std::lock_guard lock(mutex_);
    const auto shown = shown_.find(robot);
    if (shown == shown_.end()) return fail(Errc::kNotFound, "there is no robot " + robot);
    const auto called_off = shown->second.commander.cancel_goals();
    const auto standing = shown->second.commander.drive(0, 0, clock_->now());
    if (!called_off) return called_off;
    return shown->second.commander.navigates() ? Result<Ok>(Ok{}) : standing;
  }

 private:
  /// A typed reader of one topic; deleted as a whole.
  struct TopicReader {
    DdsEntity topic;
    DdsEntity reader;
  };

  /// Touched by the gateway's thread only.
  struct Robot {
    Robot(const std::string& id, Impl& gateway)
        : intake(id, gateway.params_, gateway.callbacks_,
                 [&gateway, id](const std::string& what, const std::string& text) { gateway.raise(id, what, text); }),
          sources(gateway.params_.link.stale_after_s) {}
    RobotIntake intake;
    RobotTopics told;                            ///< by discovery
    RobotTopics topics;                          ///< as used
    std::map<std::string, TopicReader> readers;  ///< by topic name
    TopicSources sources;
    std::map<dds_instance_handle_t, DdsGuid> writer_participants;
  };
  /// What other threads may see and use, under the mutex.
  struct Shown {
    RobotLink link;
    RobotCommander commander;
  };

  // Discovery ------------------------------------------------------------------------------------------------------

  void watch_discovery(DdsEntity& reader, dds_entity_t topic, bool writers) {
    reader = DdsEntity(dds_create_reader(participant_.get(), topic, nullptr, nullptr));
    thread_.on_data(reader.get(), [this, handle = reader.get(), writers] { discovered(handle, writers); });
  }

  void discovered(dds_entity_t reader, bool writers) {
    take_all<dds_builtintopic_endpoint_t>(
        reader,
        [&](const dds_builtintopic_endpoint_t& told, const dds_sample_info_t& info) {
          const DdsGuid id = guid_of(told.key);
          if (info.instance_state != DDS_ALIVE_INSTANCE_STATE) return table_.remove(id);
          if (!info.valid_data || guid_of(told.participant_key) == own_participant_) return;
          Endpoint endpoint{text_of(told.topic_name), text_of(told.type_name), offered(told.qos),
                            guid_of(told.participant_key)};
          writers ? table_.add_writer(id, std::move(endpoint)) : table_.add_reader(id, std::move(endpoint));
        },
        true);
    std::map<std::string, RobotTopics> present;
    for (const auto& [id, robot] : robots_) present[id].robot = id;  // also who has gone: nobody takes its commands
    for (RobotTopics& topics : table_.robots()) present[topics.robot] = std::move(topics);
    for (const auto& [id, topics] : present) adopt(topics);
  }

  /// Opens what a robot newly offers, closes what it no longer does. Readers of a robot that is gone stay for its
  /// return.
  void adopt(const RobotTopics& topics) {
    auto& robot = robots_[topics.robot];
    if (!robot) robot = std::make_unique<Robot>(topics.robot, *this);
    if (robot->told == topics) return;
    robot->told = topics;
    robot->topics = topics;
    if (params_.services != ServiceFormat::kByVendor)
      robot->topics.headed_services = params_.services == ServiceFormat::kHeaded;
    if (!topics.scan.empty()) {
      close_unused(*robot);
      open_readers(*robot);
    }
    const std::lock_guard lock(mutex_);
    Shown& shown = shown_[topics.robot];
    shown.link.id = topics.robot;
    shown.commander.adopt(robot->topics, participant_.get(), thread_, clock_);
  }

  void close_unused(Robot& robot) {
    const RobotTopics& t = robot.topics;
    std::set<std::string> used(t.fixed_transforms.begin(), t.fixed_transforms.end());
    used.insert({t.scan, t.odometry, t.radar});
    if (t.odometry.empty()) used.insert(t.moving_transforms);
    for (auto& [topic, opened] : robot.readers)
      if (!used.contains(topic)) thread_.forget(opened.reader.get());
    std::erase_if(robot.readers, [&](const auto& opened) { return !used.contains(opened.first); });
  }

  void open_readers(Robot& robot) {
    const RobotTopics& t = robot.topics;
    const auto transforms_qos = [&](const std::string& topic) {
      return reader_qos_for(table_.offer(topic), kTransformDepth);
    };
    read<RosScanMsg>(robot, t.scan, &sensor_msgs_msg_dds__LaserScan__desc, sensor_qos(), &Impl::on_scan);
    read<RosOdometryMsg>(robot, t.odometry, &nav_msgs_msg_dds__Odometry__desc, sensor_qos(), &Impl::on_odometry);
    read<RosImageMsg>(robot, t.radar, &sensor_msgs_msg_dds__Image__desc, reader_qos_for(table_.offer(t.radar), 2),
                      &Impl::on_radar);
    for (const std::string& topic : t.fixed_transforms)
      read<RosTransformsMsg>(robot, topic, &tf2_msgs_msg_dds__TFMessage__desc, transforms_qos(topic), &Impl::on_fixed);
    if (t.odometry.empty())
      read<RosTransformsMsg>(robot, t.moving_transforms, &tf2_msgs_msg_dds__TFMessage__desc,
                             transforms_qos(t.moving_transforms), &Impl::on_moving);
  }

  template <typename Message>
  using Receive = void (Impl::*)(Robot&, const std::string& topic, const Message&);

  template <typename Message>
  void read(Robot& robot, const std::string& topic, const dds_topic_descriptor_t* type, DdsQos qos,
            Receive<Message> receive) {
    if (topic.empty() || robot.readers.contains(topic)) return;
    TopicReader opened;
    opened.topic = DdsEntity(dds_create_topic(participant_.get(), type, topic.c_str(), nullptr, nullptr));
    if (opened.topic)
      opened.reader = DdsEntity(dds_create_reader(participant_.get(), opened.topic.get(), qos.get(), nullptr));
    if (!opened.reader)
      return raise(robot.topics.robot, "read:" + topic, "cannot listen to " + topic + ": " + opened.topic.why());
    const dds_entity_t reader = opened.reader.get();
    thread_.on_data(reader, [this, &robot, topic, reader, receive] {
      take_all<Message>(reader, [&](const Message& message, const dds_sample_info_t& info) {
        if (is_bound(robot, topic, reader, info.publication_handle)) (this->*receive)(robot, topic, message);
      });
      show(robot);
    });
    thread_.on_status(reader, DDS_REQUESTED_INCOMPATIBLE_QOS_STATUS, [this, &robot, topic, reader] {
      dds_requested_incompatible_qos_status_t status{};
      (void)dds_get_requested_incompatible_qos_status(reader, &status);
      if (status.total_count_change > 0)
        raise(robot.topics.robot, "qos:" + topic,
              topic.substr(3) + " is published with a " + policy_name(status.last_policy_id) + " that we cannot read");
    });
    robot.readers.emplace(topic, std::move(opened));
  }

  /// Of two sources on one topic one is listened to (topic_sources.hpp).
  bool is_bound(Robot& robot, const std::string& topic, dds_entity_t reader, dds_instance_handle_t writer) {
    if (std::find(robot.topics.fixed_transforms.begin(), robot.topics.fixed_transforms.end(), topic) !=
        robot.topics.fixed_transforms.end())
      return true;  // many nodes rightly publish fixed transforms
    if (topic == robot.topics.moving_transforms) return true;
    auto known = robot.writer_participants.find(writer);
    if (known == robot.writer_participants.end()) {
      DdsGuid participant{};
      if (auto* told = dds_get_matched_publication_data(reader, writer)) {
        participant = guid_of(told->participant_key);
        dds_builtintopic_free_endpoint(told);
      }
      known = robot.writer_participants.emplace(writer, participant).first;
    }
    if (robot.sources.hears(topic, known->second, clock_->now(), table_)) return true;
    robot.intake.drop("second source of " + topic.substr(3));
    raise(robot.topics.robot, "sources:" + topic,
          "two sources publish " + topic.substr(3) + ": the second is left out (two robots with the same name?)");
    return false;
  }

  // Data -----------------------------------------------------------------------------------------------------------

  void on_scan(Robot& robot, const std::string&, const RosScanMsg& message) {
    robot.intake.scan(to_scan(message), text_of(message.header.frame_id), clock_->now());
  }

  void on_odometry(Robot& robot, const std::string&, const RosOdometryMsg& message) {
    auto odometry = to_odometry(message);
    if (!odometry) return robot.intake.drop(odometry.error().message);
    robot.intake.odometry(std::move(*odometry), text_of(message.header.frame_id), text_of(message.child_frame_id),
                          clock_->now());
  }

  void on_radar(Robot& robot, const std::string&, const RosImageMsg& message) {
    auto sweep = to_sweep(message);
    if (!sweep) return robot.intake.drop(sweep.error().message);
    robot.intake.sweep(std::move(*sweep), text_of(message.header.frame_id), clock_->now());
  }

  void on_moving(Robot& robot, const std::string&, const RosTransformsMsg& message) {
    for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
      const RosTransformMsg& transform = message.transforms._buffer[i];
      if (!text_of(transform.header.frame_id).ends_with("odom")) continue;
      auto odometry = to_odometry(transform);
      if (!odometry)
        robot.intake.drop(odometry.error().message);
      else
        robot.intake.odometry(std::move(*odometry), text_of(transform.header.frame_id),
                              text_of(transform.child_frame_id), clock_->now());
    }
  }

  void on_fixed(Robot& robot, const std::string& topic, const RosTransformsMsg& message) {
    const bool is_shared = topic == dds_topic(kLoneRobot, "tf_static");
    const int refused = add_transforms(message, is_shared ? shared_frames_ : robot.intake.own_frames());
    for (int i = 0; i < refused; ++i) robot.intake.drop("fixed transform that is not sound");
    robot.intake.frames_changed(shared_frames_, clock_->now());
  }

  void tick() {
    for (auto& [id, robot] : robots_) {
      robot->intake.tick(clock_->now());
      show(*robot);
    }
    for (auto& [id, shown] : shown_)
      for (const NavigationReport& report :
           shown.commander.tick(clock_->now()))  // only this thread changes what it holds
        if (callbacks_.on_navigation) callbacks_.on_navigation(report);
  }

  void show(const Robot& robot) {
    const RobotLink link = robot.intake.link();
    const std::lock_guard lock(mutex_);
    shown_[link.id].link = link;
  }

  void raise(const std::string& robot, const std::string& what, const std::string& text) {
    const GatewayAlarm alarm{robot, robot + "/" + what, text};
    {
      const std::lock_guard lock(mutex_);
      if (!alarms_.emplace(alarm.id, alarm).second) return;
    }
    if (callbacks_.on_alarm) callbacks_.on_alarm(alarm);
  }

  const GatewayParams params_;
  const Callbacks callbacks_;
  const std::shared_ptr<const Clock> clock_;
  const std::shared_ptr<DdsDomain> domain_;
  const DdsEntity participant_;
  DdsGuid own_participant_{};
  DdsEntity publications_, subscriptions_;
  TopicTable table_;  // the gateway's thread only, as the next two
  FrameTree shared_frames_;
  std::map<std::string, std::unique_ptr<Robot>> robots_;
  mutable std::mutex mutex_;  // never held while a callback runs
  std::map<std::string, Shown> shown_;
  std::map<std::string, GatewayAlarm> alarms_;
  std::uint64_t goals_ = 0;
  WaitThread thread_;
};

Result<std::unique_ptr<RobotGateway>> RobotGateway::open(const GatewayParams& params, Callbacks callbacks,
                                                         std::shared_ptr<const Clock> clock) {
  if (auto sound = params.validate(); !sound) return sound.error();
  auto domain = DdsDomain::open(params.domain);
  if (!domain) return domain.error();
  auto participant = (*domain)->participant();
  if (!participant) return participant.error();
  return std::unique_ptr<RobotGateway>(new RobotGateway(std::make_unique<Impl>(
      params, std::move(callbacks), std::move(clock), std::move(*domain), std::move(*participant))));
}

RobotGateway::RobotGateway(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RobotGateway::~RobotGateway() = default;
std::vector<RobotLink> RobotGateway::robots() const { return impl_->robots(); }
std::vector<GatewayAlarm> RobotGateway::alarms() const { return impl_->alarms(); }
Result<Ok> RobotGateway::drive(const std::string& robot, double speed_mps, double turn_rate_radps) {
  return impl_->drive(robot, speed_mps, turn_rate_radps);
}
Result<SentGoal> RobotGateway::send_goal(const std::string& robot, const Pose2& T_frame_goal,
                                         const std::string& frame_id) {
  return impl_->send_goal(robot, T_frame_goal, frame_id);
}
Result<SentGoal> RobotGateway::send_goal_ahead(const std::string& robot, const Pose2& T_robot_goal) {
  return impl_->send_goal_ahead(robot, T_robot_goal);
}
Result<Ok> RobotGateway::stop(const std::string& robot) { return impl_->stop(robot); }

}  // namespace smokemap
