#include "layout/rim_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace smokemap {

RimProfile::RimProfile(const cv::Mat& bgr, const Point2& p, const Point2& inward, int low, int high) : low_(low) {
  for (int o = low; o <= high; ++o) {
    const Point2 q = p + o * inward;
    const int x = static_cast<int>(std::lround(q.x())), y = static_cast<int>(std::lround(q.y()));
    const bool seen = x >= 0 && y >= 0 && x < bgr.cols && y < bgr.rows;
    const cv::Vec3b c = seen ? bgr.at<cv::Vec3b>(y, x) : cv::Vec3b();
    seen_.push_back(seen);
    colours_.push_back({c[0], c[1], c[2]});
  }
}

std::optional<Colour> RimProfile::median(int from, int to) const {
  Colour out{};
  std::vector<int> values;
  for (std::size_t c = 0; c < 3; ++c) {
    values.clear();
    for (int o = from; o < to; ++o) {
      const auto i = static_cast<std::size_t>(o - low_);
      if (!seen_[i]) return std::nullopt;
      values.push_back(colours_[i][c]);
    }
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), nth, values.end());
    out[c] = *nth;
  }
  return out;
}

int largest_difference(const Colour& a, const Colour& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

}  // namespace smokemap
