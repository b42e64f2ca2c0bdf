#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/wire/parts.hpp"
#include "server/wire/tiles.hpp"

namespace smokemap::server {

/// Bytes that several sockets may be sending at once.
using SharedBytes = std::shared_ptr<const std::string>;

/// All that browsers may see, encoded, at one moment. Immutable and shared by every session: a session that lags takes
/// what is newest when it gets round to it, so no queue grows.
struct LiveState {
  std::uint32_t epoch = 0;  ///< of this run of the server
  std::uint64_t seq = 0;    ///< of the newest tile
  TileTable tiles;

  struct PartView {
    std::shared_ptr<const PartState> state;  ///< never null
    std::uint64_t latest_from = 0;           ///< `latest` brings whoever has this revision up to date
    std::vector<SharedBytes> latest;
  };
  std::array<PartView, kPartCount> parts;

  /// Messages for a browser that has revision `from` of the part; shared with others where possible.
  std::vector<SharedBytes> deltas(Part part, std::uint64_t from) const;
};

struct LiveParams {
  double resolution_m = 0.05;
  std::int64_t tile_period_ms = 100;
  std::int64_t robot_period_ms = 100;
  std::int64_t vector_period_ms = 200;
  Result<Ok> validate() const;
};

/// Turns snapshots into live states, each part no more often than its period. Confined to one thread.
class LiveEncoder {
 public:
  LiveEncoder(const LiveParams& params, std::uint32_t epoch);

  struct Input {
    std::shared_ptr<const Snapshot> snapshot;  ///< may be null at the start
    ServerView view;
    std::map<std::string, Person> people;
  };
  /// @param now_ms  any steady clock
  /// @return the new state, or null when there is nothing new to show
  std::shared_ptr<const LiveState> update(const Input& input, std::int64_t now_ms);
  /// When `update` should be called again for what had to wait for its period.
  std::optional<std::int64_t> due_ms() const { return due_ms_; }
  std::shared_ptr<const LiveState> state() const { return state_; }

 private:
  bool update_tiles(const Snapshot& snapshot, LiveState& next);
  bool update_parts(const std::vector<Part>& parts, const Input& input, LiveState& next);
  bool due(std::size_t group, std::int64_t period_ms, std::int64_t now_ms);

  LiveParams params_;
  TileEncoder tiles_;
  std::shared_ptr<const LiveState> state_;
  std::shared_ptr<const Snapshot> shown_;  ///< by the vectors
  std::shared_ptr<const OccupancyGrid> shown_grid_;
  std::shared_ptr<const MergedMap> shown_merged_;
  std::array<std::optional<std::int64_t>, 3> last_ms_;
  std::optional<std::int64_t> due_ms_;
};

}  // namespace smokemap::server
