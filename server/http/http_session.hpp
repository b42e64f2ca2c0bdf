#pragma once

// Only for http_session.cpp and asio_impl.cpp.

#include <boost/asio/ip/tcp.hpp>
#include <memory>

namespace smokemap::server {

class HttpService;
class UpgradeHandler;

/// Serves one connection until it closes. `socket` is bound to a strand; `alive` is released with the session.
void start_http_session(boost::asio::ip::tcp::socket socket, HttpService& service, UpgradeHandler& sockets,
                        std::shared_ptr<void> alive);

}  // namespace smokemap::server
