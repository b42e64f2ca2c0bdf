// One HTTP/1.1 connection: head, admission, body, answer, and again. Everything runs on the connection's strand;
// answers of workers are posted back to it. Every wait has a deadline.

#include "server/http/http_session.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <optional>

#include "core/bytes.hpp"
#include "server/http/net_server.hpp"
#include "server/http/raw_upgrade.hpp"
#include "server/http/service.hpp"

namespace smokemap::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;

constexpr auto kHeadDeadline = std::chrono::seconds(20);  // also how long an idle connection is kept
constexpr auto kBodyDeadline = std::chrono::seconds(60);
constexpr auto kWriteDeadline = std::chrono::seconds(60);
constexpr auto kDrainDeadline = std::chrono::seconds(2);
constexpr std::size_t kMostHeadBytes = 16_KiB;
constexpr std::size_t kMostDrainedBytes = 1_MiB;

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(asio::ip::tcp::socket socket, HttpService& service, UpgradeHandler& sockets, std::shared_ptr<void> alive)
      : stream_(std::move(socket)), service_(service), sockets_(sockets), alive_(std::move(alive)) {}

  void start() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] { self->read_head(); });
  }

 private:
  void read_head() {
    parser_.emplace();
    parser_->header_limit(kMostHeadBytes);
    parser_->body_limit(boost::none);  // by route, once the head is known
    stream_.expires_after(kHeadDeadline);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code failed, std::size_t) { self->on_head(failed); });
  }

  void on_head(error_code failed) {
    if (failed == http::error::header_limit)
      return refuse(error_response(431, "too_large", "the head of the request is too large"));
    if (failed == http::error::end_of_stream || failed == beast::error::timeout || is_socket_error(failed))
      return close();
    if (failed) return refuse(error_response(400, "corrupt", "this is not an HTTP request"));
    const auto& head = parser_->get();
    keep_alive_ = head.keep_alive();
    head_only_ = head.method() == http::verb::head;
    const auto request = request_of(head);
    if (!request) return refuse(error_response(400, "corrupt", "the head of the request is malformed"));
    if (beast::websocket::is_upgrade(head)) return upgrade(*request);
    request_ = *request;
    if (parser_->content_length()) request_.content_length = *parser_->content_length();
    admission_ = service_.admit(request_);
    if (admission_.refusal) {
      const bool has_body = parser_->content_length_remaining().value_or(0) > 0 || head.chunked();
      keep_alive_ = keep_alive_ && !has_body;
      return write(std::move(*admission_.refusal));
    }
    if (parser_->content_length() && *parser_->content_length() > admission_.most_body_bytes)
      return refuse(too_large());
    parser_->body_limit(admission_.most_body_bytes);
    stream_.expires_after(kBodyDeadline);
    if (beast::iequals(head[http::field::expect], "100-continue")) return send_continue();
    read_body();
  }

  void send_continue() {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::async_write(stream_, asio::buffer(kContinue.data(), kContinue.size()),
                      [self = shared_from_this()](error_code failed, std::size_t) {
                        if (!failed) self->read_body();
                      });
  }

  void read_body() {
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code failed, std::size_t) { self->on_body(failed); });
  }

  void on_body(error_code failed) {
    if (failed == http::error::body_limit) return refuse(too_large());
    if (failed == beast::error::timeout || is_socket_error(failed)) return close();
    if (failed) return refuse(error_response(400, "corrupt", "the body of the request is malformed"));
    request_.body = std::move(parser_->get().body());
    stream_.expires_never();  // a worker may take its time; it is the handler's to be bounded
    service_.handle(admission_, std::move(request_), [self = shared_from_this()](Response response) {
      asio::post(self->stream_.get_executor(),
                 [self, answer = std::move(response)]() mutable { self->write(std::move(answer)); });
    });
  }

  void write(Response response) {
    admission_ = {};
    response_bytes_ = response.body ? std::move(response.body) : std::make_shared<const std::string>();
    const std::size_t size = head_only_ ? 0 : response_bytes_->size();
    answer_.emplace();
    answer_->version(11);
    answer_->result(static_cast<unsigned>(response.status));
    answer_->keep_alive(keep_alive_);
    for (const auto& [name, value] : security_headers()) answer_->set(name, value);
    for (const auto& [name, value] : response.headers) answer_->set(name, value);
    if (response.status != 304) {
      answer_->set(http::field::content_type, response.content_type);
      answer_->content_length(response_bytes_->size());
    }
    answer_->body() = {response_bytes_->data(), size};
    serializer_.emplace(*answer_);
    if (head_only_) serializer_->split(true);
    stream_.expires_after(kWriteDeadline);
    const auto done = [self = shared_from_this()](error_code failed, std::size_t) { self->on_written(failed); };
    if (head_only_)
      http::async_write_header(stream_, *serializer_, done);
    else
      http::async_write(stream_, *serializer_, done);
  }

  void on_written(error_code failed) {
    if (failed) return close();
    if (keep_alive_) return read_head();
    // Read what is still coming for a moment: a reset would take our answer away from the other side.
    error_code ignored;
    stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kDrainDeadline);
    drain(0);
  }

  void drain(std::size_t so_far) {
    if (so_far > kMostDrainedBytes) return close();
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(16_KiB),
                            [self = shared_from_this(), so_far](error_code failed, std::size_t n) {
                              if (!failed) self->drain(so_far + n);
                            });
  }

  void upgrade(const Request& request) {
    if (auto refusal = service_.refuse_socket(request)) return write(std::move(*refusal));
    stream_.expires_never();
    http::request<http::empty_body> head{parser_->get().base()};
    sockets_.take({stream_.release_socket(), std::move(head), std::move(alive_)});
  }

  void refuse(Response response) {
    keep_alive_ = false;
    write(std::move(response));
  }

  void close() {
    error_code ignored;
    stream_.socket().close(ignored);
  }

  Response too_large() const {
    return error_response(413, "too_large",
                          "at most " + std::to_string(admission_.most_body_bytes) + " bytes are taken here");
  }

  static bool is_socket_error(error_code failed) {
    return failed && failed.category() == boost::system::system_category();
  }

  std::optional<Request> request_of(const http::request<http::string_body>& head) {
    Request request;
    request.method = head.method() == http::verb::get    ? Method::kGet
                     : head.method() == http::verb::head ? Method::kHead
                     : head.method() == http::verb::post ? Method::kPost
                                                         : Method::kOther;
    for (const http::field once : {http::field::host, http::field::origin, http::field::authorization})
      if (head.count(once) > 1) return std::nullopt;  // two servers in a row could each believe another one
    if (!parse_target({head.target().data(), head.target().size()}, request)) return std::nullopt;
    request.host = head[http::field::host];
    request.origin = head[http::field::origin];
    request.authorization = head[http::field::authorization];
    request.accept_encoding = head[http::field::accept_encoding];
    request.if_none_match = head[http::field::if_none_match];
    error_code failed;
    const auto local = stream_.socket().local_endpoint(failed);
    const auto remote = stream_.socket().remote_endpoint(failed);
    request.local_address = local.address().to_string();
    request.local_port = local.port();
    request.from_loopback = remote.address().is_loopback();
    return request;
  }

  beast::tcp_stream stream_;
  HttpService& service_;
  UpgradeHandler& sockets_;
  std::shared_ptr<void> alive_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::span_body<const char>>> answer_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
  SharedBytes response_bytes_;
  Request request_;
  Admission admission_;
  bool keep_alive_ = false;
  bool head_only_ = false;
};

}  // namespace

void start_http_session(asio::ip::tcp::socket socket, HttpService& service, UpgradeHandler& sockets,
                        std::shared_ptr<void> alive) {
  std::make_shared<HttpSession>(std::move(socket), service, sockets, std::move(alive))->start();
}

}  // namespace smokemap::server
