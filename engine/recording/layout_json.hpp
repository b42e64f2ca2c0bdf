#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "maps/layout_map.hpp"

namespace smokemap {

/// The layout document of docs/wire.md, section 1: what `smokemap layout` writes and `smokemap merge` reads.
struct LayoutDocument {
  LayoutMap layout;
  SheetHomography homography;
  std::optional<std::array<Point2, 4>> sheet_corners;  ///< in the picture as taken
};

std::string to_json(const LayoutDocument& document);

/// `size` and `walls` are required, everything else has a default. Without `wall_corners` the ends of walls that lie
/// within 1.5 px of each other (or of a listed corner) become one corner. Unknown fields are ignored.
/// kCorrupt names the field; kTooLarge over 100 000 entries of a list or 100 000 px of size.
Result<LayoutDocument> layout_from_json(std::string_view text);

}  // namespace smokemap
