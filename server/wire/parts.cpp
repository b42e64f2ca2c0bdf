#include "server/wire/parts.hpp"

namespace smokemap::server {
namespace {

constexpr std::array<const char*, kPartCount> kPartWords{
    "info",           "layout_walls", "walls",        "links", "robots", "pois",   "goals",  "strokes",
    "sketch_regions", "sketch_gaps",  "plan_regions", "pairs", "match",  "people", "alerts", "anchors"};
constexpr std::size_t kMostDeleted = 5'000;

std::string quoted(const std::string& text) { return to_text(Json(text)); }

/// Collects the pieces of a delta and closes a message when it grows too large. Every message but the last says the
/// revision to go on from, as map frames do: a browser whose link breaks in between must not believe it has everything.
class DeltaWriter {
 public:
  DeltaWriter(Part part, std::uint64_t from, std::uint64_t revision, bool reset, std::size_t max_bytes)
      : head_(std::string(R"({"type":"delta","part":")") + to_string(part) + R"(","rev":)"),
        from_(from),
        revision_(revision),
        reset_(reset),
        max_bytes_(max_bytes) {}

  void set(const std::string& id, const std::string& json) { append(set_, quoted(id) + ":" + json); }
  void del(const std::string& id) { append(del_, quoted(id)); }
  std::vector<std::string> finish() {
    flush(revision_);
    return std::move(messages_);
  }

 private:
  void append(std::string& list, const std::string& item) {
    if (set_.size() + del_.size() + item.size() > max_bytes_ && !(set_.empty() && del_.empty())) flush(from_);
    if (!list.empty()) list += ',';
    list += item;
  }
  void flush(std::uint64_t revision) {
    messages_.push_back(head_ + std::to_string(revision) +
                        (reset_ ? R"(,"reset":true,"set":{)" : R"(,"reset":false,"set":{)") + set_ + R"(},"del":[)" +
                        del_ + "]}");
    reset_ = false;
    set_.clear();
    del_.clear();
  }
  std::string head_, set_, del_;
  std::uint64_t from_, revision_;
  bool reset_;
  std::size_t max_bytes_;
  std::vector<std::string> messages_;
};

}  // namespace

const char* to_string(Part part) { return kPartWords[static_cast<std::size_t>(part)]; }

std::optional<Part> part_of(std::string_view word) {
  for (std::size_t i = 0; i < kPartCount; ++i)
    if (word == kPartWords[i]) return static_cast<Part>(i);
  return std::nullopt;
}

std::shared_ptr<const PartState> advance(const PartState& state, const PartTable& table) {
  auto next = std::make_shared<PartState>(state);
  ++next->revision;
  bool changed = false;
  for (const auto& [id, json] : table) {
    PartState::Object& object = next->objects[id];
    if (object.json && *object.json == json) continue;
    object = {next->revision, std::make_shared<const std::string>(json)};
    next->deleted.erase(id);
    changed = true;
  }
  for (auto it = next->objects.begin(); it != next->objects.end();) {
    if (table.contains(it->first)) {
      ++it;
      continue;
    }
    next->deleted[it->first] = next->revision;
    it = next->objects.erase(it);
    changed = true;
  }
  if (next->deleted.size() > kMostDeleted) {
    next->deleted.clear();
    next->oldest = next->revision;
  }
  return changed ? next : nullptr;
}

std::vector<std::string> delta_messages(Part part, const PartState& state, std::uint64_t from, std::size_t max_bytes) {
  if (from == state.revision) return {};
  const bool reset = from == 0 || from < state.oldest || from > state.revision;
  if (reset) from = 0;
  DeltaWriter writer(part, from, state.revision, reset, max_bytes);
  for (const auto& [id, object] : state.objects)
    if (object.changed > from) writer.set(id, *object.json);
  if (!reset)
    for (const auto& [id, revision] : state.deleted)
      if (revision > from) writer.del(id);
  return writer.finish();
}

}  // namespace smokemap::server
