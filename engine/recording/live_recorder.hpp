#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

#include "core/result.hpp"
#include "core/time.hpp"
#include "geometry/pose2.hpp"
#include "recording/log_writer.hpp"

namespace smokemap {

struct LiveRecorderParams {
  std::size_t most_waiting = 4096;  ///< items; what comes when so many wait is left out and counted
  double flush_s = 5;               ///< what is older than this survives a crash
  Result<Ok> validate() const;
};

/// Records a mission while it runs: sensor data, goals and what people did, in MCAP (log_writer.hpp).
///
/// Whoever adds never waits: a thread of its own encodes and writes. When the disk takes no more, recording ends, is
/// told once, and the mission goes on; what was written by then can be read. Thread-safe.
class LiveRecorder {
 public:
  using OnTrouble = std::function<void(const std::string& text)>;  ///< from the recorder's thread; once

  /// kConflict when the file exists (an earlier mission is not written over), kIo when it cannot be made.
  static Result<std::unique_ptr<LiveRecorder>> start(const std::filesystem::path& path,
                                                     const LiveRecorderParams& params, OnTrouble on_trouble);
  /// Onto any stream; for tests.
  static Result<std::unique_ptr<LiveRecorder>> start(std::unique_ptr<std::ostream> out,
                                                     const LiveRecorderParams& params, OnTrouble on_trouble);
  ~LiveRecorder();  ///< finishes
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  /// @param now  our clock: the time of recording
  void add(LogItem item, Stamp now);
  void add_goal(const std::string& robot, const Pose2& T_map_goal, Stamp now);
  /// What somebody did or what became of it: one line of JSON on /smokemap/events.
  void add_event(std::string text, Stamp now);

  /// Writes what waits and the end of the file. kIo when it could not be written whole.
  Result<Ok> finish();

  struct Counts {
    std::size_t written = 0;
    std::size_t left_out = 0;  ///< the queue was full, or the disk
    bool ended_early = false;
  };
  Counts counts() const;

 private:
  using Work = std::function<void(LogWriter&)>;
  LiveRecorder(std::unique_ptr<std::ostream> out, const LiveRecorderParams& params, OnTrouble on_trouble);
  void push(Work work);
  void run();
  void write(const std::deque<Work>& work, bool flush);

  const LiveRecorderParams params_;
  const OnTrouble on_trouble_;
  std::unique_ptr<std::ostream> out_;
  LogWriter writer_;  ///< of the thread until it has ended

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Work> waiting_;
  Counts counts_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace smokemap
