#include "recording/live_recorder.hpp"

#include <chrono>
#include <fstream>
#include <utility>

#include "core/check.hpp"

namespace smokemap {

Result<Ok> LiveRecorderParams::validate() const {
  return ParamCheck("LiveRecorderParams")
      .in_range("most_waiting", static_cast<double>(most_waiting), 1, 1e6)
      .in_range("flush_s", flush_s, 0.01, 3600)
      .result();
}

Result<std::unique_ptr<LiveRecorder>> LiveRecorder::start(const std::filesystem::path& path,
                                                          const LiveRecorderParams& params, OnTrouble on_trouble) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored))
    return fail(Errc::kConflict, path.string() + " exists already: a recording is never written over");
  auto file = std::make_unique<std::ofstream>(path, std::ios::binary | std::ios::trunc);
  if (!*file) return fail(Errc::kIo, "cannot write " + path.string());
  return start(std::move(file), params, std::move(on_trouble));
}

Result<std::unique_ptr<LiveRecorder>> LiveRecorder::start(std::unique_ptr<std::ostream> out,
                                                          const LiveRecorderParams& params, OnTrouble on_trouble) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  return std::unique_ptr<LiveRecorder>(new LiveRecorder(std::move(out), params, std::move(on_trouble)));
}

LiveRecorder::LiveRecorder(std::unique_ptr<std::ostream> out, const LiveRecorderParams& params, OnTrouble on_trouble)
    : params_(params), on_trouble_(std::move(on_trouble)), out_(std::move(out)), writer_(*out_) {
  thread_ = std::thread([this] { run(); });
}

LiveRecorder::~LiveRecorder() { (void)finish().ok(); }

void LiveRecorder::add(LogItem item, Stamp now) {
  push([item = std::move(item), now](LogWriter& writer) { writer.add(item, now); });
}

void LiveRecorder::add_goal(const std::string& robot, const Pose2& T_map_goal, Stamp now) {
  push([=](LogWriter& writer) { writer.add_goal(robot, T_map_goal, now); });
}

void LiveRecorder::add_event(std::string text, Stamp now) {
  push([text = std::move(text), now](LogWriter& writer) { writer.add_event(text, now); });
}

void LiveRecorder::push(Work work) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || counts_.ended_early || waiting_.size() >= params_.most_waiting) {
      ++counts_.left_out;
      return;
    }
    waiting_.push_back(std::move(work));
  }
  wake_.notify_one();
}

void LiveRecorder::run() {
  using Steady = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(params_.flush_s));
  auto next_flush = Steady::now() + period;
  for (;;) {
    std::deque<Work> work;
    bool stopping = false;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next_flush, [this] { return stopping_ || !waiting_.empty(); });
      work.swap(waiting_);
      stopping = stopping_;
    }
    const bool due = Steady::now() >= next_flush;
    if (due) next_flush = Steady::now() + period;
    write(work, due);
    if (stopping) return;
  }
}

void LiveRecorder::write(const std::deque<Work>& work, bool flush) {
  std::size_t written = 0;
  for (const Work& one : work) {
    if (!*out_) break;
    one(writer_);
    ++written;
  }
  if (flush && *out_) writer_.flush();
  bool is_news = false;
  {
    const std::lock_guard lock(mutex_);
    counts_.written += written;
    counts_.left_out += work.size() - written;
    is_news = !*out_ && !std::exchange(counts_.ended_early, !*out_);
  }
  if (is_news && on_trouble_)
    on_trouble_("the recording has ended: the disk takes no more (what was recorded so far is kept)");
}

Result<Ok> LiveRecorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ && !thread_.joinable()) return Ok{};
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  if (counts().ended_early) return fail(Errc::kIo, "the recording is not whole");
  return writer_.finish();
}

LiveRecorder::Counts LiveRecorder::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace smokemap
