#include "sketch/pen.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

namespace smokemap {
namespace {

/// What stands out from its neighbourhood and is no wider than `width_px`.
cv::Mat thin_part(const cv::Mat& strength, int width_px) {
  cv::Mat smooth, thin;
  cv::GaussianBlur(strength, smooth, {3, 3}, 0);
  cv::morphologyEx(smooth, thin, cv::MORPH_TOPHAT, cv::getStructuringElement(cv::MORPH_RECT, {width_px, width_px}));
  return thin;
}

/// Colour without its gray: how a pixel differs from paper in hue alone.
cv::Vec3f tint(const cv::Vec3b& paper) {
  const float mean = (static_cast<float>(paper[0]) + static_cast<float>(paper[1]) + static_cast<float>(paper[2])) / 3;
  return {static_cast<float>(paper[0]) - mean, static_cast<float>(paper[1]) - mean,
          static_cast<float>(paper[2]) - mean};
}

/// The direction of colour that the ink shares; nothing if most of it is gray or each its own.
std::optional<cv::Vec3f> pen_colour(const PaperView& view, const cv::Mat& thin_dark) {
  cv::Vec3d sum(0, 0, 0);
  double tinted = 0, ink = 0, power = 0;
  for (int y = 0; y < thin_dark.rows; ++y)
    for (int x = 0; x < thin_dark.cols; ++x) {
      if (thin_dark.at<uchar>(y, x) < 45) continue;
      ink += 1;
      const cv::Vec3f t = tint(view.paper.at<cv::Vec3b>(y, x));
      const double size = cv::norm(t);
      if (size < 14) continue;
      tinted += 1;
      sum += size * cv::Vec3d(t[0], t[1], t[2]);
      power += size * size;
    }
  const double length = cv::norm(sum);
  if (tinted < 0.15 * ink || tinted < 50 || length < 0.5 * power) return std::nullopt;
  return cv::Vec3f(static_cast<float>(sum[0] / length), static_cast<float>(sum[1] / length),
                   static_cast<float>(sum[2] / length));
}

cv::Mat along_colour(const PaperView& view, const cv::Vec3f& colour) {
  cv::Mat strength(view.darkness.size(), CV_8UC1);
  for (int y = 0; y < strength.rows; ++y)
    for (int x = 0; x < strength.cols; ++x)
      strength.at<uchar>(y, x) = cv::saturate_cast<uchar>(2.5F * tint(view.paper.at<cv::Vec3b>(y, x)).dot(colour));
  return strength;
}

/// Figures of the weak mask that hold a strong pixel.
cv::Mat connected_to(const cv::Mat& weak, const cv::Mat& strong) {
  cv::Mat labels;
  const int count = cv::connectedComponents(weak, labels, 8);
  std::vector<uchar> held(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (strong.at<uchar>(y, x)) held[static_cast<std::size_t>(labels.at<int>(y, x))] = 255;
  held[0] = 0;
  cv::Mat kept(weak.size(), CV_8UC1);
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x) kept.at<uchar>(y, x) = held[static_cast<std::size_t>(labels.at<int>(y, x))];
  return kept;
}

}  // namespace

PenInk find_pen(const PaperView& view) {
  const int side = std::max(view.darkness.rows, view.darkness.cols);
  const int width_px = std::max(5, side / 60) | 1;
  cv::Mat darkest(view.darkness.size(), CV_8UC1);
  for (int y = 0; y < darkest.rows; ++y)
    for (int x = 0; x < darkest.cols; ++x)
      darkest.at<uchar>(y, x) = cv::saturate_cast<uchar>(view.darkness.at<uchar>(y, x) + view.chroma.at<uchar>(y, x));
  PenInk pen;
  pen.strength = thin_part(darkest, width_px);
  if (const auto colour = pen_colour(view, pen.strength)) {
    pen.coloured = true;
    pen.strength = thin_part(along_colour(view, *colour), width_px);
  }
  const int high = ink_threshold(pen.strength, 0.2, 0.5);
  const cv::Mat weak = pen.strength >= std::max(22, static_cast<int>(0.45 * high)), strong = pen.strength >= high;
  pen.mask = connected_to(weak, strong);
  // Lines that were drawn twice become one.
  const int twice = std::max(3, side / 200) | 1;
  cv::morphologyEx(pen.mask, pen.mask, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_ELLIPSE, {twice, twice}));
  return pen;
}

}  // namespace smokemap
