#include "server/wire/live_state.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace smokemap::server {
namespace {

enum Group : std::size_t { kTiles, kRobots, kVectors };

const std::vector<Part> kRobotParts{Part::kRobots};
const std::vector<Part> kVectorParts{Part::kInfo,       Part::kLayoutWalls, Part::kWalls,   Part::kLinks,
                                     Part::kPois,       Part::kGoals,       Part::kStrokes, Part::kSketchRegions,
                                     Part::kSketchGaps, Part::kPlanRegions, Part::kPairs,   Part::kMatch,
                                     Part::kPeople,     Part::kAlerts,      Part::kAnchors};

/// Parts of a snapshot are shared while they do not change: what a part is made of, by address. Empty: always look.
std::vector<const void*> made_of(Part part, const Snapshot& s) {
  switch (part) {
    case Part::kLayoutWalls:
      return {s.layout.get()};
    case Part::kWalls:
    case Part::kLinks:
      return {s.merged.get()};
    case Part::kStrokes:
    case Part::kSketchGaps:
      return {s.sketch.get()};
    case Part::kSketchRegions:
      return {s.sketch.get(), s.match.get()};
    case Part::kPlanRegions:
    case Part::kPairs:
    case Part::kMatch:
      return {s.match.get()};
    default:
      return {};
  }
}

}  // namespace

Result<Ok> LiveParams::validate() const {
  return ParamCheck("LiveParams")
      .in_range("resolution_m", resolution_m, 0.01, 1)
      .in_range("tile_period_ms", static_cast<double>(tile_period_ms), 0, 10'000)
      .in_range("robot_period_ms", static_cast<double>(robot_period_ms), 0, 10'000)
      .in_range("vector_period_ms", static_cast<double>(vector_period_ms), 0, 10'000)
      .result();
}

std::vector<SharedBytes> LiveState::deltas(Part part, std::uint64_t from) const {
  const PartView& view = parts[static_cast<std::size_t>(part)];
  if (from == view.state->revision) return {};
  if (from == view.latest_from && from != 0) return view.latest;
  std::vector<SharedBytes> messages;
  for (std::string& text : delta_messages(part, *view.state, from))
    messages.push_back(std::make_shared<const std::string>(std::move(text)));
  return messages;
}

LiveEncoder::LiveEncoder(const LiveParams& params, std::uint32_t epoch) : params_(params) {
  ENGINE_EXPECT(params.validate().ok());
  auto state = std::make_shared<LiveState>();
  state->epoch = epoch;
  for (auto& part : state->parts) part.state = std::make_shared<const PartState>();
  state_ = std::move(state);
}

bool LiveEncoder::due(std::size_t group, std::int64_t period_ms, std::int64_t now_ms) {
  auto& last = last_ms_[group];
  if (!last || now_ms - *last >= period_ms) {
    last = now_ms;
    return true;
  }
  due_ms_ = std::min(due_ms_.value_or(*last + period_ms), *last + period_ms);
  return false;
}

bool LiveEncoder::update_tiles(const Snapshot& snapshot, LiveState& next) {
  if (!snapshot.sensed || !snapshot.merged) return false;
  if (snapshot.sensed == shown_grid_ && snapshot.merged == shown_merged_) return false;
  shown_grid_ = snapshot.sensed;
  shown_merged_ = snapshot.merged;
  const auto version = static_cast<std::uint32_t>(next.seq + 1);
  if (!tiles_.update(merged_tiles(*snapshot.sensed, *snapshot.merged, params_.resolution_m), version)) return false;
  next.seq = version;
  next.tiles = tiles_.table();
  return true;
}

bool LiveEncoder::update_parts(const std::vector<Part>& parts, const Input& input, LiveState& next) {
  bool changed = false;
  for (const Part part : parts) {
    LiveState::PartView& view = next.parts[static_cast<std::size_t>(part)];
    if (part != Part::kPeople && !input.snapshot) continue;
    if (shown_ && part != Part::kPeople) {
      const auto sources = made_of(part, *input.snapshot);
      if (!sources.empty() && sources == made_of(part, *shown_)) continue;
    }
    const PartTable table =
        part == Part::kPeople ? people_table(input.people) : part_table(part, *input.snapshot, input.view);
    auto state = advance(*view.state, table);
    if (!state) continue;
    view.latest_from = view.state->revision;
    view.state = std::move(state);
    view.latest.clear();
    for (std::string& text : delta_messages(part, *view.state, view.latest_from))
      view.latest.push_back(std::make_shared<const std::string>(std::move(text)));
    changed = true;
  }
  return changed;
}

std::shared_ptr<const LiveState> LiveEncoder::update(const Input& input, std::int64_t now_ms) {
  auto next = std::make_shared<LiveState>(*state_);
  bool changed = false;
  due_ms_.reset();
  if (due(kTiles, params_.tile_period_ms, now_ms) && input.snapshot) changed |= update_tiles(*input.snapshot, *next);
  if (due(kRobots, params_.robot_period_ms, now_ms)) changed |= update_parts(kRobotParts, input, *next);
  if (due(kVectors, params_.vector_period_ms, now_ms)) {
    changed |= update_parts(kVectorParts, input, *next);
    shown_ = input.snapshot;  // kept alive, so that an address stands for a value
  }
  if (!changed) return nullptr;
  state_ = std::move(next);
  return state_;
}

}  // namespace smokemap::server
