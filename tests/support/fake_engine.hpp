#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "server/wire/engine_port.hpp"

namespace smokemap::test {

/// Takes every command and shows points of interest, strokes, goals and stops; understands nothing. Refuses robots
/// called "nobody". Snapshots come at once, on the caller's thread.
class FakeEngine final : public server::EnginePort {
 public:
  FakeEngine() {
    auto empty = std::make_shared<Snapshot>();
    empty->merged = std::make_shared<MergedMap>();
    empty->sensed = std::make_shared<OccupancyGrid>();
    empty->sketch = std::make_shared<SketchView>();
    newest_ = empty;
  }

  Result<Ok> apply(const Command& command, Origin origin) override {
    const std::lock_guard lock(mutex_);
    const auto* goal = std::get_if<SetGoal>(&command);
    if (goal && goal->goal.robot == "nobody") return fail(Errc::kNotFound, "no robot is called nobody");
    applied_.push_back({command, origin});
    auto next = std::make_shared<Snapshot>(*newest_);
    ++next->revision;
    if (const auto* place = std::get_if<PlacePoi>(&command)) {
      std::erase_if(next->pois, [&](const PoiView& view) { return view.poi.id == place->poi.id; });
      next->pois.push_back({place->poi, {place->poi.place.p, 0.1, 0.9, ""}});
    }
    if (const auto* stroke = std::get_if<AddStroke>(&command)) {
      auto sketch = std::make_shared<SketchView>(*next->sketch);
      sketch->sketch.strokes.push_back(stroke->stroke);
      sketch->warning = "not read";
      next->sketch = sketch;
    }
    if (goal) next->goals.push_back({goal->goal, {}, 0, 0});
    publish(next);
    return Ok{};
  }
  std::shared_ptr<const Snapshot> snapshot() const override {
    const std::lock_guard lock(mutex_);
    if (!counting_) return newest_;
    auto next = std::make_shared<Snapshot>(*newest_);  // as if the engine ticked
    ++next->revision;
    newest_ = next;
    return newest_;
  }
  void on_snapshot(Listener listener) override {
    const std::lock_guard lock(mutex_);
    listener_ = std::move(listener);
  }

  /// Straight ways, half of them unseen; none beyond 100 m, none for robots called "nobody".
  Result<Path> way(const std::string& robot, const Point2& p_map) const override {
    if (robot == "nobody") return fail(Errc::kNotFound, "there is no robot nobody");
    if (p_map.norm() > 100) return fail(Errc::kDegenerate, "no way there is known");
    return Path{{Point2::Zero(), p_map}, p_map.norm(), p_map.norm() / 2};
  }

  /// Every look is a newer snapshot, for those who wait for one.
  void tick_on_look() { counting_ = true; }
  void show(const std::shared_ptr<const OccupancyGrid>& sensed) {
    const std::lock_guard lock(mutex_);
    auto next = std::make_shared<Snapshot>(*newest_);
    ++next->revision;
    next->sensed = sensed;
    publish(next);
  }
  std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return applied_.size();
  }
  std::vector<std::pair<Command, Origin>> applied() const {
    const std::lock_guard lock(mutex_);
    return applied_;
  }

 private:
  void publish(std::shared_ptr<const Snapshot> next) {
    newest_ = std::move(next);
    if (listener_) listener_(newest_);
  }
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Snapshot> newest_;
  std::vector<std::pair<Command, Origin>> applied_;
  Listener listener_;
  bool counting_ = false;
};

}  // namespace smokemap::test
