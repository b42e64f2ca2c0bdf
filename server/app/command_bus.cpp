#include "server/app/command_bus.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "server/access/permission.hpp"
#include "server/wire/commands_json.hpp"

namespace smokemap::server {
namespace {

constexpr int kPage = 500;
constexpr const char* kUrgent = "emergency_stop";
constexpr JsonLimits kStoredLimits{64_MiB, 64};

CommandReply refusal(const std::string& id, const Error& error, std::optional<std::int64_t> seq = std::nullopt) {
  return {id, seq, to_string(error.code), error.message};
}

Result<Command> command_of(const Event& event) {
  const auto data = parse_json(event.data, kStoredLimits);
  if (!data) return data.error();
  return command_from_json(event.name, *data, {event.who.name, event.time_ms * 1'000'000});
}

/// Calls `visit` for every event up to `last`; stops at the first error.
template <typename Visit>
Result<Ok> for_each_event(Store& store, std::optional<std::int64_t> last, const Visit& visit) {
  for (std::int64_t from = 1;;) {
    const auto page = store.events(from, kPage);
    if (!page) return page.error();
    for (const Event& event : *page) {
      if (last && event.seq > *last) return Ok{};
      if (auto done = visit(event); !done) return done;
    }
    if (page->size() < static_cast<std::size_t>(kPage)) return Ok{};
    from = page->back().seq + 1;
  }
}

/// A place pointed at on the merged map is kept on the plan where there is one: the robot's frame ends with this run,
/// and a bottle stored in it would be shown in the wrong room after a restart.
CommandMessage kept_on_plan(const EnginePort& engine, CommandMessage message) {
  Json& data = message.data;
  if (message.name != "place_poi" && message.name != "set_goal") return message;
  if (!data.is_object() || data.value("frame", Json()) != "map") return message;
  const auto p_map = point_of(data.value("p", Json()));
  if (!p_map) return message;
  if (const auto p_px = engine.place_on_plan(*p_map)) {
    data["frame"] = "layout_px";
    data["p"] = {p_px->x(), p_px->y()};
  }
  return message;
}

/// As the log keeps it: "done", or "refused: not_found: no robot called r9".
std::string outcome_of(const Result<Ok>& applied) {
  if (applied) return "done";
  return std::string("refused: ") + to_string(applied.error().code) + ": " + applied.error().message;
}

bool is_refused(const Event& event) { return event.outcome.starts_with("refused"); }

/// What outcome_of wrote -> code and message.
CommandReply reply_of(const Event& event) {
  CommandReply reply{event.command_id, event.seq, "", ""};
  if (!is_refused(event)) return reply;
  std::string rest = event.outcome.substr(std::min<std::size_t>(event.outcome.size(), 9));
  const std::size_t colon = rest.find(": ");
  reply.code = rest.substr(0, colon);
  reply.message = colon == std::string::npos ? rest : rest.substr(colon + 2);
  return reply;
}

}  // namespace

bool ViewKeeper::note(const Command& command, const Json& data) {
  if (const auto* layout = std::get_if<SetLayout>(&command)) {
    const std::string prefix = "/api/plans/" + layout->plan_id + "/rectified";
    view_.plan_picture = prefix;
    const Json& document = data["layout"];
    if (document.contains("rectified") && document["rectified"].is_string()) {
      const std::string asked = document["rectified"].get<std::string>();
      if (asked.starts_with(prefix) && asked.size() < prefix.size() + 80) view_.plan_picture = asked;
    }
    return true;
  }
  if (const auto* anchor = std::get_if<AddAnchor>(&command)) {
    view_.anchors[anchor->id] = {anchor->p_layout_px, anchor->p_map};
    return true;
  }
  if (const auto* anchor = std::get_if<RemoveAnchor>(&command)) return view_.anchors.erase(anchor->id) > 0;
  return false;
}

Result<ViewKeeper> replay_log(Store& store, EnginePort& engine, Origin origin, std::optional<std::int64_t> last) {
  ViewKeeper keeper;
  const auto redo = [&](const Event& event) -> Result<Ok> {
    if (is_refused(event)) return Ok{};
    const auto command = command_of(event);
    if (command && engine.apply(*command, origin)) keeper.note(*command, *parse_json(event.data, kStoredLimits));
    return Ok{};
  };
  if (auto read = for_each_event(store, last, redo); !read) return read.error();
  return keeper;
}

CommandBus::CommandBus(Store& store, EnginePort& engine, std::shared_ptr<const Clock> clock, ViewListener listener,
                       Limits limits)
    : store_(store), engine_(engine), clock_(std::move(clock)), listener_(std::move(listener)), limits_(limits) {}

CommandBus::~CommandBus() { stop(); }

Result<Ok> CommandBus::replay() {
  auto keeper = replay_log(store_, engine_, Origin::kHistory);
  if (!keeper) return keeper.error();
  keeper_ = std::move(*keeper);
  listener_(keeper_.view());
  return Ok{};
}

void CommandBus::start() {
  thread_ = std::thread([this] { run(); });
}

void CommandBus::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  std::deque<Job> left;
  {
    const std::lock_guard lock(mutex_);
    left.swap(waiting_);
  }
  for (const Job& job : left) job.reply(refusal(job.message.id, fail(Errc::kIo, "the server stops")));
}

void CommandBus::submit(const Identity& who, CommandMessage message, Reply reply) {
  const auto is_urgent = [](const Job& job) { return job.message.name == kUrgent; };
  const bool urgent = message.name == kUrgent;
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_ && (urgent || waiting_.size() < limits_.most_waiting)) {
      // Stops and releases overtake everything but each other: a release that waits must not undo a later stop.
      const auto place = urgent ? std::find_if_not(waiting_.begin(), waiting_.end(), is_urgent) : waiting_.end();
      waiting_.insert(place, Job{who, std::move(message), std::move(reply)});
      wake_.notify_one();
      return;
    }
  }
  reply({message.id, std::nullopt, "busy", "the server is busy; try again in a moment"});
}

void CommandBus::run() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
      if (stopping_) return;
      job = std::move(waiting_.front());
      waiting_.pop_front();
    }
    job.reply(carry_out(job));
  }
}

std::optional<CommandReply> CommandBus::earlier_answer(const Job& job) {
  const auto earlier = store_.find(job.message.id);
  if (!earlier) return refusal(job.message.id, earlier.error());
  if (!*earlier) return std::nullopt;
  if ((*earlier)->who.device != job.who.device || (*earlier)->name != job.message.name)
    return refusal(job.message.id, fail(Errc::kConflict, "this id was used for another command"));
  return reply_of(**earlier);
}

CommandReply CommandBus::carry_out(const Job& asked) {
  const Job job{asked.who, kept_on_plan(engine_, asked.message), {}};
  const CommandMessage& message = job.message;
  const std::int64_t now_ms = clock_->now() / 1'000'000;
  const auto command = command_from_json(message.name, message.data, {job.who.name, now_ms * 1'000'000});
  if (!command) return refusal(message.id, command.error());
  if (auto allowed = may(job.who.role, *command); !allowed) return refusal(message.id, allowed.error());
  const auto* stop = std::get_if<EmergencyStop>(&*command);
  if (stop && stop->engaged) return stop_robots(job, *command);
  if (auto answer = earlier_answer(job)) return *answer;
  if (message.expires_ms && *message.expires_ms < now_ms)
    return refusal(message.id, fail(Errc::kCancelled, "it came too late to be carried out"));
  const auto seq = store_.append({0, now_ms, job.who, message.id, message.name, to_text(message.data), ""});
  if (!seq) return refusal(message.id, seq.error());
  return apply_stored(*seq, job, *command);
}

CommandReply CommandBus::apply_stored(std::int64_t seq, const Job& job, const Command& command) {
  const auto applied = engine_.apply(command, Origin::kLive);
  (void)store_.set_outcome(seq, outcome_of(applied)).ok();  // the log has the command; replay decides anew
  if (!applied) return refusal(job.message.id, applied.error(), seq);
  if (keeper_.note(command, job.message.data)) listener_(keeper_.view());
  return {job.message.id, seq, "", ""};
}

CommandReply CommandBus::stop_robots(const Job& job, const Command& command) {
  const auto applied = engine_.apply(command, Origin::kLive);
  const auto earlier = store_.find(job.message.id);
  if (earlier && *earlier) return reply_of(**earlier);
  const std::int64_t now_ms = clock_->now() / 1'000'000;
  const auto seq = store_.append({0, now_ms, job.who, job.message.id, job.message.name, to_text(job.message.data), ""});
  if (seq) (void)store_.set_outcome(*seq, outcome_of(applied)).ok();
  if (!applied) return refusal(job.message.id, applied.error(), seq ? std::optional(*seq) : std::nullopt);
  return {job.message.id, seq ? *seq : 0, "", ""};
}

}  // namespace smokemap::server
