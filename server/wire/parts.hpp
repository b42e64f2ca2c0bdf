#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/bytes.hpp"
#include "server/wire/json.hpp"
#include "session/snapshot.hpp"

namespace smokemap::server {

/// The tables of docs/wire.md, section 2.
enum class Part {
  kInfo,
  kLayoutWalls,
  kWalls,
  kLinks,
  kRobots,
  kPois,
  kGoals,
  kStrokes,
  kSketchRegions,
  kSketchGaps,
  kPlanRegions,
  kPairs,
  kMatch,
  kPeople,
  kAlerts,
  kAnchors
};
constexpr std::size_t kPartCount = 16;

const char* to_string(Part part);
std::optional<Part> part_of(std::string_view word);

/// Objects of a part by id, serialised.
using PartTable = std::map<std::string, std::string>;

/// What the server itself knows and shows beside the engine's snapshot.
struct ServerView {
  std::string plan_picture;  ///< url of the rectified picture of the present plan; empty = none
  std::map<std::string, std::pair<Point2, Point2>> anchors;  ///< id -> layout_px, map
};

/// Everything of `part` in the snapshot. kPeople is not in it: people_table.
PartTable part_table(Part part, const Snapshot& snapshot, const ServerView& view);

struct Person {
  std::string name;
  std::string role;
  std::string mode;
  std::optional<Point2> p_map;
  std::int64_t seen_ms = 0;
};
PartTable people_table(const std::map<std::string, Person>& people);

/// One part with the history needed to bring anybody up to date: every object knows the revision at which it last
/// changed, and deleted ids are remembered. Immutable once published.
struct PartState {
  struct Object {
    std::uint64_t changed = 0;
    std::shared_ptr<const std::string> json;
  };
  std::uint64_t revision = 0;
  std::uint64_t oldest = 0;  ///< whoever has less must start afresh: deletions before it are forgotten
  std::map<std::string, Object> objects;
  std::map<std::string, std::uint64_t> deleted;
};

/// The next state, or null when nothing changed.
std::shared_ptr<const PartState> advance(const PartState& state, const PartTable& table);

/// `delta` messages that bring a browser from revision `from` (0 = nothing) to `state`; none when it is there already.
/// Each at most about `max_bytes`. Only the last one carries the new revision: whoever loses the link in between asks
/// for all of it again.
std::vector<std::string> delta_messages(Part part, const PartState& state, std::uint64_t from,
                                        std::size_t max_bytes = 32_KiB);

}  // namespace smokemap::server
