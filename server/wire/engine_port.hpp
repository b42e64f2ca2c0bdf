#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "session/engine.hpp"

namespace smokemap::server {

/// What the server needs of the engine, so that tests can put a double in its place. Thread-safe.
class EnginePort {
 public:
  using Listener = Engine::SnapshotListener;

  virtual ~EnginePort() = default;
  /// See Engine::apply.
  virtual Result<Ok> apply(const Command& command, Origin origin) = 0;
  /// The latest; never null.
  virtual std::shared_ptr<const Snapshot> snapshot() const = 0;
  /// Called from the engine's thread for every new snapshot. One listener, which returns at once.
  virtual void on_snapshot(Listener listener) = 0;
  /// The pixel of the plan under a place on the merged map; nothing while no plan is aligned there.
  virtual std::optional<Point2> place_on_plan(const Point2& /*p_map*/) const { return std::nullopt; }
  /// See Engine::way.
  virtual Result<Path> way(const std::string& /*robot*/, const Point2& /*p_map*/) const {
    return fail(Errc::kNotFound, "nobody plans ways here");
  }
};

/// The real one.
class EngineAdapter final : public EnginePort {
 public:
  explicit EngineAdapter(Engine& engine) : engine_(engine) {}
  Result<Ok> apply(const Command& command, Origin origin) override { return engine_.apply(command, origin); }
  std::shared_ptr<const Snapshot> snapshot() const override { return engine_.snapshot(); }
  void on_snapshot(Listener listener) override { engine_.on_snapshot(std::move(listener)); }
  std::optional<Point2> place_on_plan(const Point2& p_map) const override { return engine_.place_on_plan(p_map); }
  Result<Path> way(const std::string& robot, const Point2& p_map) const override { return engine_.way(robot, p_map); }

 private:
  Engine& engine_;
};

}  // namespace smokemap::server
