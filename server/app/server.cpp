#include "server/app/server.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <future>
#include <iostream>
#include <mutex>
#include <thread>

#include "core/bytes.hpp"
#include "core/check.hpp"
#include "server/app/command_bus.hpp"
#include "server/http/api.hpp"
#include "server/ws/ws_server.hpp"

namespace smokemap::server {
namespace {

constexpr std::size_t kMostWaitingJobs = 32;
constexpr auto kReplayDeadline = std::chrono::seconds(3);
constexpr auto kReplayLook = std::chrono::milliseconds(20);

/// Lets a listener outlive the server: after `close` nothing gets through.
class Gate {
 public:
  explicit Gate(EnginePort::Listener inner) : inner_(std::move(inner)) {}
  void operator()(std::shared_ptr<const Snapshot> snapshot) {
    const std::lock_guard lock(mutex_);
    if (inner_) inner_(std::move(snapshot));
  }
  void close() {
    const std::lock_guard lock(mutex_);
    inner_ = nullptr;
  }

 private:
  std::mutex mutex_;
  EnginePort::Listener inner_;
};

/// Waits for what the engine makes of the commands: snapshots newer than they are and, when there is a drawing, its
/// regions.
std::shared_ptr<const Snapshot> settled(EnginePort& engine) {
  const auto deadline = std::chrono::steady_clock::now() + kReplayDeadline;
  const std::uint64_t before = engine.snapshot()->revision;
  for (;;) {
    const auto snapshot = engine.snapshot();
    const bool drawn = snapshot->sketch && !snapshot->sketch->sketch.strokes.empty();
    const bool read = !drawn || !snapshot->sketch->regions.empty() || !snapshot->sketch->warning.empty();
    if ((snapshot->revision >= before + 2 && read) || std::chrono::steady_clock::now() > deadline) return snapshot;
    std::this_thread::sleep_for(kReplayLook);
  }
}

}  // namespace

Result<Ok> ServerOptions::validate() const {
  if (auto live_ok = live.validate(); !live_ok) return live_ok;
  return ParamCheck("ServerOptions")
      .require("data_dir", !data_dir.empty(), "must name a folder")
      .in_range("network_threads", network_threads, 1, 16)
      .in_range("worker_threads", worker_threads, 1, 64)
      .result();
}

struct Server::Impl {
  Impl(ServerOptions options_, EnginePort& engine_, PictureService& pictures_, std::shared_ptr<const Clock> clock_)
      : options(std::move(options_)), engine(engine_), pictures(pictures_), clock(std::move(clock_)) {}

  Result<Ok> open() {
    if (auto valid = options.validate(); !valid) return valid;
    auto opened = Store::open(options.data_dir);
    if (!opened) return opened.error();
    store = std::move(*opened);
    auto folder = FileStore::open(options.data_dir + "/files");
    if (!folder) return folder.error();
    files = std::make_unique<FileStore>(std::move(*folder));
    const auto next = store->next_epoch(clock->now() / 1'000'000'000);
    if (!next) return next.error();
    epoch = *next;
    access = std::make_unique<Access>(options.pairing, clock, [this](const PairedDevice& device) {
      return store->add_device({device.who, device.token_hash, device.created_ms, device.revoked});
    });
    const auto devices = store->devices();
    if (!devices) return devices.error();
    for (const DeviceRecord& device : *devices)
      access->restore({device.who, device.token_hash, device.created_ms, device.revoked});
    return Ok{};
  }

  Result<Ok> start_engine_side() {
    hub = std::make_unique<Hub>(options.live, epoch, clock);
    bus = std::make_unique<CommandBus>(
        *store, engine, clock, [this](const ServerView& view) { hub->show(view); }, CommandBus::Limits{});
    if (auto replayed = bus->replay(); !replayed) return replayed;
    gate = std::make_shared<Gate>([this](std::shared_ptr<const Snapshot> snapshot) { hub->show(std::move(snapshot)); });
    engine.on_snapshot([gate = gate](std::shared_ptr<const Snapshot> snapshot) { (*gate)(std::move(snapshot)); });
    if (auto now = engine.snapshot()) hub->show(std::move(now));
    bus->start();
    return Ok{};
  }

  Result<Ok> start_network() {
    workers = std::make_unique<WorkerPool>(static_cast<std::size_t>(options.worker_threads), kMostWaitingJobs);
    service = std::make_unique<HttpService>(OriginPolicy(options.host_names), *access, *workers, options.web_root,
                                            HttpService::Limits{});
    ApiParts parts{*access, *store, *files, pictures, engine, *bus, clock, epoch, {}};
    if (options.make_replay_engine) parts.snapshot_at = [this](std::int64_t at) { return look_back(at); };
    add_api(*service, parts);
    sockets = std::make_unique<WsServer>(options.session, *access, *hub, *bus, clock);
    network = std::make_unique<NetServer>(NetOptions{options.address, options.port, options.network_threads, 256},
                                          *service, *sockets);
    const auto bound = network->start();
    if (!bound) return bound.error();
    port = *bound;
    return Ok{};
  }

  Result<Past> look_back(std::int64_t at) {
    const auto past = options.make_replay_engine();
    const auto replayed = replay_log(*store, *past, Origin::kLive, at);
    if (!replayed) return replayed.error();
    return Past{settled(*past), replayed->view()};
  }

  /// In the order in which nobody is left waiting for somebody who is gone.
  void stop() {
    if (gate) gate->close();
    if (hub) hub->stop();
    if (network) network->stop();
    if (workers) workers->stop();
    if (bus) bus->stop();
    network.reset();
    sockets.reset();
    service.reset();
    workers.reset();
    bus.reset();
    hub.reset();
    store.reset();
  }

  ServerOptions options;
  EnginePort& engine;
  PictureService& pictures;
  std::shared_ptr<const Clock> clock;
  std::uint32_t epoch = 0;
  std::uint16_t port = 0;
  std::unique_ptr<Store> store;
  std::unique_ptr<FileStore> files;
  std::unique_ptr<Access> access;
  std::unique_ptr<Hub> hub;
  std::unique_ptr<CommandBus> bus;
  std::shared_ptr<Gate> gate;
  std::unique_ptr<WorkerPool> workers;
  std::unique_ptr<HttpService> service;
  std::unique_ptr<WsServer> sockets;
  std::unique_ptr<NetServer> network;
};

Server::Server(ServerOptions options, EnginePort& engine, PictureService& pictures, std::shared_ptr<const Clock> clock)
    : impl_(std::make_unique<Impl>(std::move(options), engine, pictures, std::move(clock))) {}

Server::~Server() { stop(); }

Result<Ok> Server::start() {
  if (auto opened = impl_->open(); !opened) return opened;
  if (auto ready = impl_->start_engine_side(); !ready) return ready;
  return impl_->start_network();
}

void Server::stop() { impl_->stop(); }

Result<Json> Server::post(const std::string& path, std::string body) {
  Request request;
  request.method = Method::kPost;
  request.path = path;
  request.host = impl_->options.address + ":" + std::to_string(impl_->port);
  request.local_address = impl_->options.address;
  request.local_port = impl_->port;
  request.from_loopback = true;
  request.who = Identity{"server", "server", Role::kCommander};
  request.body = std::move(body);
  const Admission admission = impl_->service->admit(request);
  if (admission.refusal)
    return fail(Errc::kForbidden, admission.refusal->body ? *admission.refusal->body : path + " was refused");
  auto answered = std::make_shared<std::promise<Response>>();
  impl_->service->handle(admission, std::move(request),
                         [answered](Response response) { answered->set_value(std::move(response)); });
  const Response response = answered->get_future().get();
  const std::string text = response.body ? *response.body : std::string("{}");
  if (response.status >= 400) return fail(Errc::kInvalidArgument, text);
  return parse_json(text, {64_MiB, 64});
}

std::uint16_t Server::port() const { return impl_->port; }

std::string Server::url() const {
  const std::string& address = impl_->options.address;
  const bool any = address == "0.0.0.0" || address == "::";
  const std::string host = any ? "localhost" : address.find(':') == std::string::npos ? address : "[" + address + "]";
  return "http://" + host + ":" + std::to_string(impl_->port) + "/";
}

const std::string& Server::pin() const { return impl_->access->pin(); }

int run_until_signal(Server& server) {
  const int signal = wait_for_stop_signal([&] {
    std::cout << "Smokemap is at " << server.url() << "\nPIN to pair a device: " << server.pin() << std::endl;
  });
  spdlog::info("stopping after signal {}", signal);
  server.stop();
  return 0;
}

}  // namespace smokemap::server
