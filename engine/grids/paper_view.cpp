#include "grids/paper_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace smokemap {

Result<cv::Mat> as_bgr(const cv::Mat& picture) {
  if (picture.empty()) return fail(Errc::kInvalidArgument, "the picture is empty");
  cv::Mat eight = picture;
  if (picture.depth() == CV_16U) {
    picture.convertTo(eight, CV_8U, 1.0 / 257.0);
  } else if (picture.depth() != CV_8U) {
    return fail(Errc::kInvalidArgument, "the picture must have 8 or 16 bits a channel");
  }
  cv::Mat bgr;
  switch (eight.channels()) {
    case 1:
      cv::cvtColor(eight, bgr, cv::COLOR_GRAY2BGR);
      return bgr;
    case 3:
      return eight;
    case 4: {
      cv::cvtColor(eight, bgr, cv::COLOR_BGRA2BGR);
      cv::Mat alpha;
      cv::extractChannel(eight, alpha, 3);
      for (int y = 0; y < bgr.rows; ++y)
        for (int x = 0; x < bgr.cols; ++x) {
          const int a = alpha.at<uchar>(y, x);
          for (auto& value : bgr.at<cv::Vec3b>(y, x).val)
            value = static_cast<uchar>((value * a + 255 * (255 - a)) / 255);
        }
      return bgr;
    }
    default:
      return fail(Errc::kInvalidArgument, "the picture must have 1, 3 or 4 channels");
  }
}

WorkPicture at_work_size(const cv::Mat& bgr, double min_long_side_px, double max_long_side_px) {
  const double side = std::max(bgr.rows, bgr.cols);
  double scale = 1;
  if (side > max_long_side_px) scale = max_long_side_px / side;
  if (side < min_long_side_px) scale = std::min(2.0, min_long_side_px / side);
  if (scale == 1) return {bgr, 1};
  WorkPicture work;
  work.scale = scale;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(bgr.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(bgr.rows * scale))));
  cv::resize(bgr, work.bgr, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  return work;
}

namespace {

/// Brightness of the paper around every pixel, at an eighth of the size: the bright end of each neighbourhood,
/// smoothed.
cv::Mat background_of(const cv::Mat& bgr, double share) {
  const double shrink = 8;
  cv::Mat small;
  const cv::Size size(std::max(1, static_cast<int>(bgr.cols / shrink)),
                      std::max(1, static_cast<int>(bgr.rows / shrink)));
  cv::resize(bgr, small, size, 0, 0, cv::INTER_AREA);
  const int radius = std::max(1, static_cast<int>(share * std::max(size.width, size.height)));
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
  cv::dilate(small, small, disc);
  cv::erode(small, small, cv::getStructuringElement(cv::MORPH_RECT, {radius | 1, radius | 1}));
  cv::GaussianBlur(small, small, {}, 0.7 * radius);
  return small;
}

}  // namespace

PaperView divide_light(const cv::Mat& bgr, double background_share) {
  const cv::Mat background = background_of(bgr, background_share);
  PaperView view;
  view.darkness.create(bgr.size(), CV_8UC1);
  view.chroma.create(bgr.size(), CV_8UC1);
  view.paper.create(bgr.size(), CV_8UC3);
  cv::Mat enlarged;
  cv::resize(background, enlarged, bgr.size(), 0, 0, cv::INTER_LINEAR);
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* in = bgr.ptr<cv::Vec3b>(y);
    const auto* light = enlarged.ptr<cv::Vec3b>(y);
    auto* paper = view.paper.ptr<cv::Vec3b>(y);
    auto* dark = view.darkness.ptr<uchar>(y);
    auto* chroma = view.chroma.ptr<uchar>(y);
    for (int x = 0; x < bgr.cols; ++x) {
      int low = 255, high = 0;
      for (int c = 0; c < 3; ++c) {
        const int value = std::min(255, in[x][c] * 255 / std::max<int>(24, light[x][c]));
        paper[x][c] = static_cast<uchar>(value);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      dark[x] = static_cast<uchar>(255 - high);
      chroma[x] = static_cast<uchar>(high - low);
    }
  }
  return view;
}

int ink_threshold(const cv::Mat& darkness, double low, double high) {
  std::array<double, 256> histogram{};
  const int floor = 40;  // lighter is paper and its grain, and would drown the ink in Otsu's sums
  for (int y = 0; y < darkness.rows; ++y)
    for (int x = 0; x < darkness.cols; ++x) histogram[darkness.at<uchar>(y, x)] += 1;
  double total = 0, sum = 0;
  for (int v = floor; v < 256; ++v) {
    total += histogram[static_cast<std::size_t>(v)];
    sum += v * histogram[static_cast<std::size_t>(v)];
  }
  double below = 0, sum_below = 0, best = -1;
  int threshold = 128;
  for (int v = floor; v < 255; ++v) {
    below += histogram[static_cast<std::size_t>(v)];
    sum_below += v * histogram[static_cast<std::size_t>(v)];
    if (below <= 0 || below >= total) continue;
    const double gap = sum_below / below - (sum - sum_below) / (total - below);
    const double between = below * (total - below) * gap * gap;
    if (between > best) best = between, threshold = v + 1;
  }
  return std::clamp(threshold, static_cast<int>(low * 255), static_cast<int>(high * 255));
}

}  // namespace smokemap
