#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace smokemap::test {

inline constexpr std::chrono::seconds kPatience{
    20};  ///< far beyond what a loaded machine needs; reached only on failure

/// What callbacks on other threads deliver; whoever waits is woken by each.
template <typename T>
class Mailbox {
 public:
  void put(T item) {
    const std::lock_guard lock(mutex_);  // also while it notifies: who waits may destroy the mailbox right after
    items_.push_back(std::move(item));
    arrived_.notify_all();
  }
  std::vector<T> all() const {
    const std::lock_guard lock(mutex_);
    return items_;
  }
  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return items_.size();
  }
  bool wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, kPatience, [&] { return items_.size() >= count; });
  }
  /// Calls `poke` again and again, a little pause between, until something has arrived.
  bool wait_poking(const std::function<void()>& poke, std::size_t count = 1) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    std::unique_lock lock(mutex_);
    while (items_.size() < count) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      lock.unlock();
      poke();
      lock.lock();
      arrived_.wait_for(lock, std::chrono::milliseconds(10), [&] { return items_.size() >= count; });
    }
    return true;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<T> items_;
};

/// Asks until it holds, or patience ends.
inline bool eventually(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  std::mutex mutex;
  std::condition_variable nobody;
  std::unique_lock lock(mutex);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    nobody.wait_for(lock, std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace smokemap::test
