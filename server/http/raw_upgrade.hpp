#pragma once

// Only for http_session.cpp, ws_session.cpp and asio_impl.cpp: the sources that may instantiate Beast.

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <memory>

namespace smokemap::server {

/// A connection that asked to become a WebSocket, with what it asked. Its socket is bound to a strand of its own.
struct RawUpgrade {
  boost::asio::ip::tcp::socket socket;
  boost::beast::http::request<boost::beast::http::empty_body> request;
  std::shared_ptr<void> alive;  ///< counts as a connection as long as it is held
};

}  // namespace smokemap::server
