#include "layout/layout_raster.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace smokemap {
namespace {

/// Sub-pixel line with the given width; OpenCV's fixed-point coordinates keep scaled plans straight.
void draw(cv::Mat& mask, const Segment2& segment, double scale, int width, int value) {
  const int bits = 4;
  const auto fixed = [&](const Point2& p) {
    return cv::Point(static_cast<int>(std::lround(p.x() * scale * (1 << bits))),
                     static_cast<int>(std::lround(p.y() * scale * (1 << bits))));
  };
  cv::line(mask, fixed(segment.a), fixed(segment.b), cv::Scalar(value), width, cv::LINE_8, bits);
}

}  // namespace

Result<cv::Mat> layout_free_space(const LayoutMap& layout, double scale) {
  if (!(scale > 0) || !std::isfinite(scale)) return fail(Errc::kInvalidArgument, "the scale must be positive");
  const double columns = std::round(layout.width_px * scale), rows = std::round(layout.height_px * scale);
  if (columns < 1 || rows < 1) return fail(Errc::kInvalidArgument, "the layout has no size");
  if (columns * rows > 40e6)
    return fail(Errc::kInvalidArgument, "the picture of the layout would be over 40 megapixels");
  for (const auto& c : layout.corners)
    if (!c.p_px.allFinite() || c.p_px.cwiseAbs().maxCoeff() > 1e6)
      return fail(Errc::kInvalidArgument, "a corner of the layout is not a number");

  const int border = 2;
  cv::Mat walls = cv::Mat::zeros(static_cast<int>(rows) + 2 * border, static_cast<int>(columns) + 2 * border, CV_8UC1);
  cv::Mat inner = walls(cv::Rect(border, border, static_cast<int>(columns), static_cast<int>(rows)));
  for (std::size_t w = 0; w < layout.walls.size(); ++w) {
    const int width = std::max(2, static_cast<int>(std::lround(layout.walls[w].thickness_px * scale)));
    draw(inner, layout.wall_px(static_cast<int>(w)), scale, width, 255);
  }
  cv::Mat shut = walls.clone();
  cv::Mat shut_inner = shut(cv::Rect(border, border, static_cast<int>(columns), static_cast<int>(rows)));
  for (const auto& o : layout.openings) {
    draw(shut_inner, o.gap_px, scale, 3, 255);
    if (o.kind == OpeningKind::kWindow) draw(inner, o.gap_px, scale, 3, 255);
  }
  cv::floodFill(shut, {0, 0}, cv::Scalar(128));  // what the border reaches with every door shut
  cv::Mat free = (walls == 0) & (shut != 128);
  return cv::Mat(free(cv::Rect(border, border, static_cast<int>(columns), static_cast<int>(rows)))).clone();
}

}  // namespace smokemap
