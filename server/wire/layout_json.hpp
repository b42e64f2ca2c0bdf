#pragma once

#include <array>
#include <optional>

#include "maps/layout_map.hpp"
#include "server/wire/json.hpp"

namespace smokemap::server {

/// How the rectified sheet lies in the picture as taken.
struct SheetInPicture {
  SheetHomography homography;
  std::array<Point2, 4> corners{Point2::Zero(), Point2::Zero(), Point2::Zero(),
                                Point2::Zero()};  ///< of the picture, px
};

/// The layout document as part of other JSON; recording/layout_json.hpp says what it holds and what is refused.
Result<LayoutMap> layout_from_json(const Json& json);
Json layout_to_json(const LayoutMap& layout, const std::optional<SheetInPicture>& sheet = std::nullopt);

}  // namespace smokemap::server
