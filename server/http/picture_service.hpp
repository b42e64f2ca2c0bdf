#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/layout_map.hpp"
#include "maps/sketch_map.hpp"
#include "server/wire/layout_json.hpp"

namespace smokemap::server {

/// A picture that is safe to keep and to show: decoded within limits, turned upright, written anew without metadata.
struct CleanPicture {
  std::string bytes;
  std::string media_type;  ///< "image/png" or "image/jpeg"
  int width_px = 0;
  int height_px = 0;
  std::vector<std::string> warnings;  ///< for people
};

struct PlanReadRequest {
  std::optional<std::array<Point2, 4>>
      corners_px;  ///< of the sheet in the picture: top left, top right, bottom right, bottom left
  std::optional<double> metres_per_pixel;  ///< of the rectified picture
  std::optional<Point2> plan_at_px;        ///< rectified picture: of several drawings the one at this place
};
struct PlanReading {
  LayoutMap layout;  ///< in pixels of `rectified`
  SheetInPicture sheet;
  CleanPicture rectified;
};

struct SketchReading {
  int width_px = 0;
  int height_px = 0;
  std::vector<Stroke> strokes;  ///< without id and author
};

/// What the server asks of whoever understands pictures. Called from worker threads, several at once; may take seconds;
/// throws nothing.
class PictureService {
 public:
  virtual ~PictureService() = default;
  /// Bytes as uploaded (PNG, JPEG, WebP or PDF) -> a picture to keep. kUnsupported, kCorrupt, kTooLarge for others;
  /// kTooLarge for a page of a PDF that takes over a second to draw, unless somebody waits for it (`patient`).
  virtual Result<CleanPicture> clean(std::string_view bytes, int pdf_page, bool patient) = 0;
  /// `bytes` as `clean` returned them. kDegenerate when there are no walls in it.
  virtual Result<PlanReading> read_layout(std::string_view bytes, const PlanReadRequest& request) = 0;
  /// Bytes as uploaded -> strokes of a drawing on paper.
  virtual Result<SketchReading> read_sketch_photo(std::string_view bytes) = 0;
};

}  // namespace smokemap::server
