#pragma once

#include <memory>
#include <vector>

#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"

namespace smokemap {

/// Carries points between two matched maps.
///
/// Inside a matched region the map is continuous and stays inside the partner region (or regions, for n:m); doors
/// between matched regions go to the doors of their partners, pins go exactly where the person said. A point in a
/// region without partner has no place on the other map and says why. Immutable after construction; copies share their
/// tables.
class PointTransfer {
 public:
  /// @param matching  of a and b, from match(); rejected pairs are ignored
  /// Cost: some milliseconds a pair of regions. The segmentations may go away afterwards.
  PointTransfer(const Segmentation& a, const Segmentation& b, const Matching& matching, const std::vector<Pin>& pins);

  /// @param p_a_px  pixels of map a; a point on a wall is taken as the nearest free pixel within 10 px
  /// @return pixels of map b, sigma in pixels of map b, confidence that it is the right room; or no place, with the
  /// reason.
  Transferred operator()(const Point2& p_a_px) const;
  /// The other way: pixels of map b to pixels of map a, sigma in pixels of map a.
  Transferred inverse(const Point2& p_b_px) const;

 private:
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

}  // namespace smokemap
