#include "server/ws/hub.hpp"

#include <algorithm>
#include <chrono>

namespace smokemap::server {

Hub::Hub(const LiveParams& params, std::uint32_t epoch, std::shared_ptr<const Clock> clock, HubLimits limits)
    : resolution_m_(params.resolution_m), clock_(std::move(clock)), limits_(limits), encoder_(params, epoch) {
  state_ = encoder_.state();
  thread_ = std::thread([this] { run(); });
}

Hub::~Hub() { stop(); }

void Hub::show(std::shared_ptr<const Snapshot> snapshot) {
  const std::lock_guard lock(mutex_);
  input_.snapshot = std::move(snapshot);
  dirty_ = true;
  changed_.notify_one();
}

void Hub::show(const ServerView& view) {
  const std::lock_guard lock(mutex_);
  input_.view = view;
  dirty_ = true;
  changed_.notify_one();
}

std::shared_ptr<const LiveState> Hub::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::vector<std::shared_ptr<Peer>> Hub::peers() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Peer>> peers;
  for (const auto& [key, member] : members_)
    if (auto peer = member.peer.lock()) peers.push_back(std::move(peer));
  return peers;
}

Result<Ok> Hub::join(const std::shared_ptr<Peer>& peer, const Identity& who) {
  const std::lock_guard lock(mutex_);
  const auto of_device = std::count_if(members_.begin(), members_.end(),
                                       [&](const auto& member) { return member.second.who.device == who.device; });
  if (stopping_ || members_.size() >= limits_.most_peers ||
      static_cast<std::size_t>(of_device) >= limits_.most_peers_of_a_device)
    return fail(Errc::kTooLarge, "too many connections");
  members_[peer.get()] = {peer, who};
  Person& person = input_.people[who.device];
  person.name = who.name;
  person.role = to_string(who.role);
  person.seen_ms = now_ms();
  dirty_ = true;
  changed_.notify_one();
  return Ok{};
}

void Hub::leave(const Peer* peer) {
  const std::lock_guard lock(mutex_);
  const auto it = members_.find(peer);
  if (it == members_.end()) return;
  const std::string device = it->second.who.device;
  members_.erase(it);
  left_.notify_all();
  if (std::none_of(members_.begin(), members_.end(), [&](const auto& m) { return m.second.who.device == device; }))
    input_.people.erase(device);
  dirty_ = true;
  changed_.notify_one();
}

void Hub::seen(const Identity& who, const std::optional<PresenceMessage>& presence) {
  const std::lock_guard lock(mutex_);
  const auto it = input_.people.find(who.device);
  if (it == input_.people.end()) return;
  it->second.seen_ms = now_ms();
  if (presence) {
    it->second.mode = presence->mode;
    it->second.p_map = presence->p_map;
  }
  dirty_ = true;
  changed_.notify_one();
}

void Hub::ink(const Peer* from, const Identity& who, const InkMessage& ink) {
  const auto text = std::make_shared<const std::string>(ink_message(who, ink));
  for (const auto& peer : peers())
    if (peer.get() != from) peer->deliver(text, true);
}

void Hub::stop(std::chrono::milliseconds patience) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    stopping_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
  for (const auto& peer : peers()) peer->shut(1001, "the server stops");
  std::unique_lock lock(mutex_);
  left_.wait_for(lock, patience, [this] { return members_.empty(); });
}

void Hub::run() {
  std::optional<std::int64_t> due_ms;
  for (;;) {
    LiveEncoder::Input input;
    {
      std::unique_lock lock(mutex_);
      const auto ready = [this] { return dirty_ || stopping_; };
      if (due_ms && !dirty_)
        changed_.wait_for(lock, std::chrono::milliseconds(std::max<std::int64_t>(1, *due_ms)), ready);
      else
        changed_.wait(lock, ready);
      if (stopping_) return;
      dirty_ = false;
      input = input_;
    }
    const auto steady_ms = [] {
      return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count();
    };
    const auto state = encoder_.update(input, steady_ms());
    due_ms = encoder_.due_ms();
    if (due_ms) *due_ms -= steady_ms();
    if (!state) continue;
    {
      const std::lock_guard lock(mutex_);
      state_ = state;
    }
    for (const auto& peer : peers()) peer->wake();
  }
}

}  // namespace smokemap::server
