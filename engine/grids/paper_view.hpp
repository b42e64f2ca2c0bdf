#pragma once

#include <opencv2/core.hpp>

#include "core/result.hpp"

namespace smokemap {

/// Any picture as CV_8UC3: gray is spread, alpha laid over white, 16 bit cut to 8.
/// kInvalidArgument for an empty picture or other depths and channel counts.
Result<cv::Mat> as_bgr(const cv::Mat& picture);

/// The picture at the size at which it is read. work_px = scale * (picture_px + 0.5) - 0.5.
struct WorkPicture {
  cv::Mat bgr;
  double scale = 1;
};
/// Shrinks a long side over `max_long_side_px`, enlarges one under `min_long_side_px` (at most twice).
WorkPicture at_work_size(const cv::Mat& bgr, double min_long_side_px, double max_long_side_px);

/// A picture with the light divided out: 255 = paper, whatever the shadow.
struct PaperView {
  cv::Mat darkness;  ///< CV_8UC1: 0 paper .. 255 black, by the brightest channel: colours are less dark than ink
  cv::Mat chroma;    ///< CV_8UC1: largest minus smallest channel
  cv::Mat paper;     ///< CV_8UC3: the colours themselves
};

/// Per channel, divides by the background: bright parts within background_share of the long side.
PaperView divide_light(const cv::Mat& bgr, double background_share);

/// Darkness from which a pixel is ink: Otsu over what is not paper, held between low and high (shares of black).
int ink_threshold(const cv::Mat& darkness, double low, double high);

}  // namespace smokemap
