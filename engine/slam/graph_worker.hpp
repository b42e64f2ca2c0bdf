#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "slam/back_end.hpp"

namespace smokemap {

/// Who works on the graph.
enum class GraphWork : std::uint8_t {
  kWhenAsked,     ///< the caller, inside optimize()
  kInBackground,  ///< a thread of its own: add_scan and optimize never wait for it
};

/// The back end behind a queue. It has a graph of its own; what crosses is nodes one way and updates the other. Nodes
/// are worked off one after another in order, on whichever thread: both ways give the same bytes once the queue is
/// empty. One caller's thread.
class GraphWorker {
 public:
  GraphWorker(const SlamParams& params, GraphWork work);
  ~GraphWorker();
  GraphWorker(const GraphWorker&) = delete;
  GraphWorker& operator=(const GraphWorker&) = delete;

  void add(NewNode node);
  /// The newest update, null when there is nothing new. Works off the queue first when nobody else does.
  std::unique_ptr<const GraphUpdate> catch_up(const Progress& progress);
  /// The same after the queue is worked off and the graph was polished; waits.
  std::unique_ptr<const GraphUpdate> polish(const Progress& progress);
  std::size_t waiting() const;

 private:
  void run(const std::stop_token& stop);
  void publish(bool moved);
  std::unique_ptr<const GraphUpdate> fetch();
  void drain(const Progress& progress);

  BackEnd back_;  ///< touched by the thread, or by the caller while the thread idles
  mutable std::mutex mutex_;
  std::condition_variable_any ready_, idle_;
  std::deque<NewNode> queue_;
  bool busy_ = false;
  std::unique_ptr<GraphUpdate> news_;
  std::jthread thread_;  ///< last: ends before what it uses
};

}  // namespace smokemap
