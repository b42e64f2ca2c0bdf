#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <vector>

namespace smokemap {

/// The line along which two zones touch.
struct ZoneContact {
  int length = 0;  ///< pixel sides shared
  cv::Rect box;    ///< around the pixels that touch

  /// Straight width of the opening; for a closed ring it is that of the ring.
  double chord() const;
  void add(const cv::Point& pixel);
  void add(const ZoneContact& other);
};

struct Zone {
  double area = 0;
  double peak = 0;  ///< largest clearance in it, where clearances were given
  std::map<int, ZoneContact> contacts;
};

/// Zones of free space and who touches whom; shrinks by merging. Zone ids are those of the label image it was made
/// from.
class ZoneGraph {
 public:
  /// @param labels  CV_32SC1, 0 = not free, ids from 1
  /// @param clearance  CV_32FC1 of the same size, or empty
  explicit ZoneGraph(const cv::Mat& labels, const cv::Mat& clearance = {});

  const std::map<int, Zone>& zones() const { return zones_; }
  /// `from` becomes part of `into`; both must exist.
  void merge(int from, int into);
  /// The zone that the zone of the original image is part of now.
  int root(int id) const;
  /// Writes the present ids into a label image made like the original.
  void relabel(cv::Mat& labels) const;

 private:
  std::map<int, Zone> zones_;
  mutable std::vector<int> parent_;
};

}  // namespace smokemap
