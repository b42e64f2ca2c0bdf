#include "layout/signs.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <string>

#include "layout/ink_stroke.hpp"

namespace smokemap {
namespace {

/// Class of a saturated colour by its hue (OpenCV: 0..179); empty between the classes.
std::string colour_class(int hue) {
  if (hue < 12 || hue > 165) return "red";
  if (hue >= 18 && hue <= 36) return "yellow";
  if (hue >= 40 && hue <= 96) return "green";
  if (hue > 96 && hue <= 130) return "blue";
  return "";
}

constexpr std::array<const char*, 4> kColours{"red", "yellow", "green", "blue"};

/// One mask a colour; pale tints and dark inks belong to none.
std::array<cv::Mat, 4> colour_masks(const PaperView& view, double min_chroma) {
  std::array<cv::Mat, 4> masks;
  for (auto& m : masks) m = cv::Mat::zeros(view.chroma.size(), CV_8UC1);
  std::array<int, 180> of_hue{};
  for (int h = 0; h < 180; ++h) {
    of_hue[static_cast<std::size_t>(h)] = -1;
    for (std::size_t c = 0; c < kColours.size(); ++c)
      if (colour_class(h) == kColours[c]) of_hue[static_cast<std::size_t>(h)] = static_cast<int>(c);
  }
  const int chroma_limit = static_cast<int>(255 * std::max(0.30, min_chroma)), dark_limit = 190;
  for (int y = 0; y < view.chroma.rows; ++y) {
    const auto* chroma = view.chroma.ptr<uchar>(y);
    const auto* dark = view.darkness.ptr<uchar>(y);
    const auto* paper = view.paper.ptr<cv::Vec3b>(y);
    for (int x = 0; x < view.chroma.cols; ++x) {
      if (chroma[x] < chroma_limit || dark[x] > dark_limit) continue;
      const int b = paper[x][0], g = paper[x][1], r = paper[x][2], d = chroma[x], high = 255 - dark[x];
      int hue = high == r ? 30 * (g - b) / d : high == g ? 60 + 30 * (b - r) / d : 120 + 30 * (r - g) / d;
      if (hue < 0) hue += 180;
      const int c = of_hue[static_cast<std::size_t>(std::min(hue, 179))];
      if (c >= 0) masks[static_cast<std::size_t>(c)].at<uchar>(y, x) = 255;
    }
  }
  return masks;
}

struct Figure {
  cv::Rect box;
  std::vector<cv::Point> outline;
  double filled = 0;  ///< share of its box inside its outline
  double inked = 0;   ///< share of its box that has the colour
};

std::vector<Figure> figures_in(const cv::Mat& mask, double low_px, double high_px) {
  cv::Mat closed;
  const int reach = std::max(1, static_cast<int>(low_px / 4)) | 1;
  cv::morphologyEx(mask, closed, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  cv::morphologyEx(closed, closed, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> family;  // a red frame around the sheet must not swallow the signs inside it
  cv::findContours(closed, outlines, family, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    if (family[i][3] >= 0) continue;  // the rim of a hole
    const auto& outline = outlines[i];
    const cv::Rect box = cv::boundingRect(outline);
    const double small = std::min(box.width, box.height), large = std::max(box.width, box.height);
    if (small < low_px || large > high_px || large > 2.6 * small) continue;
    Figure f;
    f.box = box;
    f.outline = outline;
    f.filled = cv::contourArea(outline) / box.area();
    f.inked = static_cast<double>(cv::countNonZero(mask(box))) / box.area();
    if (f.filled >= 0.5 && f.inked >= 0.35) figures.push_back(f);
  }
  return figures;
}

constexpr double kOpened = 0.8;                      ///< of the least sign's size: thinner is no body
constexpr double kLeastBody = 0.012;                 ///< of the long side: letters are smaller (ISO 23601)
constexpr double kFullBody = 0.86;                   ///< of its box; heads of arrows fill less
constexpr double kLopsided = 0.05;                   ///< of its box: how far the middle of its area may be off
constexpr double kLargestPictogram = 0.016;          ///< of the long side, in a pictogram
constexpr double kColourless = 3e-4;                 ///< share of coloured pixels in a gray copy: specks of noise
constexpr double kGreyLow = 0.25, kGreyHigh = 0.82;  ///< of the darkness of ink: signs on a copy without colours

/// Gray bodies without the thin gray lines that lead up to them: leaves and arcs of doors, rims of walls. What is white
/// inside a pictogram belongs to it.
/// @param black  CV_8UC1, 255 where it is too dark for a sign: inside the gray rim of a wall
cv::Mat bodies_of(const cv::Mat& band, const cv::Mat& black, double least_px, double largest_hole_px) {
  cv::Mat solid = band.clone();
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> family;
  cv::findContours(band, outlines, family, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const cv::Rect box = cv::boundingRect(outlines[i]);
    if (family[i][3] >= 0 && std::max(box.width, box.height) <= largest_hole_px)
      cv::drawContours(solid, outlines, static_cast<int>(i), cv::Scalar(255), cv::FILLED);
  }
  solid.setTo(0, black);
  const int opened = std::max(3, static_cast<int>(kOpened * least_px)) | 1;
  cv::morphologyEx(solid, solid, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, {opened, opened}));
  return solid;
}

/// The body is longer to one side, as the head of an arrow is.
bool is_lopsided(const Figure& f) {
  const cv::Moments m = cv::moments(f.outline);
  if (m.m00 <= 0) return true;
  const double off_x = m.m10 / m.m00 - f.box.x - 0.5 * (f.box.width - 1),
               off_y = m.m01 / m.m00 - f.box.y - 0.5 * (f.box.height - 1);
  return std::abs(off_x) > kLopsided * f.box.width || std::abs(off_y) > kLopsided * f.box.height;
}

/// On a copy without colours signs are gray figures, lighter than walls and darker than tints. What class they were of
/// nobody can tell by the colour.
void add_grey_signs(const PaperView& view, Signs& out) {
  const double side = std::max(view.chroma.rows, view.chroma.cols), black = usual_black(view.darkness, 0.06);
  cv::Mat band;
  cv::inRange(view.darkness, cv::Scalar(kGreyLow * black), cv::Scalar(kGreyHigh * black), band);
  const double least = std::max(4.0, 0.006 * side), most = 0.05 * side;
  const auto hide = [&](const Figure& f) {
    std::vector<cv::Point> hull;
    cv::convexHull(f.outline, hull);
    const std::vector<std::vector<cv::Point>> rim{hull};
    const int margin = std::max(3, static_cast<int>(0.16 * std::max(f.box.width, f.box.height)));
    cv::fillConvexPoly(out.covered, hull, cv::Scalar(255));
    cv::polylines(out.covered, rim, true, cv::Scalar(255), margin);
  };
  auto figures = figures_in(band, least, most);
  for (const auto& f : figures) hide(f);
  for (auto& f : figures_in(bodies_of(band, view.darkness > kGreyHigh * black, least, kLargestPictogram * side),
                            kLeastBody * side, most)) {
    hide(f);  // heads of arrows, too
    const bool known = std::any_of(figures.begin(), figures.end(),
                                   [&](const Figure& o) { return (o.box & f.box).area() > 0.3 * f.box.area(); });
    if (!known && f.filled > kFullBody && !is_lopsided(f)) figures.push_back(std::move(f));
  }
  for (const auto& f : figures)
    out.signs.push_back({Point2(f.box.x + 0.5 * (f.box.width - 1), f.box.y + 0.5 * (f.box.height - 1)),
                         0.25 * (f.box.width + f.box.height), "grey",
                         std::clamp(0.7 * f.filled * f.inked + 0.2, 0.0, 1.0)});
}

}  // namespace

Signs find_signs(const PaperView& view, const LayoutParams& params) {
  const double side = std::max(view.chroma.rows, view.chroma.cols);
  Signs out;
  out.covered = cv::Mat::zeros(view.chroma.size(), CV_8UC1);
  const auto masks = colour_masks(view, params.colour_chroma);
  double roundest = 0;
  double coloured = 0;
  for (const auto& mask : masks) coloured += cv::countNonZero(mask);
  if (coloured < kColourless * static_cast<double>(view.chroma.total())) add_grey_signs(view, out);
  for (std::size_t c = 0; c < masks.size(); ++c) {
    for (const auto& f : figures_in(masks[c], std::max(4.0, 0.006 * side), 0.05 * side)) {
      const Point2 middle(f.box.x + 0.5 * (f.box.width - 1), f.box.y + 0.5 * (f.box.height - 1));
      const double aspect =
          static_cast<double>(std::min(f.box.width, f.box.height)) / std::max(f.box.width, f.box.height);
      const int margin = std::max(2, static_cast<int>(0.12 * std::max(f.box.width, f.box.height)));
      const cv::Rect hidden(f.box.x - margin, f.box.y - margin, f.box.width + 2 * margin, f.box.height + 2 * margin);
      out.covered(hidden & cv::Rect(0, 0, out.covered.cols, out.covered.rows)).setTo(255);
      const bool disc =
          std::string(kColours[c]) == "blue" && aspect > 0.8 && f.filled > 0.68 && f.filled < 0.86 && f.inked > 0.6;
      if (disc && f.inked * aspect > roundest) roundest = f.inked * aspect, out.you_are_here_px = middle;
      LayoutSign sign;
      sign.p_px = middle;
      sign.radius_px = 0.25 * (f.box.width + f.box.height);
      sign.colour = kColours[c];
      sign.confidence = std::clamp(aspect * (0.4 + 0.6 * f.filled), 0.0, 1.0);
      if (!disc) out.signs.push_back(sign);
    }
  }
  std::stable_sort(out.signs.begin(), out.signs.end(), [](const LayoutSign& a, const LayoutSign& b) {
    return a.p_px.y() != b.p_px.y() ? a.p_px.y() < b.p_px.y() : a.p_px.x() < b.p_px.x();
  });
  return out;
}

}  // namespace smokemap
