#pragma once

#include "core/time.hpp"

namespace smokemap {

/// How fresh a robot's data is, by our own clock at reception. Deadline and liveliness are never requested from a
/// robot: ROS writers offer neither, and asking for them means to receive nothing at all.
enum class LinkFreshness { kFresh, kStale, kLost };

const char* to_string(LinkFreshness state);

struct LinkParams {
  double stale_after_s = 1.0;
  double lost_after_s = 5.0;
};

LinkFreshness link_state(Stamp last_heard, Stamp now, const LinkParams& params);

}  // namespace smokemap
