#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <functional>
#include <map>
#include <thread>

#include "robots/dds_entity.hpp"

namespace smokemap {

/// One thread that waits for DDS and calls whoever has something to do. No listeners: Cyclone 0.10.2 loses events that
/// are pending when one is set, and calls them with its locks held.
class WaitThread {
 public:
  using Handler = std::function<void()>;

  /// `tick` is called at least every `tick_s`, also when data never stop.
  WaitThread(dds_entity_t participant, double tick_s, Handler tick);
  ~WaitThread();
  WaitThread(const WaitThread&) = delete;
  WaitThread& operator=(const WaitThread&) = delete;

  /// Calls `handler` while `reader` holds data. Before start(), or from a handler.
  void on_data(dds_entity_t reader, Handler handler);
  /// Calls `handler` when one of the statuses in `mask` changes; the handler reads the status, which resets it.
  void on_status(dds_entity_t reader, std::uint32_t mask, Handler handler);
  /// Forgets a reader that is about to be deleted.
  void forget(dds_entity_t reader);

  void start();
  /// Returns when no handler runs any more.
  void stop();

 private:
  struct Watch {
    dds_entity_t reader = 0;
    DdsEntity condition;  ///< empty for a status
    Handler handler;
  };
  void run();
  void attach(dds_entity_t entity, Watch watch);

  DdsEntity wait_set_;
  DdsEntity stop_;
  double tick_s_;
  Handler tick_;
  std::map<dds_attach_t, Watch> watches_;
  dds_attach_t next_key_ = 1;
  std::thread thread_;
};

}  // namespace smokemap
