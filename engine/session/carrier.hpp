#pragma once

#include "session/sketch_reader.hpp"
#include "session/whiteboard.hpp"

namespace smokemap {

/// Revision of a place on a robot's map of an earlier run: that map is gone.
constexpr int kEarlierMap = -1;

/// Carries places from the map in which somebody pointed to `map`, with everything that is uncertain about it.
/// Holds references: make one, ask, throw it away.
class Carrier {
 public:
  Carrier(const Whiteboard& board, const MergedMap& merged, const SketchReading& sketch)
      : board_(board), merged_(merged), sketch_(sketch) {}

  /// sigma in metres. No place where the way is unknown, with the reason.
  Transferred to_map(const Place& place) const;
  bool plan_fits() const { return !merged_.fit.refuted(); }

 private:
  Transferred from_layout(const Point2& p_px, int frame_revision) const;
  Transferred from_sketch(const Point2& p_px) const;

  const Whiteboard& board_;
  const MergedMap& merged_;
  const SketchReading& sketch_;
};

}  // namespace smokemap
