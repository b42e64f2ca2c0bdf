#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "core/result.hpp"

namespace smokemap {

struct ChildLimits {
  double seconds = 5;           ///< wall clock
  double processor_s = 5;       ///< processor time, to a few milliseconds: the same on an idle and on a busy machine
  std::size_t bytes = 1 << 30;  ///< memory on top of what this process has now
};

/// Memory that a child process writes and we read.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t size);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  std::span<std::uint8_t> bytes() const { return {data_, size_}; }  ///< empty when there was no memory

 private:
  std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Runs `work` in a forked child that may neither write files nor outlive us, and waits for it. What it should leave
/// behind it writes into a SharedMemory. kTooLarge when it takes longer than it may; kCorrupt when it crashes, throws
/// or needs more memory; kIo when there is no process to be had.
///
/// Only this thread exists in the child: `work` must not wait for others (no thread pools, no parallel loops). A child
/// that waited for a lock another thread held at the fork is started once more.
Result<Ok> run_in_limited_child(const ChildLimits& limits, const std::function<void()>& work);

}  // namespace smokemap
