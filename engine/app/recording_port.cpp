#include "app/recording_port.hpp"

#include <nlohmann/json.hpp>

#include "server/wire/commands_json.hpp"

namespace smokemap::app {

using nlohmann::json;

Result<Ok> RecordingPort::apply(const Command& command, Origin origin) {
  auto done = engine_.apply(command, origin);
  if (origin != Origin::kLive) return done;
  json event{{"command", server::command_name(command)}, {"data", server::command_data(command)}};
  event["outcome"] = done ? "done" : done.error().message;
  scribe_->note(server::to_text(event));
  return done;
}

void RecordingPort::on_snapshot(Listener listener) {
  if (!listener) return engine_.on_snapshot({});
  engine_.on_snapshot([scribe = scribe_, listener = std::move(listener)](std::shared_ptr<const Snapshot> snapshot) {
    scribe->note_goals(*snapshot);
    listener(scribe->with_trouble(std::move(snapshot)));
  });
}

void RecordingPort::Scribe::close() {
  const std::lock_guard lock(mutex_);
  recorder_ = nullptr;
}

void RecordingPort::Scribe::note(const std::string& event) {
  const std::lock_guard lock(mutex_);
  if (recorder_) recorder_->add_event(event, clock_->now());
}

void RecordingPort::Scribe::note_goals(const Snapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  if (!recorder_) return;
  for (const GoalView& view : snapshot.goals) {
    const Goal& goal = view.goal;
    const auto [known, is_new] = goals_.try_emplace(goal.id, goal.state);
    if (is_new && view.in_map.p)
      recorder_->add_goal(goal.robot, Pose2(view.in_map.p->x(), view.in_map.p->y(), goal.heading_rad.value_or(0)),
                          clock_->now());
    if (!is_new && known->second == goal.state) continue;
    known->second = goal.state;
    const json event{
        {"goal", goal.id}, {"robot", goal.robot}, {"state", to_string(goal.state)}, {"reason", goal.reason}};
    recorder_->add_event(server::to_text(event), clock_->now());
  }
}

std::shared_ptr<const Snapshot> RecordingPort::Scribe::with_trouble(std::shared_ptr<const Snapshot> snapshot) {
  const std::lock_guard lock(mutex_);
  if (!recorder_ || !recorder_->counts().ended_early) return snapshot;
  auto told = std::make_shared<Snapshot>(*snapshot);
  told->alerts.push_back({"recording", "The recording has ended: the disk takes no more.", true});
  return told;
}

}  // namespace smokemap::app
