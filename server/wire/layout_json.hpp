#pragma once

#include <array>
#include <optional>

#include "maps/layout_map.hpp"
#include "server/wire/json.hpp"

namespace smokemap::server {

/// How the rectified sheet lies in the picture as taken.
struct SheetInPicture {
  SheetHomography homography;
  std::array<Point2, 4> corners{Point2::Zero(), Point2::Zero(), Point2::Zero(), Point2::Zero()};  ///< of the picture, px
};

/// Reads a layout document (docs/wire.md, section 1). `corners` and `wall_corners` are used where both are given and fit
/// the walls; otherwise ends of walls closer than half a pixel become one corner.
/// kInvalidArgument names the field; kTooLarge beyond 20 000 walls.
Result<LayoutMap> layout_from_json(const Json& json);

/// Writes all of it; the inverse of layout_from_json. With `sheet` also where it lay in the picture.
Json layout_to_json(const LayoutMap& layout, const std::optional<SheetInPicture>& sheet = std::nullopt);

}  // namespace smokemap::server
