#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "geometry/polygon.hpp"

namespace smokemap {

/// A drawing board in pixels of the final picture (integers at pixel centres); drawn twice as large and averaged down,
/// so that edges are smooth and positions right to about a quarter of a pixel.
class PlanCanvas {
 public:
  PlanCanvas(int width_px, int height_px);

  void fill(const Polygon& ring, const cv::Scalar& bgr);
  void box(const Point2& low, const Point2& high, const cv::Scalar& bgr);
  void disc(const Point2& center, double radius_px, const cv::Scalar& bgr);
  void line(const Point2& from, const Point2& to, double width_px, const cv::Scalar& bgr);
  /// Counter-clockwise as seen on the picture, angles from +x, y up.
  void arc(const Point2& center, double radius_px, double from_rad, double to_rad, double width_px,
           const cv::Scalar& bgr);
  void arrow(const Point2& from, const Point2& to, double width_px, const cv::Scalar& bgr);
  enum class Anchor { kLeft, kCenter };
  /// Baseline at `p`; `height_px` of a capital letter. Latin letters only.
  void text(const std::string& words, const Point2& p, double height_px, const cv::Scalar& bgr,
            Anchor anchor = Anchor::kLeft, bool bold = false);

  cv::Mat picture() const;  ///< BGR, 8 bit
  int width_px() const { return width_; }
  int height_px() const { return height_; }

 private:
  cv::Point fixed(const Point2& p_px) const;
  int width_, height_;
  cv::Mat big_;
};

/// Symbols of evacuation plans, about `size_px` wide.
enum class PlanSymbol { kExit, kExtinguisher, kAlarm, kFirstAid, kYouAreHere };
void draw_symbol(PlanCanvas& canvas, PlanSymbol symbol, const Point2& center, double size_px);
const char* colour_word(PlanSymbol symbol);

/// Header, rules of conduct, legend and footer around the plan's area.
void draw_sheet(PlanCanvas& canvas, const std::string& title, const std::string& subtitle);

}  // namespace smokemap
