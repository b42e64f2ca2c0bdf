#include "slam/graph_worker.hpp"

#include <utility>

namespace smokemap {

GraphWorker::GraphWorker(const SlamParams& params, GraphWork work) : back_(params) {
  if (work == GraphWork::kInBackground) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

GraphWorker::~GraphWorker() = default;

void GraphWorker::add(NewNode node) {
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(node));
  }
  ready_.notify_one();
}

std::size_t GraphWorker::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size() + busy_;
}

void GraphWorker::run(const std::stop_token& stop) {
  for (;;) {
    std::unique_lock lock(mutex_);
    if (!ready_.wait(lock, stop, [this] { return !queue_.empty(); }) || stop.stop_requested()) return;
    NewNode node = std::move(queue_.front());
    queue_.pop_front();
    busy_ = true;
    lock.unlock();
    const bool moved = back_.add(std::move(node), {{}, stop});
    lock.lock();
    const bool caught_up = queue_.empty();
    lock.unlock();
    if (moved || caught_up) publish(moved);
    lock.lock();
    busy_ = false;
    lock.unlock();
    idle_.notify_all();
  }
}

void GraphWorker::publish(bool moved) {
  auto update = std::make_unique<GraphUpdate>(back_.update(moved));
  const std::lock_guard lock(mutex_);
  update->moved = moved || (news_ && news_->moved);
  news_ = std::move(update);
}

std::unique_ptr<const GraphUpdate> GraphWorker::fetch() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, nullptr);
}

/// Returns when nothing waits and nobody works; sooner when the caller was asked to stop.
void GraphWorker::drain(const Progress& progress) {
  if (thread_.joinable()) {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, progress.stop, [this] { return queue_.empty() && !busy_; });
    return;
  }
  bool moved = false, any = false;
  while (!queue_.empty() && !progress.cancelled()) {
    NewNode node = std::move(queue_.front());
    queue_.pop_front();
    moved = back_.add(std::move(node), progress) || moved;
    any = true;
  }
  if (any) publish(moved);
}

std::unique_ptr<const GraphUpdate> GraphWorker::catch_up(const Progress& progress) {
  if (!thread_.joinable()) drain(progress);
  return fetch();
}

std::unique_ptr<const GraphUpdate> GraphWorker::polish(const Progress& progress) {
  drain(progress);
  if (progress.cancelled() || waiting() > 0) return fetch();
  back_.polish(progress);
  publish(true);
  return fetch();
}

}  // namespace smokemap
