#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/time.hpp"
#include "geometry/pose2.hpp"

namespace smokemap {

/// The map in which somebody pointed. A place is stored in that frame and carried to `map` by whatever is known now.
enum class PlaceFrame { kLayoutPx, kSketchPx, kMap };

struct Place {
  PlaceFrame frame = PlaceFrame::kMap;
  Point2 p = Point2::Zero();
  int revision = 0;  ///< of that map when the person pointed
};

enum class PoiKind { kGasBottle, kVictim, kFire, kHazard, kExit, kWater, kAccess, kShutOff, kNote };

const char* to_string(PoiKind kind);
std::optional<PoiKind> poi_kind(std::string_view word);

struct PointOfInterest {
  std::string id;  ///< made by the client
  PoiKind kind = PoiKind::kNote;
  Place place;
  std::string label;
  std::string author;
  Stamp created = 0;
  bool removed = false;
};

}  // namespace smokemap
