#pragma once

#include <memory>
#include <optional>

#include "core/progress.hpp"
#include "layout/layout_raster.hpp"
#include "matching/match.hpp"
#include "matching/transfer.hpp"
#include "segmentation/segment.hpp"
#include "session/snapshot.hpp"
#include "session/whiteboard.hpp"
#include "sketch/clean_sketch.hpp"

namespace smokemap {

/// What the sketch is matched against; read once a plan.
struct PlanRegions {
  Segmentation segmentation;  ///< of the plan's free space, scaled
  double pixels_per_layout_px = 1;
  std::vector<RegionView> views;  ///< layout_px
};

/// What one reading of the sketch gives.
struct SketchReading {
  std::shared_ptr<const SketchView> sketch;
  std::shared_ptr<const MatchView> match;        ///< null without plan or regions
  std::shared_ptr<const PointTransfer> to_plan;  ///< null likewise
  double pixels_per_layout_px = 1;
  std::string no_transfer;  ///< why there is none, for people
};

/// Sketch and plan -> regions, correspondences and the way for points. Slow (up to half a second): runs beside the
/// engine. Keeps the plan's regions between calls.
class SketchReader {
 public:
  SketchReading read(const SketchMap& sketch, const std::shared_ptr<const LayoutView>& layout,
                     const std::vector<PairVerdict>& verdicts);

 private:
  const PlanRegions* plan_regions(const std::shared_ptr<const LayoutView>& layout);

  std::shared_ptr<const LayoutView> layout_;
  std::optional<PlanRegions> plan_;
};

/// The label of the region at a pixel, or of the nearest one within `reach_px`; 0 if there is none.
int label_at(const Segmentation& segmentation, const Point2& p_px, int reach_px);

}  // namespace smokemap
