#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/bytes.hpp"
#include "server/access/pairing.hpp"
#include "server/wire/command_sink.hpp"
#include "server/ws/hub.hpp"

namespace smokemap::server {

/// Close codes of docs/wire.md.
enum CloseCode { kGoingAway = 1001, kNoToken = 4001, kProtocolError = 4003, kTooSlow = 4008, kTooMany = 4029 };

/// The protocol of one socket, without the socket: messages in, frames out when the socket can take one. Confined to
/// the socket's strand.
///
/// Nothing grows while a browser is slow. What must arrive (answers to commands) has a bounded queue, beyond which the
/// socket is closed; parts and tiles are not queued at all: when the socket is free, whatever is newest and not yet
/// known there is sent.
class LiveSession {
 public:
  struct Params {
    std::size_t control_bytes = 256_KiB;  ///< then 4008
    std::size_t losable_bytes = 64_KiB;   ///< ink is dropped beyond
    std::size_t frame_bytes = 64_KiB;     ///< of tiles
    int credit = 2;                       ///< map frames on their way
    std::int64_t hello_ms = 5'000;
    double messages_per_s = 200;
    double bytes_per_s = 256 * 1024;  ///< bursts of two seconds are let through
    std::int64_t presence_ms = 500;   ///< more often is ignored
  };
  struct World {
    Access& access;
    Hub& hub;
    CommandSink& commands;
    std::shared_ptr<const Clock> clock;
    std::weak_ptr<Peer> self;
    /// Brings an answer back to the strand: there `on_reply` is called with it.
    std::function<void(const CommandReply&)> post_reply;
  };
  struct Frame {
    SharedBytes bytes;
    bool binary = false;
  };
  struct Close {
    int code = 0;
    std::string reason;
  };

  LiveSession(const Params& params, World world);

  void on_text(std::string_view text, std::int64_t now_ms);
  void on_binary() { close(kProtocolError, "only text is taken"); }
  void on_reply(const CommandReply& reply);
  void on_deliver(SharedBytes text, bool may_be_lost);
  /// Call every second or so.
  void on_time(std::int64_t now_ms);
  void close(int code, std::string reason);

  /// The next frame to write, if any. When closing: a last `bye`, then nothing.
  std::optional<Frame> next_frame();
  const std::optional<Close>& closing() const { return closing_; }
  bool welcome() const { return who_.has_value(); }

 private:
  void handle(HelloMessage& hello);
  void handle(AckMessage& ack);
  void handle(CommandMessage& command);
  void handle(PingMessage& ping);
  void handle(PresenceMessage& presence);
  void handle(InkMessage& ink);
  void handle(ViewMessage& view);
  bool within_rate(std::size_t bytes, std::int64_t now_ms);
  void push_control(std::string text);
  std::optional<Frame> next_part(const LiveState& state);
  std::optional<Frame> next_tiles(const LiveState& state);

  Params params_;
  World world_;
  std::optional<Identity> who_;
  std::optional<Close> closing_;
  bool said_bye_ = false;
  std::int64_t now_ms_ = 0, opened_ms_ = 0, last_presence_ms_ = 0, last_rate_ms_ = 0;
  double message_allowance_, byte_allowance_;

  std::deque<SharedBytes> control_;
  std::size_t control_bytes_ = 0;
  std::deque<SharedBytes> part_queue_;  ///< the rest of one part's change; shared bytes
  std::map<Part, std::uint64_t> part_sent_;
  bool tiles_turn_ = false;

  int credit_ = 0;
  std::uint64_t complete_seq_ = 0;  ///< every change up to it was sent
  bool snapshot_ended_ = false;
  std::map<TileKey, std::uint32_t> tile_sent_;  ///< sent beyond complete_seq_
  ViewMessage view_;
};

}  // namespace smokemap::server
