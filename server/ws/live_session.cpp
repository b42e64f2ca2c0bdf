#include "server/ws/live_session.hpp"

#include <algorithm>

namespace smokemap::server {
namespace {

/// Small and urgent before large.
constexpr std::array<Part, kPartCount> kPartOrder{
    Part::kRobots,      Part::kInfo,          Part::kGoals,      Part::kPois,       Part::kAlerts, Part::kPeople,
    Part::kAnchors,     Part::kMatch,         Part::kPairs,      Part::kWalls,      Part::kLinks,  Part::kStrokes,
    Part::kLayoutWalls, Part::kSketchRegions, Part::kSketchGaps, Part::kPlanRegions};

}  // namespace

LiveSession::LiveSession(const Params& params, World world)
    : params_(params),
      world_(std::move(world)),
      message_allowance_(2 * params.messages_per_s),
      byte_allowance_(2 * params.bytes_per_s) {
  opened_ms_ = last_rate_ms_ = now_ms_ = world_.clock->now() / 1'000'000;
}

void LiveSession::close(int code, std::string reason) {
  if (!closing_) closing_ = Close{code, std::move(reason)};
}

bool LiveSession::within_rate(std::size_t bytes, std::int64_t now_ms) {
  const double seconds = static_cast<double>(std::max<std::int64_t>(0, now_ms - last_rate_ms_)) * 1e-3;
  last_rate_ms_ = now_ms;
  message_allowance_ = std::min(2 * params_.messages_per_s, message_allowance_ + seconds * params_.messages_per_s) - 1;
  byte_allowance_ =
      std::min(2 * params_.bytes_per_s, byte_allowance_ + seconds * params_.bytes_per_s) - static_cast<double>(bytes);
  return message_allowance_ >= 0 && byte_allowance_ >= 0;
}

void LiveSession::on_text(std::string_view text, std::int64_t now_ms) {
  if (closing_) return;
  now_ms_ = now_ms;
  if (!within_rate(text.size(), now_ms)) return close(kTooMany, "too many messages");
  auto message = parse_client_message(text);
  if (!message && message.error().code == Errc::kNotFound && who_)  // a newer browser: say so and go on
    return push_control(reply_message({"", std::nullopt, to_string(Errc::kNotFound), message.error().message}));
  if (!message) return close(kProtocolError, message.error().message);
  if (!who_ && !std::holds_alternative<HelloMessage>(*message)) return close(kProtocolError, "hello must come first");
  std::visit([this](auto& m) { handle(m); }, *message);
}

void LiveSession::handle(HelloMessage& hello) {
  if (who_) return close(kProtocolError, "hello came twice");
  const auto who = world_.access.identify(hello.token);
  if (!who) return close(kNoToken, "pair this device first");
  const auto peer = world_.self.lock();
  if (!peer || !world_.hub.join(peer, *who)) return close(kTooMany, "too many connections");
  who_ = who;
  credit_ = params_.credit;
  if (hello.view) view_ = *hello.view;
  const auto state = world_.hub.state();
  if (hello.epoch == state->epoch) {
    complete_seq_ = hello.seq <= state->seq ? hello.seq : 0;
    part_sent_ = std::move(hello.parts);
  }
  push_control(welcome_message({*who, state->epoch, state->seq, now_ms_, world_.hub.resolution_m()}));
}

void LiveSession::handle(AckMessage&) { credit_ = std::min(params_.credit, credit_ + 1); }

void LiveSession::handle(CommandMessage& command) {
  world_.commands.submit(*who_, std::move(command), world_.post_reply);
}

void LiveSession::handle(PingMessage& ping) {
  world_.hub.seen(*who_, std::nullopt);
  push_control(pong_message(ping.t, now_ms_));
}

void LiveSession::handle(PresenceMessage& presence) {
  if (now_ms_ - last_presence_ms_ < params_.presence_ms) return;
  last_presence_ms_ = now_ms_;
  world_.hub.seen(*who_, presence);
}

void LiveSession::handle(InkMessage& ink) {
  if (who_->role == Role::kObserver) return;
  const auto self = world_.self.lock();
  world_.hub.ink(self.get(), *who_, ink);
}

void LiveSession::handle(ViewMessage& view) { view_ = view; }

void LiveSession::on_reply(const CommandReply& reply) { push_control(reply_message(reply)); }

void LiveSession::on_deliver(SharedBytes text, bool may_be_lost) {
  if (!who_ || closing_ || (may_be_lost && control_bytes_ + text->size() > params_.losable_bytes)) return;
  control_bytes_ += text->size();
  control_.push_back(std::move(text));
}

void LiveSession::push_control(std::string text) {
  if (closing_) return;
  if (control_bytes_ + text.size() > params_.control_bytes) return close(kTooSlow, "too slow");
  control_bytes_ += text.size();
  control_.push_back(std::make_shared<const std::string>(std::move(text)));
}

void LiveSession::on_time(std::int64_t now_ms) {
  now_ms_ = now_ms;
  if (!who_ && now_ms - opened_ms_ > params_.hello_ms) close(kProtocolError, "no hello came");
}

std::optional<LiveSession::Frame> LiveSession::next_frame() {
  if (closing_) {
    if (said_bye_) return std::nullopt;
    said_bye_ = true;
    return Frame{std::make_shared<const std::string>(bye_message(closing_->reason)), false};
  }
  if (!control_.empty()) {
    Frame frame{std::move(control_.front()), false};
    control_.pop_front();
    control_bytes_ -= frame.bytes->size();
    return frame;
  }
  if (!who_) return std::nullopt;
  const auto state = world_.hub.state();
  tiles_turn_ = !tiles_turn_;  // neither may starve the other on a thin link
  auto frame = tiles_turn_ ? next_tiles(*state) : next_part(*state);
  if (!frame) frame = tiles_turn_ ? next_part(*state) : next_tiles(*state);
  return frame;
}

std::optional<LiveSession::Frame> LiveSession::next_part(const LiveState& state) {
  for (std::size_t i = 0; part_queue_.empty() && i < kPartCount; ++i) {
    const Part part = kPartOrder[i];
    std::uint64_t& sent = part_sent_[part];
    const std::uint64_t newest = state.parts[static_cast<std::size_t>(part)].state->revision;
    if (sent == newest) continue;
    for (SharedBytes& text : state.deltas(part, sent)) part_queue_.push_back(std::move(text));
    sent = newest;
  }
  if (part_queue_.empty()) return std::nullopt;
  Frame frame{std::move(part_queue_.front()), false};
  part_queue_.pop_front();
  return frame;
}

std::optional<LiveSession::Frame> LiveSession::next_tiles(const LiveState& state) {
  if (complete_seq_ == state.seq && snapshot_ended_) return std::nullopt;
  const MapFrameHeader header{state.epoch, state.seq, static_cast<double>(world_.clock->now()) / 1e6};
  if (complete_seq_ == state.seq) {
    snapshot_ended_ = true;
    return Frame{std::make_shared<const std::string>(end_of_snapshot_frame(header)), true};
  }
  if (credit_ == 0) return std::nullopt;
  std::vector<std::shared_ptr<const EncodedTile>> dirty;
  for (const auto& [key, tile] : state.tiles) {
    if (tile->version <= complete_seq_) continue;
    const auto sent = tile_sent_.find(key);
    if (sent == tile_sent_.end() || sent->second < tile->version) dirty.push_back(tile);
  }
  const Point2 center = view_.p_map / (kTileCells * world_.hub.resolution_m()) - Point2(0.5, 0.5);
  std::stable_sort(dirty.begin(), dirty.end(), [&center](const auto& a, const auto& b) {
    return (Point2(a->key.x, a->key.y) - center).squaredNorm() < (Point2(b->key.x, b->key.y) - center).squaredNorm();
  });
  std::size_t count = 0, bytes = 0;
  for (; count < dirty.size(); ++count) {
    bytes += dirty[count]->wire_bytes();
    if (count > 0 && bytes > params_.frame_bytes) break;
  }
  const bool everything = count == dirty.size();
  dirty.resize(count);
  for (const auto& tile : dirty) tile_sent_[tile->key] = tile->version;
  if (everything) {
    complete_seq_ = state.seq;
    tile_sent_.clear();
  }
  --credit_;
  MapFrameHeader resumable = header;
  resumable.seq = complete_seq_;
  return Frame{std::make_shared<const std::string>(map_frame(resumable, dirty)), true};
}

}  // namespace smokemap::server
