#include "session/carrier.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kTapSigmaM = 0.15;  // a gloved finger, and what was meant by it

Transferred nowhere(std::string reason) {
  Transferred t;
  t.reason = std::move(reason);
  return t;
}

/// Confidence that a point carried over the plan is in the right room, from how well the plan fits.
double plan_confidence(const PlanFit& fit) {
  if (fit.verdict == "fits") return 0.95;
  if (fit.verdict == "doubtful") return 0.6;
  if (fit.verdict == "unknown") return 0.7;
  return 0.2;
}

}  // namespace

Transferred Carrier::to_map(const Place& place) const {
  switch (place.frame) {
    case PlaceFrame::kMap: {
      if (place.revision == kEarlierMap) return nowhere("it was placed on a robot's map of before the restart");
      Transferred t;
      t.p = place.p, t.sigma = kTapSigmaM, t.confidence = 1;
      return t;
    }
    case PlaceFrame::kLayoutPx:
      return from_layout(place.p, place.revision);
    case PlaceFrame::kSketchPx:
      return from_sketch(place.p);
  }
  return nowhere("unknown kind of place");
}

Transferred Carrier::from_layout(const Point2& p_px, int frame_revision) const {
  if (!board_.layout) return nowhere("there is no plan");
  if (frame_revision != board_.revisions.layout_frame) return nowhere("it was placed on an earlier plan");
  if (merged_.corners.empty()) return nowhere("the plan is not aligned with the robot's map yet");
  const Point2 p_layout = board_.layout->layout.frame().to_metres(p_px);
  Transferred t;
  t.p = merged_.layout_to_map(p_layout);
  t.sigma = std::hypot(merged_.layout_to_map.sigma_m(p_layout), kTapSigmaM);
  t.confidence = plan_confidence(merged_.fit);
  if (!plan_fits()) t.reason = "this plan does not seem to fit this building";
  return t;
}

Transferred Carrier::from_sketch(const Point2& p_px) const {
  if (!sketch_.to_plan)
    return nowhere(sketch_.no_transfer.empty() ? "the sketch was not read yet" : sketch_.no_transfer);
  const Transferred on_plan = (*sketch_.to_plan)(p_px);
  if (!on_plan.p) return on_plan;
  const double scale = sketch_.pixels_per_layout_px;
  Transferred t = from_layout(*on_plan.p / scale, board_.revisions.layout_frame);
  if (!t.p) return t;
  t.sigma = std::hypot(t.sigma, on_plan.sigma / scale * board_.layout->layout.frame().metres_per_pixel);
  t.confidence *= on_plan.confidence;
  if (!sketch_.match || !t.reason.empty()) return t;
  if (sketch_.match->matching.same_building < kFitsFrom)
    t.reason = "this sketch does not seem to show the building of the plan";
  else if (sketch_.match->matching.doubtful)
    t.reason = "the match of sketch and plan is doubtful";
  return t;
}

}  // namespace smokemap
