#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "geometry/pose2.hpp"

namespace smokemap {

/// The pixels of one side of a group, in a frame whose axes run along the walls.
struct GroupSide {
  Eigen::Matrix2d frame = Eigen::Matrix2d::Identity();  ///< picture -> wall axes (turn or mirrored turn)
  Point2 low = Point2::Zero();                          ///< box in wall axes
  Point2 high = Point2::Zero();
  double area_px = 0;
  std::vector<cv::Point> rim;  ///< pixels beside others or walls: where a point outside is put

  double diagonal() const { return (high - low).norm(); }
};

/// The sides of all groups of one map.
/// @param labels          CV_16UC1
/// @param group_of_label  of each label, or -1; one entry for every label that occurs
std::vector<GroupSide> make_sides(const cv::Mat& labels, const std::vector<int>& group_of_label, size_t groups,
                                  const Eigen::Matrix2d& frame);

/// A place known on both maps: a door between two matched places, or a pin.
struct Handle {
  Point2 p_from = Point2::Zero();
  Point2 p_to = Point2::Zero();
  bool is_pin = false;
};

/// Carries points of one group from one map to the other: relative place in the box, then drawn towards the handles.
/// Exact at handles; continuous; may leave the region, which is the caller's to see to.
class GroupMap {
 public:
  GroupMap(const GroupSide& from, const GroupSide& to, std::vector<Handle> handles);
  Point2 operator()(const Point2& p_from) const;
  /// One standard deviation per coordinate, pixels of the target: a share of the room, less near pins.
  double sigma(const Point2& p_from) const;

 private:
  Point2 in_box(const Point2& p_from) const;

  GroupSide from_, to_;
  std::vector<Handle> handles_;
  std::vector<Point2> pulls_;  ///< what the box misses each handle by
};

}  // namespace smokemap
