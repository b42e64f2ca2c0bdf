#include "robots/link.hpp"

#include "core/expect.hpp"

namespace smokemap {

const char* to_string(LinkState state) {
  switch (state) {
    case LinkState::kFresh: return "fresh";
    case LinkState::kStale: return "stale";
    case LinkState::kLost: return "lost";
  }
  broken_promise("a known LinkState", __FILE__, __LINE__);
}

LinkState link_state(Stamp last_heard, Stamp now, const LinkParams& params) {
  const double silent_s = to_seconds(now - last_heard);
  if (silent_s < params.stale_after_s) return LinkState::kFresh;
  return silent_s < params.lost_after_s ? LinkState::kStale : LinkState::kLost;
}

}  // namespace smokemap
