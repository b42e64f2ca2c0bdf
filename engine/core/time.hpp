#pragma once

#include <atomic>
#include <cstdint>

namespace smokemap {

/// Nanoseconds since the epoch of whoever stamped it: compare only stamps of one clock.
using Stamp = std::int64_t;

constexpr double to_seconds(Stamp nanoseconds) { return static_cast<double>(nanoseconds) * 1e-9; }
/// To the nearest nanosecond. What a stamp cannot hold becomes the nearest it can (292 years), what is no number 0.
constexpr Stamp from_seconds(double seconds) {
  constexpr double kMost = 9.2e18;
  const double nanoseconds = seconds * 1e9;
  if (!(nanoseconds > -kMost)) return nanoseconds <= -kMost ? static_cast<Stamp>(-kMost) : 0;
  if (nanoseconds >= kMost) return static_cast<Stamp>(kMost);
  return static_cast<Stamp>(nanoseconds + (nanoseconds < 0 ? -0.5 : 0.5));
}

/// The wall clock as an interface, so that tests own the time.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Stamp now() const = 0;
};

/// Nanoseconds since 1970 UTC.
class SystemClock final : public Clock {
 public:
  Stamp now() const override;
};

/// Stands still until told otherwise, from any thread.
class ManualClock final : public Clock {
 public:
  Stamp now() const override { return now_; }
  void advance(Stamp by) { now_ += by; }

 private:
  std::atomic<Stamp> now_ = 0;
};

}  // namespace smokemap
