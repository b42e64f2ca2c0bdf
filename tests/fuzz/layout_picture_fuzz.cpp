#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/expect.hpp"
#include "layout/layout_raster.hpp"
#include "layout/read_layout.hpp"
#include "tests/fuzz/driver.hpp"

using namespace smokemap;

/// The bytes are a small gray picture, row by row. Whatever it shows, an answer keeps its promises.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const int width = 8 + data[0] % 88,
            height = std::min(96, static_cast<int>((size - 1) / static_cast<std::size_t>(width)));
  if (height < 1) return 0;
  cv::Mat picture(height, width, CV_8UC1);
  std::copy_n(data + 1, picture.total(), picture.data);
  LayoutParams params;
  params.min_long_side_px = 1;
  const auto reading = read_layout(picture, {}, params);
  if (!reading) return 0;
  const auto& map = reading->layout;
  const auto corners = static_cast<int>(map.corners.size());
  for (const auto& w : map.walls) {
    ENGINE_EXPECT(w.corner_a >= 0 && w.corner_b >= 0 && w.corner_a < corners && w.corner_b < corners &&
                  w.corner_a != w.corner_b);
    ENGINE_EXPECT(w.confidence >= 0 && w.confidence <= 1);
  }
  for (const auto& c : map.corners) ENGINE_EXPECT(c.p_px.allFinite());
  ENGINE_EXPECT(layout_free_space(map).ok());
  return 0;
}

std::vector<fuzz::Bytes> fuzz::seed_corpus() {
  cv::Mat plan(80, 88, CV_8UC1, cv::Scalar(255));
  cv::rectangle(plan, {10, 10}, {76, 66}, cv::Scalar(0), 3);
  cv::line(plan, {40, 10}, {40, 66}, cv::Scalar(0), 2);
  cv::line(plan, {40, 30}, {40, 40}, cv::Scalar(255), 2);
  Bytes bytes{80};  // width 88
  bytes.insert(bytes.end(), plan.data, plan.data + plan.total());
  return {bytes};
}
