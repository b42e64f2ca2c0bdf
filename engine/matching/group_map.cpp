#include "matching/group_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace smokemap {
namespace {

constexpr double kRoomShare = 0.15;  ///< error of a point well inside a matched room, as a share of its diagonal
constexpr double kPinShare = 0.06;   ///< error right at a pin
constexpr double kPullReach = 0.45;  ///< how far a handle pulls, in roots of the area

}  // namespace

std::vector<GroupSide> make_sides(const cv::Mat& labels, const std::vector<int>& group_of_label, size_t groups,
                                  const Eigen::Matrix2d& frame) {
  GroupSide empty;
  empty.frame = frame;
  empty.low = Point2::Constant(std::numeric_limits<double>::infinity());
  empty.high = -empty.low;
  std::vector<GroupSide> sides(groups, empty);
  // A frame of no group around the picture spares every pixel the question whether its neighbour is in the picture.
  cv::Mat group_of(labels.rows + 2, labels.cols + 2, CV_32SC1, cv::Scalar(-1));
  for (int y = 0; y < labels.rows; ++y) {
    const auto* label = labels.ptr<unsigned short>(y);
    int* group = group_of.ptr<int>(y + 1) + 1;
    for (int x = 0; x < labels.cols; ++x) group[x] = group_of_label[label[x]];
  }
  for (int y = 0; y < labels.rows; ++y) {
    const int *above = group_of.ptr<int>(y) + 1, *here = group_of.ptr<int>(y + 1) + 1,
              *below = group_of.ptr<int>(y + 2) + 1;
    for (int x = 0; x < labels.cols; ++x) {
      const int group = here[x];
      if (group < 0) continue;
      GroupSide& side = sides[static_cast<size_t>(group)];
      side.area_px += 1;
      if (here[x - 1] == group && here[x + 1] == group && above[x] == group && below[x] == group) continue;
      side.rim.emplace_back(x, y);
      const Point2 p = frame * Point2(x, y);
      side.low = side.low.cwiseMin(p);
      side.high = side.high.cwiseMax(p);
    }
  }
  return sides;
}

GroupMap::GroupMap(const GroupSide& from, const GroupSide& to, std::vector<Handle> handles)
    : from_(from), to_(to), handles_(std::move(handles)) {
  for (const Handle& handle : handles_) pulls_.push_back(handle.p_to - in_box(handle.p_from));
}

Point2 GroupMap::in_box(const Point2& p_from) const {
  const Point2 share = (from_.frame * p_from - from_.low).cwiseQuotient((from_.high - from_.low).cwiseMax(1.0));
  return to_.frame.transpose() * (to_.low + share.cwiseProduct(to_.high - to_.low));
}

Point2 GroupMap::operator()(const Point2& p_from) const {
  const double reach = std::max(1.0, kPullReach * std::sqrt(from_.area_px));
  Point2 pull = Point2::Zero();
  double total = 1 / (reach * reach);  // the box itself, everywhere alike
  for (size_t k = 0; k < handles_.size(); ++k) {
    const double squared = (p_from - handles_[k].p_from).squaredNorm();
    if (squared < 1e-12) return handles_[k].p_to;
    total += 1 / squared;
    pull += pulls_[k] / squared;
  }
  return in_box(p_from) + pull / total;
}

double GroupMap::sigma(const Point2& p_from) const {
  double share = kRoomShare;
  const double reach = std::max(1.0, std::sqrt(from_.area_px));
  for (const Handle& handle : handles_) {
    if (!handle.is_pin) continue;
    const double distance = std::min(1.0, (p_from - handle.p_from).norm() / reach);
    share = std::min(share, kPinShare + (kRoomShare - kPinShare) * distance);
  }
  return share * std::max(1.0, to_.diagonal());
}

}  // namespace smokemap
