#include "robots/wait_thread.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace smokemap {

WaitThread::WaitThread(dds_entity_t participant, double tick_s, Handler tick)
    : wait_set_(dds_create_waitset(participant)),
      stop_(dds_create_guardcondition(participant)),
      tick_s_(tick_s),
      tick_(std::move(tick)) {
  dds_waitset_attach(wait_set_.get(), stop_.get(), 0);
}

WaitThread::~WaitThread() { stop(); }

void WaitThread::on_data(dds_entity_t reader, Handler handler) {
  DdsEntity condition(dds_create_readcondition(reader, DDS_ANY_STATE));
  const dds_entity_t entity = condition.get();
  attach(entity, {reader, std::move(condition), std::move(handler)});
}

void WaitThread::on_status(dds_entity_t reader, std::uint32_t mask, Handler handler) {
  dds_set_status_mask(reader, mask);
  attach(reader, {reader, DdsEntity(), std::move(handler)});
}

void WaitThread::attach(dds_entity_t entity, Watch watch) {
  const dds_attach_t key = next_key_++;
  if (dds_waitset_attach(wait_set_.get(), entity, key) == DDS_RETCODE_OK) watches_.emplace(key, std::move(watch));
}

void WaitThread::forget(dds_entity_t reader) {
  for (auto watch = watches_.begin(); watch != watches_.end();) {
    if (watch->second.reader != reader) {
      ++watch;
      continue;
    }
    const dds_entity_t entity = watch->second.condition ? watch->second.condition.get() : reader;
    dds_waitset_detach(wait_set_.get(), entity);
    watch = watches_.erase(watch);
  }
}

void WaitThread::start() {
  thread_ = std::thread([this] { run(); });
}

void WaitThread::stop() {
  if (!thread_.joinable()) return;
  dds_set_guardcondition(stop_.get(), true);
  thread_.join();
}

void WaitThread::run() {
  using Steady = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(tick_s_));
  auto next_tick = Steady::now() + period;
  std::array<dds_attach_t, 64> triggered{};
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(next_tick - Steady::now()).count();
    const dds_return_t count =
        dds_waitset_wait(wait_set_.get(), triggered.data(), triggered.size(), std::max<dds_duration_t>(left, 0));
    const auto ready = std::min(triggered.size(), static_cast<std::size_t>(std::max(count, 0)));
    for (std::size_t i = 0; i < ready; ++i) {
      if (triggered[i] == 0) return;
      // A handler may forget watches, its own among them: look each up anew and call a copy.
      if (const auto watch = watches_.find(triggered[i]); watch != watches_.end()) Handler(watch->second.handler)();
    }
    if (Steady::now() < next_tick) continue;
    tick_();
    next_tick = Steady::now() + period;
  }
}

}  // namespace smokemap
