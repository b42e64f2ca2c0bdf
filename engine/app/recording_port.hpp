#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "recording/live_recorder.hpp"
#include "server/wire/engine_port.hpp"

namespace smokemap::app {

/// Stands between the server and the engine and records what people do and what becomes of it: every live command with
/// its outcome, and every step of a goal. A recording that has ended early shows as an alert on every screen.
class RecordingPort final : public server::EnginePort {
 public:
  /// @param recorder may be null: then nothing is recorded
  RecordingPort(server::EnginePort& engine, std::shared_ptr<const Clock> clock, LiveRecorder* recorder)
      : engine_(engine), scribe_(std::make_shared<Scribe>(std::move(clock), recorder)) {}
  ~RecordingPort() override { scribe_->close(); }

  Result<Ok> apply(const Command& command, Origin origin) override;
  std::shared_ptr<const Snapshot> snapshot() const override { return scribe_->with_trouble(engine_.snapshot()); }
  void on_snapshot(Listener listener) override;
  Result<Path> way(const std::string& robot, const Point2& p_map) const override { return engine_.way(robot, p_map); }
  std::optional<Point2> place_on_plan(const Point2& p_map) const override { return engine_.place_on_plan(p_map); }

 private:
  /// Shared with the engine's listener, which may run a last time when the port has gone.
  class Scribe {
   public:
    Scribe(std::shared_ptr<const Clock> clock, LiveRecorder* recorder)
        : clock_(std::move(clock)), recorder_(recorder) {}
    void close();
    void note(const std::string& event);
    void note_goals(const Snapshot& snapshot);
    std::shared_ptr<const Snapshot> with_trouble(std::shared_ptr<const Snapshot> snapshot);

   private:
    std::shared_ptr<const Clock> clock_;
    std::mutex mutex_;
    LiveRecorder* recorder_;
    std::map<std::string, GoalState> goals_;  ///< as last recorded
  };

  server::EnginePort& engine_;
  std::shared_ptr<Scribe> scribe_;
};

}  // namespace smokemap::app
