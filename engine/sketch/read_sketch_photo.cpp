#include "sketch/read_sketch_photo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "grids/paper_view.hpp"
#include "sketch/drawing_lines.hpp"
#include "sketch/pen.hpp"
#include "sketch/skeleton.hpp"

namespace smokemap {
namespace {

/// Figures too small to be walls: dots, holes of the punch, grain. Letters are told by their place and size.
void drop_small_figures(cv::Mat& mask, double dot_px, double text_px) {
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8);
  if (count < 2) return;
  const auto box = [&](int label) {
    return cv::Rect(stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
                    stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
  };
  int largest = 1;
  for (int label = 2; label < count; ++label)
    if (box(label).area() > box(largest).area()) largest = label;
  const cv::Rect drawing = box(largest);
  std::vector<uchar> keep(static_cast<std::size_t>(count), 0);
  for (int label = 1; label < count; ++label) {
    const cv::Rect b = box(label);
    const double side = std::max(b.width, b.height), small = std::min(b.width, b.height);
    const bool apart = (b & drawing).area() < 0.5 * b.area();
    const bool word = apart && side < 0.45 * std::max(drawing.width, drawing.height);
    const bool letter = side < text_px && small > 0.35 * side;
    keep[static_cast<std::size_t>(label)] = label == largest || (side >= dot_px && !word && !letter);
  }
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (const int label = labels.at<int>(y, x); label > 0 && !keep[static_cast<std::size_t>(label)])
        mask.at<uchar>(y, x) = 0;
}

/// Twice the median distance from the middle of a line to its edge.
double pen_width(const cv::Mat& mask, const std::vector<SkeletonBranch>& branches) {
  cv::Mat distance;
  cv::distanceTransform(mask, distance, cv::DIST_L2, cv::DIST_MASK_5);
  std::vector<float> widths;
  for (const auto& b : branches)
    for (const auto& p : b.points) widths.push_back(distance.at<float>(p));
  if (widths.empty()) return 1;
  const auto nth = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), nth, widths.end());
  return std::max(1.0, 2.0 * static_cast<double>(*nth) - 1.0);
}

Result<SketchPhoto> read_drawing(const cv::Mat& picture, const SketchPhotoParams& params, const Progress& progress) {
  if (const auto valid = params.validate(); !valid) return valid.error();
  if (1e-6 * picture.rows * static_cast<double>(picture.cols) > params.max_megapixels)
    return fail(Errc::kTooLarge, "the photograph is too large");
  const auto bgr = as_bgr(picture);
  if (!bgr) return bgr.error();
  const WorkPicture work = at_work_size(*bgr, 1, params.work_long_side_px);
  const double side = std::max(work.bgr.rows, work.bgr.cols);
  progress.tell(0.1, "light");
  const PaperView view = divide_light(work.bgr, params.background_share);
  PenInk pen_ink = find_pen(view);
  cv::Mat& mask = pen_ink.mask;
  SketchPhoto photo;
  const int ruled = pen_ink.coloured ? 0 : erase_ruled_lines(mask, pen_ink.strength, params.ruled_turn_deg);
  if (ruled > 0)
    photo.warnings.push_back("The paper is ruled: " + std::to_string(ruled) + " printed lines were left out.");
  drop_small_figures(mask, params.min_stroke_share * side, params.text_share * side);
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the drawing was cancelled");
  progress.tell(0.5, "lines");
  if (cv::countNonZero(mask) == 0) return fail(Errc::kDegenerate, "nothing drawn was found in the photograph");
  if (cv::countNonZero(mask) > 0.3 * static_cast<double>(mask.total()))
    return fail(Errc::kDegenerate, "the photograph shows no line drawing");
  const auto branches = trace_skeleton(mask, 0.4 * params.min_stroke_share * side);
  const double pen = pen_width(mask, branches);
  auto lines = straightened(branches, params.simplify_pens * pen);
  const std::size_t before = lines.size();
  lines = without_hatching(std::move(lines), 0.05 * side);
  if (lines.size() < before)
    photo.warnings.push_back("Hatching and steps were left out: " + std::to_string(before - lines.size()) + " lines.");
  std::erase_if(lines, [&](const std::vector<Point2>& line) {
    return polyline_length(line) < 0.5 * params.min_stroke_share * side;
  });
  if (lines.empty()) return fail(Errc::kDegenerate, "nothing drawn was found in the photograph");
  photo.width_px = bgr->cols;
  photo.height_px = bgr->rows;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Stroke stroke;
    stroke.id = "photo-" + std::to_string(i);
    stroke.width_px = std::max(1.0, pen / work.scale);
    for (const auto& p : lines[i]) stroke.points_px.push_back((p + Point2(0.5, 0.5)) / work.scale - Point2(0.5, 0.5));
    photo.strokes.push_back(std::move(stroke));
  }
  progress.tell(1, "done");
  return photo;
}

}  // namespace

Result<SketchPhoto> read_sketch_photo(const cv::Mat& picture_bgr, const SketchPhotoParams& params,
                                      const Progress& progress) {
  try {
    return read_drawing(picture_bgr, params, progress);
  } catch (const cv::Exception& e) {
    return fail(Errc::kDegenerate, "the photograph could not be processed: " + std::string(e.what()));
  }
}

}  // namespace smokemap
