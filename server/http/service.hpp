#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "server/access/origin.hpp"
#include "server/access/pairing.hpp"
#include "server/http/message.hpp"
#include "server/http/static_files.hpp"
#include "server/http/worker_pool.hpp"

namespace smokemap::server {

using Handler = std::function<void(const Request&, Respond)>;

struct Route {
  Method method = Method::kGet;
  std::string pattern;        ///< "/api/plans/{id}/picture"
  std::optional<Role> least;  ///< none: no token is asked for
  std::size_t most_body_bytes = 0;
  bool on_worker = false;  ///< takes long: not on the network's thread
  Handler handler;
};

/// What may be done with a request of which only the head is known.
struct Admission {
  std::optional<Response> refusal;  ///< then the body is not read
  const Route* route = nullptr;     ///< null: a static file
  std::size_t most_body_bytes = 0;
  std::shared_ptr<void> permit;  ///< held while a large body is in memory
};

/// Everything between the socket and the handlers: Host and Origin, routes, roles, limits, worker threads.
/// Routes are added before it is used; then any thread may call.
class HttpService {
 public:
  struct Limits {
    std::size_t large_body_bytes = 1_MiB;  ///< from here on, only a few at a time
    int most_large_bodies = 4;
  };

  HttpService(OriginPolicy origins, Access& access, WorkerPool& workers, std::string web_root, Limits limits);

  void add(Route route);

  /// Fills `who` and `path_parameters` of the request.
  Admission admit(Request& request) const;
  /// For a socket at /api/live: only Host and Origin; its first message brings the token.
  std::optional<Response> refuse_socket(const Request& request) const;
  /// Calls `respond` exactly once, perhaps later and on another thread.
  void handle(const Admission& admission, Request request, const Respond& respond) const;

 private:
  std::optional<Response> refuse_foreign(const Request& request) const;
  OriginPolicy origins_;
  Access& access_;
  WorkerPool& workers_;
  mutable StaticFiles files_;
  Limits limits_;
  std::vector<Route> routes_;
  mutable std::shared_ptr<std::atomic<int>> large_bodies_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace smokemap::server
