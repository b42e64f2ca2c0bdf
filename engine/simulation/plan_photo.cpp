#include "simulation/plan_photo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/random.hpp"

namespace smokemap {
namespace {

/// Brightness of the light at a pixel: a gradient in a random direction and one soft bright blob.
class Light {
 public:
  Light(const PlanPictureParams& params, cv::Size size, std::mt19937_64& random)
      : params_(params), size_(size), direction_(uniform(random, 0, 6.283)) {
    spot_ = {uniform(random, 0.2, 0.8) * size.width, uniform(random, 0.2, 0.8) * size.height};
  }
  double gain(int x, int y) const {
    const double along =
        std::cos(direction_) * (2.0 * x / size_.width - 1) + std::sin(direction_) * (2.0 * y / size_.height - 1);
    return 1 - params_.shade * std::clamp(0.5 + along / 2.8, 0.0, 1.0);
  }
  double glare(int x, int y) const {
    const double r = std::hypot(x - spot_.x, y - spot_.y) / (0.06 * size_.width);
    return params_.glare * std::exp(-0.5 * r * r);
  }

 private:
  const PlanPictureParams& params_;
  cv::Size size_;
  double direction_;
  cv::Point2d spot_;
};

}  // namespace

void photograph(const PlanPictureParams& params, std::mt19937_64& random, PlanPicture& picture) {
  const cv::Size size = picture.sheet.size();
  const double margin = 0.03 * size.width, tilt = params.tilt * size.width;
  const auto corner = [&](double x, double y, int in_x, int in_y) {
    return cv::Point2f(static_cast<float>(x + in_x * (margin + uniform(random, 0, tilt))),
                       static_cast<float>(y + in_y * (margin + uniform(random, 0, tilt))));
  };
  const float w = static_cast<float>(size.width - 1), h = static_cast<float>(size.height - 1);
  const cv::Point2f sheet[4] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  const cv::Point2f photo[4] = {corner(0, 0, 1, 1), corner(w, 0, -1, 1), corner(w, h, -1, -1), corner(0, h, 1, -1)};
  const cv::Mat H_photo_sheet = cv::getPerspectiveTransform(sheet, photo);
  const cv::Mat H_sheet_photo = cv::getPerspectiveTransform(photo, sheet);
  for (int i = 0; i < 9; ++i)
    picture.homography.H_layout_photo[static_cast<std::size_t>(i)] = H_sheet_photo.at<double>(i / 3, i % 3);

  cv::Mat view(size, CV_8UC3, cv::Scalar(150, 160, 165));  // the wall behind
  cv::warpPerspective(picture.sheet, view, H_photo_sheet, size, cv::INTER_AREA, cv::BORDER_TRANSPARENT);
  cv::GaussianBlur(view, view, {3, 3}, 0.7);
  const Light light(params, size, random);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      cv::Vec3b& pixel = view.at<cv::Vec3b>(y, x);
      const double gain = light.gain(x, y), glare = light.glare(x, y);
      for (int c = 0; c < 3; ++c) {
        const double lit = pixel[c] * gain;
        pixel[c] = cv::saturate_cast<uchar>(lit + glare * (255 - lit) + normal(random, params.sigma_noise));
      }
    }
  picture.photo = view;
}

}  // namespace smokemap
