// The socket of one browser: everything on its strand, one read and one write outstanding. What to say is
// LiveSession's.

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>

#include "core/bytes.hpp"
#include "server/http/raw_upgrade.hpp"
#include "server/ws/ws_server.hpp"

namespace smokemap::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

constexpr std::size_t kMostMessageBytes = 256_KiB;
constexpr int kSendBufferBytes = 64 * 1024;  // the kernel would swallow megabytes of stale map for a stalled browser
constexpr const char* kProtocol = "smokemap.v1";

class WsSession final : public Peer, public std::enable_shared_from_this<WsSession> {
 public:
  WsSession(RawUpgrade upgrade, Hub& hub, std::shared_ptr<const Clock> clock)
      : ws_(std::move(upgrade.socket)),
        timer_(ws_.get_executor()),
        request_(std::move(upgrade.request)),
        alive_(std::move(upgrade.alive)),
        hub_(hub),
        clock_(std::move(clock)) {}

  void start(const LiveSession::Params& params, Access& access, CommandSink& commands) {
    LiveSession::World world{access, hub_, commands, clock_, weak_from_this(), {}};
    world.post_reply = [weak = weak_from_this()](const CommandReply& reply) {
      if (const auto self = weak.lock()) self->on_strand([reply](WsSession& s) { s.live_->on_reply(reply); });
    };
    live_.emplace(params, std::move(world));
    on_strand([](WsSession& s) { s.accept(); });
  }

  void wake() override {
    on_strand([](WsSession&) {});
  }
  void deliver(SharedBytes text, bool may_be_lost) override {
    on_strand([text, may_be_lost](WsSession& s) { s.live_->on_deliver(text, may_be_lost); });
  }
  void shut(int code, const char* reason) override {
    on_strand([code, reason](WsSession& s) { s.live_->close(code, reason); });
  }

  ~WsSession() override { hub_.leave(this); }

 private:
  /// Runs on the strand and afterwards writes what there is to write.
  template <typename Action>
  void on_strand(Action action) {
    asio::post(ws_.get_executor(), [self = shared_from_this(), action] {
      action(*self);
      self->write_next();
    });
  }

  std::int64_t now_ms() const { return clock_->now() / 1'000'000; }

  void accept() {
    error_code ignored;
    beast::get_lowest_layer(ws_).socket().set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    websocket::stream_base::timeout limits{};
    limits.handshake_timeout = std::chrono::seconds(5);
    limits.idle_timeout = std::chrono::seconds(10);
    limits.keep_alive_pings = true;
    ws_.set_option(limits);
    ws_.set_option(websocket::stream_base::decorator(
        [](websocket::response_type& response) { response.set("Sec-WebSocket-Protocol", kProtocol); }));
    ws_.read_message_max(kMostMessageBytes);
    ws_.auto_fragment(false);
    ws_.write_buffer_bytes(64_KiB);
    if (!asks_for_our_protocol()) return shut_down();
    ws_.async_accept(request_, [self = shared_from_this()](error_code failed) {
      if (failed) return;
      self->open_ = true;
      self->read();
      self->tick();
      self->write_next();
    });
  }

  bool asks_for_our_protocol() const {
    const auto offered = request_["Sec-WebSocket-Protocol"];
    return beast::http::token_list(offered).exists(kProtocol);
  }

  void read() {
    ws_.async_read(buffer_, [self = shared_from_this()](error_code failed, std::size_t) { self->on_read(failed); });
  }

  void on_read(error_code failed) {
    if (failed == websocket::error::message_too_big)
      live_->close(kProtocolError, "the message is too large");
    else if (failed)
      return shut_down();
    else if (!ws_.got_text())
      live_->on_binary();
    else
      live_->on_text({static_cast<const char*>(buffer_.data().data()), buffer_.size()}, now_ms());
    buffer_.consume(buffer_.size());
    write_next();
    if (!live_->closing()) read();
  }

  void tick() {
    timer_.expires_after(std::chrono::seconds(1));
    timer_.async_wait([weak = weak_from_this()](error_code failed) {
      const auto self = weak.lock();
      if (failed || !self || !self->open_) return;
      self->live_->on_time(self->now_ms());
      self->write_next();
      self->tick();
    });
  }

  void write_next() {
    if (!open_ || writing_) return;
    const auto frame = live_->next_frame();
    if (!frame) {
      if (live_->closing()) close();
      return;
    }
    writing_ = frame->bytes;
    ws_.binary(frame->binary);
    ws_.async_write(asio::buffer(*writing_), [self = shared_from_this()](error_code failed, std::size_t) {
      self->writing_.reset();
      if (failed) return self->shut_down();
      self->write_next();
    });
  }

  void close() {
    open_ = false;
    hub_.leave(this);
    const auto& closing = *live_->closing();
    websocket::close_reason reason(static_cast<websocket::close_code>(closing.code), closing.reason.substr(0, 120));
    ws_.async_close(reason, [self = shared_from_this()](error_code) { self->shut_down(); });
  }

  /// Without ceremony; pending operations end with an error and let go of us.
  void shut_down() {
    open_ = false;
    hub_.leave(this);
    timer_.cancel();
    error_code ignored;
    beast::get_lowest_layer(ws_).socket().close(ignored);
  }

  websocket::stream<beast::tcp_stream> ws_;
  asio::steady_timer timer_;
  beast::http::request<beast::http::empty_body> request_;
  std::shared_ptr<void> alive_;
  Hub& hub_;
  std::shared_ptr<const Clock> clock_;
  std::optional<LiveSession> live_;
  beast::flat_buffer buffer_;
  SharedBytes writing_;
  bool open_ = false;
};

}  // namespace

WsServer::WsServer(const LiveSession::Params& params, Access& access, Hub& hub, CommandSink& commands,
                   std::shared_ptr<const Clock> clock)
    : params_(params), access_(access), hub_(hub), commands_(commands), clock_(std::move(clock)) {}

void WsServer::take(RawUpgrade upgrade) {
  std::make_shared<WsSession>(std::move(upgrade), hub_, clock_)->start(params_, access_, commands_);
}

}  // namespace smokemap::server
