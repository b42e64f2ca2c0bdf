// The threads and the listening socket; also the one place where Asio's and Beast's separately compiled parts live.

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/impl/src.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/src.hpp>
#include <chrono>
#include <thread>
#include <vector>

#include "server/http/http_session.hpp"
#include "server/http/net_server.hpp"
#include "server/http/raw_upgrade.hpp"
#include "server/http/service.hpp"

namespace smokemap::server {

namespace asio = boost::asio;
using boost::system::error_code;

/// Handlers hold a plain pointer: the threads are joined before it goes, and what still waits goes with `io`.
struct NetServer::Impl {
  Impl(const NetOptions& options_, HttpService& service_, UpgradeHandler& sockets_)
      : options(options_),
        service(service_),
        sockets(sockets_),
        acceptor(asio::make_strand(io)),
        pause(acceptor.get_executor()) {}

  Result<std::uint16_t> listen() {
    error_code failed;
    const auto address = asio::ip::make_address(options.address, failed);
    if (failed) return fail(Errc::kInvalidArgument, "'" + options.address + "' is not an address");
    const asio::ip::tcp::endpoint endpoint(address, options.port);
    acceptor.open(endpoint.protocol(), failed);
    if (!failed) acceptor.set_option(asio::socket_base::reuse_address(true), failed);
    if (!failed) acceptor.bind(endpoint, failed);
    if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
    if (failed)
      return fail(Errc::kIo,
                  "cannot listen on " + options.address + ":" + std::to_string(options.port) + ": " + failed.message());
    return acceptor.local_endpoint().port();
  }

  void accept() {
    acceptor.async_accept(asio::make_strand(io), [this](error_code failed, asio::ip::tcp::socket socket) {
      on_accept(failed, std::move(socket));
    });
  }

  void on_accept(error_code failed, asio::ip::tcp::socket socket) {
    if (!acceptor.is_open() || failed == asio::error::operation_aborted) return;
    if (failed) {  // out of file descriptors: try again in a moment instead of spinning
      pause.expires_after(std::chrono::milliseconds(100));
      pause.async_wait([this](error_code) { accept(); });
      return;
    }
    if (++*connections > options.most_connections) {
      --*connections;
      error_code ignored;
      socket.close(ignored);
    } else {
      std::shared_ptr<void> alive(nullptr, [counter = connections](void*) { --*counter; });
      error_code ignored;
      socket.set_option(asio::ip::tcp::no_delay(true), ignored);
      start_http_session(std::move(socket), service, sockets, std::move(alive));
    }
    accept();
  }

  NetOptions options;
  HttpService& service;
  UpgradeHandler& sockets;
  asio::io_context io;
  asio::ip::tcp::acceptor acceptor;
  asio::steady_timer pause;
  std::shared_ptr<std::atomic<int>> connections = std::make_shared<std::atomic<int>>(0);
  std::vector<std::thread> threads;
};

NetServer::NetServer(const NetOptions& options, HttpService& service, UpgradeHandler& sockets)
    : impl_(std::make_unique<Impl>(options, service, sockets)) {}

NetServer::~NetServer() { stop(); }

Result<std::uint16_t> NetServer::start() {
  const auto port = impl_->listen();
  if (!port) return port;
  impl_->accept();
  for (int i = 0; i < impl_->options.threads; ++i)
    impl_->threads.emplace_back([impl = impl_.get()] { impl->io.run(); });
  return port;
}

void NetServer::stop() {
  impl_->io.stop();
  for (std::thread& thread : impl_->threads)
    if (thread.joinable()) thread.join();
  impl_->threads.clear();
  error_code ignored;
  impl_->acceptor.close(ignored);
}

int wait_for_stop_signal(const std::function<void()>& ready) {
  asio::io_context io;
  asio::signal_set signals(io, SIGINT, SIGTERM);
  int caught = 0;
  signals.async_wait([&caught](error_code, int number) { caught = number; });
  ready();
  io.run();
  return caught;
}

}  // namespace smokemap::server
