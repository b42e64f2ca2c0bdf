#include "maps/merged_map.hpp"

namespace smokemap {

const char* to_string(WallState state) {
  switch (state) {
    case WallState::kConfirmed:
      return "confirmed";
    case WallState::kMoved:
      return "moved";
    case WallState::kUnseen:
      return "unseen";
    case WallState::kMissing:
      return "missing";
    case WallState::kNew:
      return "new";
  }
  return "unseen";
}

}  // namespace smokemap
