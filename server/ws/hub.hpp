#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/time.hpp"
#include "server/wire/live_state.hpp"
#include "server/wire/messages.hpp"

namespace smokemap::server {

/// A connected browser as the hub sees it. Any thread may call; both return at once.
class Peer {
 public:
  virtual ~Peer() = default;
  virtual void wake() = 0;                                       ///< there is a newer LiveState
  virtual void deliver(SharedBytes text, bool may_be_lost) = 0;  ///< ink of others
  virtual void shut(int code, const char* reason) = 0;
};

struct HubLimits {
  std::size_t most_peers = 64;
  std::size_t most_peers_of_a_device = 8;
};

/// Knows the newest state and who is connected. Encodes on a thread of its own: once for everybody.
class Hub {
 public:
  Hub(const LiveParams& params, std::uint32_t epoch, std::shared_ptr<const Clock> clock, HubLimits limits = {});
  ~Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  void show(std::shared_ptr<const Snapshot> snapshot);
  void show(const ServerView& view);

  std::shared_ptr<const LiveState> state() const;
  double resolution_m() const { return resolution_m_; }

  /// kTooLarge when there are too many. The peer is held weakly.
  Result<Ok> join(const std::shared_ptr<Peer>& peer, const Identity& who);
  void leave(const Peer* peer);
  void seen(const Identity& who, const std::optional<PresenceMessage>& presence);
  void ink(const Peer* from, const Identity& who, const InkMessage& ink);

  /// Says goodbye to everybody and stops encoding; returns when they are gone, or after `patience`.
  void stop(std::chrono::milliseconds patience = std::chrono::milliseconds(500));

 private:
  void run();
  std::vector<std::shared_ptr<Peer>> peers() const;
  std::int64_t now_ms() const { return clock_->now() / 1'000'000; }

  struct Member {
    std::weak_ptr<Peer> peer;
    Identity who;
  };
  const double resolution_m_;
  std::shared_ptr<const Clock> clock_;
  HubLimits limits_;
  mutable std::mutex mutex_;
  std::condition_variable changed_, left_;
  LiveEncoder::Input input_;
  bool dirty_ = false;
  bool stopping_ = false;
  std::shared_ptr<const LiveState> state_;
  std::map<const Peer*, Member> members_;
  LiveEncoder encoder_;  ///< of the thread
  std::thread thread_;
};

}  // namespace smokemap::server
