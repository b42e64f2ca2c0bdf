#include "session/engine.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/check.hpp"
#include "navigation/bottleneck.hpp"
#include "navigation/planner.hpp"

namespace smokemap {
namespace {

std::chrono::nanoseconds period(double seconds) { return std::chrono::nanoseconds(from_seconds(seconds)); }

const std::string& robot_of(const SensorItem& item) {
  return std::visit([](const auto& i) -> const std::string& { return i.robot; }, item);
}

}  // namespace

Result<Ok> EngineParams::validate() const {
  if (const auto valid = fleet.validate(); !valid) return valid.error();
  return ParamCheck("EngineParams")
      .in_range("tick_s", tick_s, 0.01, 1)
      .in_range("merge_period_s", merge_period_s, 0.05, 60)
      .in_range("sketch_delay_s", sketch_delay_s, 0, 10)
      .in_range("sensor_queue", static_cast<double>(sensor_queue), 1, 1e6)
      .result();
}

/// Lock order: core_mutex_ alone; the queues have mutexes of their own and nothing is called while they are held.
class Engine::Impl {
 public:
  Impl(const EngineParams& params, std::shared_ptr<const Clock> clock, std::shared_ptr<RobotCommands> robots)
      : params_(params), clock_(std::move(clock)), robots_(robots), core_(params.fleet, std::move(robots)) {
    publish();
    sensing_ = std::jthread([this](const std::stop_token& stop) { sense(stop); });
    merging_ = std::jthread([this](const std::stop_token& stop) { merge(stop); });
    reading_ = std::jthread([this](const std::stop_token& stop) { read_sketch(stop); });
    steering_ = std::jthread([this](const std::stop_token& stop) { steer(stop); });
  }

  Result<Ok> apply(const Command& command, Origin origin) {
    const std::lock_guard lock(core_mutex_);
    const auto done = core_.apply(command, origin);
    if (done) changed_.notify_all();
    return done;
  }

  void push(SensorItem item) {
    {
      const std::lock_guard lock(queue_mutex_);
      if (queue_.size() >= params_.sensor_queue) queue_.pop_front(), ++dropped_;
      queue_.push_back(std::move(item));
    }
    queue_ready_.notify_one();
  }

  std::optional<Point2> place_on_plan(const Point2& p_map) const {
    const std::lock_guard lock(core_mutex_);
    return core_.place_on_plan(p_map);
  }

  Result<Path> way(const std::string& robot, const Point2& p_map) const {
    const auto question = [&] {
      const std::lock_guard lock(core_mutex_);
      return core_.way_question(robot, p_map);
    }();
    if (!question) return question.error();
    Result<Path> path = plan_path(*question->map, question->from_map, question->to_map, question->planner);
    if (path || path.error().message != kNoWayKnown) return path;
    if (const auto reason = too_narrow_a_way(*question->map, question->from_map, question->to_map))
      return fail(Errc::kDegenerate, *reason);
    return path;
  }

  std::shared_ptr<const Snapshot> snapshot() const {
    const std::lock_guard lock(snapshot_mutex_);
    return snapshot_;
  }
  void on_snapshot(SnapshotListener listener) {
    const std::lock_guard lock(snapshot_mutex_);
    listener_ = std::move(listener);
  }
  std::size_t dropped() const {
    const std::lock_guard lock(queue_mutex_);
    return dropped_;
  }

 private:
  void sense(const std::stop_token& stop) {
    auto next_graph = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
      std::optional<SensorItem> item;
      {
        std::unique_lock lock(queue_mutex_);
        queue_ready_.wait_for(lock, stop, period(params_.merge_period_s), [&] { return !queue_.empty(); });
        if (!queue_.empty()) item = std::move(queue_.front()), queue_.pop_front();
      }
      if (item) take(*item);
      if (std::chrono::steady_clock::now() < next_graph) continue;
      next_graph = std::chrono::steady_clock::now() + period(params_.merge_period_s);
      if (mapper_.optimize({{}, stop})) hand_over_graph();
    }
  }

  void take(const SensorItem& item) {
    const auto report = mapper_.add(item);
    std::shared_ptr<const FloorView> floor;
    {
      const std::lock_guard lock(core_mutex_);
      core_.heard(robot_of(item), clock_->now());
      if (report) core_.report(*report);
      floor = core_.floor();
    }
    mapper_.take(floor);
  }

  void hand_over_graph() {
    {
      const std::lock_guard lock(core_mutex_);
      graph_ = mapper_.graph();
      ++graph_revision_;
    }
    changed_.notify_all();
  }

  void merge(const std::stop_token& stop) {
    int graph_done = -1, plan_done = -1;
    while (!stop.stop_requested()) {
      MergeInput input;
      {
        std::unique_lock lock(core_mutex_);
        if (!changed_.wait(lock, stop,
                           [&] { return graph_revision_ != graph_done || core_.plan_revision() != plan_done; }))
          return;
        graph_done = graph_revision_, plan_done = core_.plan_revision();
        input = core_.merge_input(graph_);
      }
      const MergeResult result = merger_.run(input, {{}, stop});
      if (stop.stop_requested()) return;
      const std::lock_guard lock(core_mutex_);
      core_.take(result);
    }
  }

  void read_sketch(const std::stop_token& stop) {
    int done = -1;
    while (!stop.stop_requested()) {
      SessionCore::SketchOrder order;
      {
        std::unique_lock lock(core_mutex_);
        if (!changed_.wait(lock, stop, [&] { return core_.sketch_revision() != done; })) return;
        for (int seen = -1; seen != core_.sketch_revision() && !stop.stop_requested();) {  // until the pen rests
          seen = core_.sketch_revision();
          changed_.wait_for(lock, stop, period(params_.sketch_delay_s),
                            [&] { return core_.sketch_revision() != seen; });
        }
        order = core_.sketch_order();
        done = order.revision;
      }
      SketchReading reading = reader_.read(order.sketch, order.layout, order.verdicts);
      const std::lock_guard lock(core_mutex_);
      core_.take(std::move(reading));
    }
  }

  void steer(const std::stop_token& stop) {
    std::mutex pause;
    std::condition_variable_any never;
    auto next = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
      {
        const std::lock_guard lock(core_mutex_);
        core_.tick(clock_->now());
      }
      publish();
      next = std::max(next + period(params_.tick_s), std::chrono::steady_clock::now());
      std::unique_lock lock(pause);
      never.wait_until(lock, stop, next, [] { return false; });
    }
  }

  void publish() {
    auto snapshot = std::make_shared<Snapshot>();
    {
      const std::lock_guard lock(core_mutex_);
      *snapshot = core_.snapshot(clock_->now());
    }
    SnapshotListener listener;
    {
      const std::lock_guard lock(snapshot_mutex_);
      snapshot->revision = ++revision_;
      snapshot_ = snapshot;
      listener = listener_;
    }
    if (listener) listener(snapshot);
  }

  const EngineParams params_;
  const std::shared_ptr<const Clock> clock_;
  const std::shared_ptr<RobotCommands> robots_;

  mutable std::mutex core_mutex_;
  std::condition_variable_any changed_;
  SessionCore core_;
  FloorGraph graph_;
  int graph_revision_ = 0;

  mutable std::mutex queue_mutex_;
  std::condition_variable_any queue_ready_;
  std::deque<SensorItem> queue_;
  std::size_t dropped_ = 0;

  mutable std::mutex snapshot_mutex_;
  std::shared_ptr<const Snapshot> snapshot_;
  SnapshotListener listener_;
  std::uint64_t revision_ = 0;

  Mapper mapper_{GraphWork::kInBackground};  // sensing thread only
  Merger merger_;                            // merging thread only
  SketchReader reader_;                      // reading thread only

  std::jthread sensing_, merging_, reading_, steering_;  // last: they end before what they use
};

Engine::Engine(const EngineParams& params, std::shared_ptr<const Clock> clock, std::shared_ptr<RobotCommands> robots)
    : impl_(std::make_unique<Impl>(params, std::move(clock), std::move(robots))) {}
Engine::~Engine() = default;

Result<Ok> Engine::apply(const Command& command, Origin origin) { return impl_->apply(command, origin); }
void Engine::add_scan(const LaserScan& scan) { impl_->push(scan); }
void Engine::add_sweep(const RadarSweep& sweep) { impl_->push(sweep); }
void Engine::add_odometry(const Odometry& odometry) { impl_->push(odometry); }
Result<Path> Engine::way(const std::string& robot, const Point2& p_map) const { return impl_->way(robot, p_map); }
std::optional<Point2> Engine::place_on_plan(const Point2& p_map) const { return impl_->place_on_plan(p_map); }
std::shared_ptr<const Snapshot> Engine::snapshot() const { return impl_->snapshot(); }
void Engine::on_snapshot(SnapshotListener listener) { impl_->on_snapshot(std::move(listener)); }
std::size_t Engine::dropped() const { return impl_->dropped(); }

}  // namespace smokemap
