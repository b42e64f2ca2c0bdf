#include "session/sketch_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "segmentation/constriction.hpp"
#include "segmentation/outline.hpp"

namespace smokemap {
namespace {

constexpr double kPlanLongSidePx = 1100;  // enough for rooms, quick enough for taps
constexpr int kTapReachPx = 12;
constexpr auto kNoFit = "This sketch does not seem to show the building of the plan. Tap two rooms that you know.";

std::vector<RegionView> views_of(const Segmentation& segmentation, double scale) {
  std::vector<RegionView> views;
  for (const Region& region : segmentation.regions) {
    RegionView view{region.label, region_outline(segmentation, region.label), region.kind};
    for (Point2& p : view.outline_px) p /= scale;
    if (view.outline_px.size() >= 3) views.push_back(std::move(view));
  }
  return views;
}

/// Verdicts by place -> verdicts by label, the latest word on a pair winning.
std::vector<RegionPair> by_label(const std::vector<PairVerdict>& verdicts, const Segmentation& sketch,
                                 const PlanRegions& plan) {
  std::map<std::pair<int, int>, Verdict> latest;
  for (const PairVerdict& verdict : verdicts) {
    const int a = label_at(sketch, verdict.p_sketch_px, kTapReachPx);
    const int b = label_at(plan.segmentation, verdict.p_layout_px * plan.pixels_per_layout_px, kTapReachPx);
    if (a > 0 && b > 0) latest[{a, b}] = verdict.verdict;
  }
  std::vector<RegionPair> pairs;
  for (const auto& [labels, verdict] : latest)
    if (verdict != Verdict::kProposed) pairs.push_back({labels.first, labels.second, 1.0, verdict});
  return pairs;
}

/// Confirmed places also bind as pins: what was tapped is the same spot, roughly.
std::vector<Pin> pins_of(const std::vector<PairVerdict>& verdicts, double scale) {
  std::vector<Pin> pins;
  for (const PairVerdict& verdict : verdicts)
    if (verdict.verdict == Verdict::kConfirmed) pins.push_back({verdict.p_sketch_px, verdict.p_layout_px * scale});
  return pins;
}

bool is_same_drawing(const SketchMap& one, const SketchMap& two) {
  return one.width_px == two.width_px && one.height_px == two.height_px &&
         std::equal(one.strokes.begin(), one.strokes.end(), two.strokes.begin(), two.strokes.end(),
                    [](const Stroke& a, const Stroke& b) {
                      return a.kind == b.kind && a.width_px == b.width_px && a.points_px == b.points_px;
                    });
}

SketchRegions read_regions(const SketchMap& sketch) {
  SketchRegions regions;
  regions.drawn = sketch;
  if (sketch.strokes.empty()) {
    regions.complaint = "nothing is drawn yet";
    return regions;
  }
  auto clean = clean_sketch(sketch, {});
  if (!clean) {
    regions.complaint = regions.warning = clean.error().message;
    return regions;
  }
  regions.gaps = std::move(clean->gaps);
  if (!clean->warnings.empty()) regions.warning = clean->warnings.front();
  auto segmentation = segment_by_constrictions(clean->free_space, matching_segmentation_params());
  if (!segmentation) {
    regions.complaint = regions.warning = segmentation.error().message;
    return regions;
  }
  regions.segmentation = std::move(*segmentation);
  regions.views = views_of(regions.segmentation, 1.0);
  return regions;
}

}  // namespace

int label_at(const Segmentation& segmentation, const Point2& p_px, int reach_px) {
  if (!p_px.allFinite()) return 0;
  const cv::Mat& labels = segmentation.labels;
  const double limit = 1e6;
  if (p_px.cwiseAbs().maxCoeff() > limit) return 0;
  const int cx = static_cast<int>(std::lround(p_px.x())), cy = static_cast<int>(std::lround(p_px.y()));
  int best = 0, best_squared = reach_px * reach_px + 1;
  for (int dy = -reach_px; dy <= reach_px; ++dy)
    for (int dx = -reach_px; dx <= reach_px; ++dx) {
      const int x = cx + dx, y = cy + dy, squared = dx * dx + dy * dy;
      if (x < 0 || y < 0 || x >= labels.cols || y >= labels.rows || squared >= best_squared) continue;
      if (const int label = labels.at<std::uint16_t>(y, x)) best = label, best_squared = squared;
    }
  return best;
}

const PlanRegions* SketchReader::plan_regions(const std::shared_ptr<const LayoutView>& layout) {
  if (layout == layout_) return plan_ ? &*plan_ : nullptr;
  layout_ = layout;
  plan_.reset();
  matcher_.reset();
  if (!layout) return nullptr;
  PlanRegions plan;
  plan.pixels_per_layout_px =
      std::min(1.0, kPlanLongSidePx / std::max(layout->layout.width_px, layout->layout.height_px));
  const auto free_space = layout_free_space(layout->layout, plan.pixels_per_layout_px);
  if (!free_space) return nullptr;
  auto segmentation = segment_by_constrictions(*free_space, matching_segmentation_params());
  if (!segmentation) return nullptr;
  plan.segmentation = std::move(*segmentation);
  plan.views = views_of(plan.segmentation, plan.pixels_per_layout_px);
  plan_ = std::move(plan);
  return &*plan_;
}

const SketchRegions& SketchReader::sketch_regions(const SketchMap& sketch) {
  if (!sketch_ || !is_same_drawing(sketch_->drawn, sketch)) {
    sketch_ = read_regions(sketch);
    matcher_.reset();
  }
  return *sketch_;
}

const Result<Matcher>& SketchReader::matcher() {
  if (!matcher_) matcher_ = Matcher::create(sketch_->segmentation, plan_->segmentation);
  return *matcher_;
}

SketchReading SketchReader::read(const SketchMap& sketch, const std::shared_ptr<const LayoutView>& layout,
                                 const std::vector<PairVerdict>& verdicts) {
  SketchReading reading;
  auto view = std::make_shared<SketchView>();
  reading.sketch = view;
  const PlanRegions* plan = plan_regions(layout);
  auto match_view = std::make_shared<MatchView>();
  if (plan) match_view->map_regions = plan->views, reading.match = match_view;
  const SketchRegions& regions = sketch_regions(sketch);
  view->sketch = sketch;
  view->regions = regions.views;
  view->gaps = regions.gaps;
  view->warning = regions.warning;
  const auto give_up = [&](const std::string& why) {
    view->warning = sketch.strokes.empty() ? "" : why;
    reading.no_transfer = why;
    return reading;
  };
  if (!regions.complaint.empty()) return give_up(regions.complaint);
  if (!plan) return give_up(layout ? "no rooms were found on the plan" : "there is no plan to match the sketch with");
  const Result<Matcher>& matched = matcher();
  if (!matched) return give_up(matched.error().message);
  const std::vector<Pin> pins = pins_of(verdicts, plan->pixels_per_layout_px);
  const auto matching = matched->solve(pins, by_label(verdicts, regions.segmentation, *plan));
  if (!matching) return give_up(matching.error().message);
  match_view->matching = *matching;
  if (matching->same_building < kFitsFrom) view->warning = kNoFit;
  reading.to_plan = std::make_shared<const PointTransfer>(regions.segmentation, plan->segmentation, *matching, pins);
  reading.pixels_per_layout_px = plan->pixels_per_layout_px;
  return reading;
}

}  // namespace smokemap
