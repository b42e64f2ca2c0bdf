#include "sketch/read_sketch_photo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "grids/paper_view.hpp"
#include "sketch/drawing_lines.hpp"
#include "sketch/figures.hpp"
#include "sketch/hatching.hpp"
#include "sketch/pen.hpp"
#include "sketch/skeleton.hpp"

namespace smokemap {
namespace {

/// Width of the pen along every branch: twice the median distance from its middle to its edge.
std::vector<double> pen_widths(const cv::Mat& mask, const std::vector<SkeletonBranch>& branches) {
  cv::Mat distance;
  cv::distanceTransform(mask, distance, cv::DIST_L2, cv::DIST_MASK_5);
  std::vector<double> widths;
  for (const auto& b : branches) {
    std::vector<float> along;
    for (const auto& p : b.points) along.push_back(distance.at<float>(p));
    const auto nth = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), nth, along.end());
    widths.push_back(std::max(1.0, 2.0 * static_cast<double>(*nth) - 1.0));
  }
  return widths;
}

/// Of all that was drawn, longer lines counting more.
double usual_width(const std::vector<SkeletonBranch>& branches, const std::vector<double>& widths) {
  std::vector<double> all;
  for (std::size_t i = 0; i < branches.size(); ++i) all.insert(all.end(), branches[i].points.size(), widths[i]);
  if (all.empty()) return 1;
  const auto nth = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), nth, all.end());
  return *nth;
}

void add_strokes(const std::vector<Polyline>& lines, StrokeKind kind, double width_px, double scale,
                 SketchPhoto& photo) {
  for (const Polyline& line : lines) {
    Stroke stroke;
    stroke.id = "photo-" + std::to_string(photo.strokes.size());
    stroke.kind = kind;
    stroke.width_px = width_px;
    for (const auto& p : line) stroke.points_px.push_back((p + Point2(0.5, 0.5)) / scale - Point2(0.5, 0.5));
    photo.strokes.push_back(std::move(stroke));
  }
}

/// Lines that clean_sketch() knows filled areas by.
std::vector<Polyline> lines_across(const std::vector<Hatching>& areas) {
  std::vector<Polyline> lines;
  for (const Hatching& area : areas)
    for (const Segment2& line : hatching_lines(area)) lines.push_back({line.a, line.b});
  return lines;
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
  drop_rows_of_letters(mask);
  const std::vector<Hatching> hatched = find_hatched_ink(mask);
  outline_hatched_ink(hatched, std::max(3, static_cast<int>(0.003 * side)), mask);
  if (progress.cancelled()) return fail(Errc::kCancelled, "reading the drawing was cancelled");
  progress.tell(0.5, "lines");
  if (cv::countNonZero(mask) == 0) return fail(Errc::kDegenerate, "nothing drawn was found in the photograph");
  if (cv::countNonZero(mask) > 0.3 * static_cast<double>(mask.total()))
    return fail(Errc::kDegenerate, "the photograph shows no line drawing");
  auto branches = trace_skeleton(mask, 0.4 * params.min_stroke_share * side);
  if (const std::size_t words = drop_words(mask, branches); words > 0)
    photo.warnings.push_back("Writing was left out: " + std::to_string(words) + (words == 1 ? " word." : " words."));
  // Short pieces between two junctions are parts of walls that hatching touches; only loose ones are hairs.
  std::erase_if(branches, [&](const SkeletonBranch& b) {
    return (b.free_a || b.free_b) && static_cast<double>(b.points.size()) < params.hair_share * side;
  });
  const std::vector<double> widths = pen_widths(mask, branches);
  const double pen = usual_width(branches, widths);
  auto lines = straightened(branches, params.simplify_pens * pen);
  std::vector<Polyline> left_out;
  lines = without_hatching(std::move(lines), widths, 0.05 * side, &left_out);
  if (!left_out.empty())
    photo.warnings.push_back("Hatching and steps were left out: " + std::to_string(left_out.size()) + " lines.");
  if (!hatched.empty())
    photo.warnings.push_back(std::to_string(hatched.size()) + (hatched.size() == 1
                                                                   ? " hatched area is taken as filled."
                                                                   : " hatched areas are taken as filled."));
  if (lines.empty()) return fail(Errc::kDegenerate, "nothing drawn was found in the photograph");
  photo.width_px = bgr->cols;
  photo.height_px = bgr->rows;
  const double pen_px = std::max(1.0, pen / work.scale);
  add_strokes(lines, StrokeKind::kWall, pen_px, work.scale, photo);
  add_strokes(left_out, StrokeKind::kNote, pen_px, work.scale, photo);
  add_strokes(lines_across(hatched), StrokeKind::kNote, pen_px, work.scale, photo);
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
