#pragma once

// A browser made of plain sockets: says exactly what a test tells it to, well-formed or not.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace smokemap::test {

struct HttpAnswer {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
};

class RawClient {
 public:
  explicit RawClient(std::uint16_t port, int receive_buffer_bytes = 0)
      : port_(port), fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer_bytes > 0)
      ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof receive_buffer_bytes);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  }
  ~RawClient() { close(); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) return;  // the other side closed; reading will tell
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  /// More bytes into the buffer; false at the end or when nothing comes for `patience_ms`.
  bool fill(int patience_ms = 5000) {
    pollfd wait{fd_, POLLIN, 0};
    if (::poll(&wait, 1, patience_ms) <= 0) return false;
    char bytes[65536];
    const ssize_t n = ::recv(fd_, bytes, sizeof bytes, 0);
    if (n <= 0) return false;
    buffer_.append(bytes, static_cast<std::size_t>(n));
    return true;
  }

  HttpAnswer ask(const std::string& method, const std::string& target, const std::string& body = {},
                 const std::string& extra_headers = {}) {
    send(method + " " + target + " HTTP/1.1\r\nHost: " + host() + "\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\n" + extra_headers + "\r\n" + body);
    return answer(method == "HEAD");
  }
  HttpAnswer answer(bool head_only = false) {
    HttpAnswer answer;
    std::size_t end = 0;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
      if (!fill()) return answer;
    if (buffer_.size() > 12) answer.status = std::atoi(buffer_.c_str() + 9);
    for (std::size_t at = buffer_.find("\r\n") + 2; at < end;) {
      const std::size_t line_end = buffer_.find("\r\n", at), colon = buffer_.find(':', at);
      std::string name = buffer_.substr(at, colon - at);
      for (char& c : name) c = static_cast<char>(std::tolower(c));
      answer.headers[name] = buffer_.substr(colon + 2, line_end - colon - 2);
      at = line_end + 2;
    }
    buffer_.erase(0, end + 4);
    const auto length = head_only ? 0 : std::strtoul(answer.headers["content-length"].c_str(), nullptr, 10);
    while (buffer_.size() < length)
      if (!fill()) break;
    answer.body = buffer_.substr(0, length);
    buffer_.erase(0, answer.body.size());
    return answer;
  }

  /// The handshake; the status, 101 when it worked.
  int upgrade(const std::string& target = "/api/live",
              const std::string& extra_headers = "Sec-WebSocket-Protocol: smokemap.v1\r\n",
              const std::string& host_header = {}) {
    send("GET " + target + " HTTP/1.1\r\nHost: " + (host_header.empty() ? host() : host_header) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Version: 13\r\n" +
         extra_headers + "\r\n");
    return answer().status;
  }

  void send_frame(std::string_view payload, int opcode = 1, bool masked = true) {
    std::string frame(1, static_cast<char>(0x80 | opcode));
    const int mask_bit = masked ? 0x80 : 0;
    if (payload.size() < 126) {
      frame += static_cast<char>(mask_bit | static_cast<int>(payload.size()));
    } else {
      const bool wide = payload.size() > 0xffff;
      frame += static_cast<char>(mask_bit | (wide ? 127 : 126));
      for (int shift = wide ? 56 : 8; shift >= 0; shift -= 8)
        frame += static_cast<char>((payload.size() >> shift) & 0xff);
    }
    if (masked) frame += std::string(4, '\0');  // a mask of zeros is a mask
    frame += payload;
    send(frame);
  }

  struct Frame {
    int opcode = 0;  ///< 1 text, 2 binary, 8 close
    std::string payload;
    int close_code() const {
      return opcode == 8 && payload.size() >= 2
                 ? (static_cast<unsigned char>(payload[0]) << 8) | static_cast<unsigned char>(payload[1])
                 : 0;
    }
  };
  /// The next message; pings are answered on the way. Nothing when the connection ends or nothing comes.
  std::optional<Frame> next(int patience_ms = 5000) {
    for (;;) {
      while (buffer_.size() < 2)
        if (!fill(patience_ms)) return std::nullopt;
      std::size_t at = 2, length = static_cast<unsigned char>(buffer_[1]) & 0x7f;
      const std::size_t extra = length == 126 ? 2 : length == 127 ? 8 : 0;
      while (buffer_.size() < at + extra)
        if (!fill(patience_ms)) return std::nullopt;
      if (extra > 0) length = 0;
      for (std::size_t i = 0; i < extra; ++i) length = (length << 8) | static_cast<unsigned char>(buffer_[at++]);
      while (buffer_.size() < at + length)
        if (!fill(patience_ms)) return std::nullopt;
      Frame frame{buffer_[0] & 0x0f, buffer_.substr(at, length)};
      buffer_.erase(0, at + length);
      if (frame.opcode == 9) send_frame(frame.payload, 10);
      if (frame.opcode != 9 && frame.opcode != 10) return frame;
    }
  }

 private:
  std::uint16_t port_;
  int fd_;
  std::string buffer_;
};

}  // namespace smokemap::test
