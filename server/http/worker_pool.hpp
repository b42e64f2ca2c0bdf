#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace smokemap::server {

/// A few threads for work that takes too long for the network's. Bounded: refuses when too much waits.
class WorkerPool {
 public:
  WorkerPool(std::size_t threads, std::size_t most_waiting);
  ~WorkerPool();  ///< finishes what runs, drops what waits
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// False: too much waits already, or the pool stops. Exceptions of `work` end with it.
  [[nodiscard]] bool post(std::function<void()> work);
  void stop();

 private:
  void run();
  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> waiting_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace smokemap::server
