#include "robots/link.hpp"

#include "core/expect.hpp"

namespace smokemap {

const char* to_string(LinkFreshness state) {
  switch (state) {
    case LinkFreshness::kFresh:
      return "fresh";
    case LinkFreshness::kStale:
      return "stale";
    case LinkFreshness::kLost:
      return "lost";
  }
  broken_promise("a known LinkFreshness", __FILE__, __LINE__);
}

LinkFreshness link_state(Stamp last_heard, Stamp now, const LinkParams& params) {
  const double silent_s = to_seconds(now - last_heard);
  if (silent_s < params.stale_after_s) return LinkFreshness::kFresh;
  return silent_s < params.lost_after_s ? LinkFreshness::kStale : LinkFreshness::kLost;
}

}  // namespace smokemap
