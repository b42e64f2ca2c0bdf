// Bytes of the live map while a robot explores, and what it costs to encode and to fan out.
//   build/release/tests/live_map_bench
// A building of 10 m rooms, 60 x 60 m at 0.05 m; 0.5 m/s, 360 beams of 10 m at 10 Hz, 60 s; seed 1. Each beam changes
// the cells it crosses by a noisy step, so occupancies creep: that is harder on the encoder than a map with three
// values.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/random.hpp"
#include "server/wire/live_state.hpp"
#include "tests/bench/bench_options.hpp"

namespace smokemap::server {
namespace {

constexpr int kCells = 1200;
constexpr int kTicks = 600;
constexpr int kClients = 50;

bool is_wall(const Eigen::Vector2d& p) {
  const auto on = [](double v, double other) {
    const double in_room = v - 10 * std::floor(v / 10);
    const double along = other - 10 * std::floor(other / 10);
    return in_room < 0.15 && (along < 4.3 || along > 5.7);  // a passage in every wall
  };
  return on(p.x(), p.y()) || on(p.y(), p.x());
}

void look_around(OccupancyGrid& grid, const Eigen::Vector2d& from, std::mt19937_64& random) {
  for (int beam = 0; beam < 360; ++beam) {
    const double angle = beam * 3.14159265 / 180;
    const Eigen::Vector2d step = 0.05 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    Eigen::Vector2d p = from;
    for (int i = 0; i < 200; ++i, p += step) {
      const Cell cell = grid.frame().cell_of(p);
      if (!grid.frame().contains(cell)) break;
      const bool wall = is_wall(p);
      const int before = grid.at(cell) < 0 ? 50 : grid.at(cell);
      const double change = (wall ? 8 : -4) + normal(random, 1);
      grid.at(cell) = static_cast<std::int8_t>(std::clamp(before + static_cast<int>(std::lround(change)), 0, 100));
      if (wall) break;
    }
  }
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void run() {
  using Time = std::chrono::steady_clock;
  std::mt19937_64 random(1);
  LiveEncoder encoder({}, 1);
  OccupancyGrid grid(GridFrame{0.05, Eigen::Vector2d::Zero(), kCells, kCells});
  const auto merged = std::make_shared<const MergedMap>();
  std::vector<double> bytes, tiles, encode_ms, fan_out_us;
  for (int tick = 0; tick < kTicks; ++tick) {
    const double s = 0.05 * tick;  // along the middle of the rooms
    look_around(grid, {5 + std::min(s, 50.0), 5 + std::max(0.0, s - 50)}, random);
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->sensed = std::make_shared<const OccupancyGrid>(grid);
    snapshot->merged = merged;
    snapshot->sketch = std::make_shared<const SketchView>();
    const auto begin = Time::now();
    const auto state = encoder.update({snapshot, {}, {}}, tick * 100);
    encode_ms.push_back(std::chrono::duration<double, std::milli>(Time::now() - begin).count());
    std::vector<std::shared_ptr<const EncodedTile>> changed;
    for (const auto& [key, tile] : state->tiles)
      if (tile->version == state->seq) changed.push_back(tile);
    const auto sending = Time::now();
    std::size_t size = 0;
    for (int client = 0; client < kClients; ++client) size = map_frame({1, state->seq, 0}, changed).size();
    fan_out_us.push_back(std::chrono::duration<double, std::micro>(Time::now() - sending).count() / kClients);
    bytes.push_back(static_cast<double>(size));
    tiles.push_back(static_cast<double>(changed.size()));
  }
  double total = 0;
  for (const double b : bytes) total += b;
  std::size_t whole = 0;
  for (const auto& [key, tile] : encoder.state()->tiles) whole += tile->wire_bytes();
  std::printf("live map, %d ticks of 0.1 s, seed 1\n", kTicks);
  std::printf("  bytes/s            %8.0f\n", total / (0.1 * kTicks));
  std::printf("  bytes/tick p50 p95 %8.0f %8.0f\n", percentile(bytes, 0.5), percentile(bytes, 0.95));
  std::printf("  tiles/tick p50 p95 %8.0f %8.0f\n", percentile(tiles, 0.5), percentile(tiles, 0.95));
  std::printf("  whole map, bytes   %8zu (%zu tiles)\n", whole, encoder.state()->tiles.size());
  std::printf("  encode ms p50 p95  %8.2f %8.2f\n", percentile(encode_ms, 0.5), percentile(encode_ms, 0.95));
  std::printf("  fan-out us/client  %8.2f %8.2f\n", percentile(fan_out_us, 0.5), percentile(fan_out_us, 0.95));
}

}  // namespace
}  // namespace smokemap::server

int main(int argc, char** argv) {
  smokemap::bench::BenchOptions("Bytes of the live map while a robot explores").read(argc, argv);
  smokemap::server::run();
}
