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

/// The drawing; read once, and again when somebody draws on.
struct SketchRegions {
  SketchMap drawn;
  std::vector<SketchGap> gaps;
  Segmentation segmentation;
  std::vector<RegionView> views;
  std::string warning;    ///< for people
  std::string complaint;  ///< why there are no regions, empty if there are
};

/// Sketch and plan -> regions, correspondences and the way for points. Slow (up to half a second) when the drawing or
/// the plan is new: runs beside the engine. Keeps the regions of both and what matching them needs, so that a tap is
/// answered in some tens of milliseconds.
class SketchReader {
 public:
  SketchReading read(const SketchMap& sketch, const std::shared_ptr<const LayoutView>& layout,
                     const std::vector<PairVerdict>& verdicts);

 private:
  const PlanRegions* plan_regions(const std::shared_ptr<const LayoutView>& layout);
  const SketchRegions& sketch_regions(const SketchMap& sketch);
  const Result<Matcher>& matcher();

  std::shared_ptr<const LayoutView> layout_;
  std::optional<PlanRegions> plan_;
  std::optional<SketchRegions> sketch_;
  std::optional<Result<Matcher>> matcher_;  ///< of sketch_ and plan_
};

/// The label of the region at a pixel, or of the nearest one within `reach_px`; 0 if there is none.
int label_at(const Segmentation& segmentation, const Point2& p_px, int reach_px);

}  // namespace smokemap
