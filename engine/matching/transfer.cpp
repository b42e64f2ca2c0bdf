#include "matching/transfer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "matching/group_map.hpp"
#include "matching/raster.hpp"
#include "matching/region_groups.hpp"

namespace smokemap {
namespace {

constexpr int kReach_px = 10;  ///< a point on a wall is taken as the nearest free pixel this near
constexpr int kWallDirection_cells = 72;

/// The label at a point or at the nearest free pixel, which the point is moved to.
int label_at(const cv::Mat& labels, Point2& p_px) {
  const int cx = static_cast<int>(std::lround(p_px.x())), cy = static_cast<int>(std::lround(p_px.y()));
  const auto label = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < labels.cols && y < labels.rows;
    return inside ? static_cast<int>(labels.at<unsigned short>(y, x)) : 0;
  };
  if (label(cx, cy) != 0) return label(cx, cy);
  int best = kReach_px * kReach_px + 1, found = 0;
  cv::Point at(cx, cy);
  for (int y = cy - kReach_px; y <= cy + kReach_px; ++y)
    for (int x = cx - kReach_px; x <= cx + kReach_px; ++x) {
      const int squared = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      if (squared < best && label(x, y) != 0) best = squared, found = label(x, y), at = {x, y};
    }
  if (found != 0) p_px = Point2(at.x, at.y);
  return found;
}

struct Door {
  int group_one = 0, group_two = 0;  ///< group_one < group_two
  Point2 middle_px = Point2::Zero();
};

std::vector<Door> doors_between(const Segmentation& map, const std::map<int, int>& group_of) {
  std::vector<Door> doors;
  for (const RegionBorder& border : map.borders) {
    const auto one = group_of.find(border.label_a), two = group_of.find(border.label_b);
    if (one == group_of.end() || two == group_of.end() || one->second == two->second) continue;
    const auto [low, high] = std::minmax(one->second, two->second);
    doors.push_back({low, high, border.line_px.midpoint()});
  }
  return doors;
}

struct Direction {
  cv::Mat from, to;
  std::map<int, int> group_of_from, group_of_to;
  std::vector<GroupMap> maps;
  std::vector<std::vector<cv::Point>> rims;
  std::vector<double> confidence;

  Transferred carry(Point2 p) const {
    Transferred result;
    const int label = label_at(from, p);
    if (label == 0) {
      result.reason = "the point is not in free space";
      return result;
    }
    const auto group = group_of_from.find(label);
    if (group == group_of_from.end()) {
      result.reason = "the room around the point has no partner on the other map";
      return result;
    }
    const auto g = static_cast<size_t>(group->second);
    const Point2 raw = maps[g](p);
    const Point2 put = inside(raw, group->second);
    result.p = put;
    result.sigma = std::hypot(maps[g].sigma(p), 0.5 * (put - raw).norm());
    result.confidence = confidence[g];
    return result;
  }

  /// The point itself if it lies in the group, else the nearest point of the group.
  Point2 inside(const Point2& p, int group) const {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (x >= 0 && y >= 0 && x < to.cols && y < to.rows) {
      const auto there = group_of_to.find(to.at<unsigned short>(y, x));
      if (there != group_of_to.end() && there->second == group) return p;
    }
    const std::vector<cv::Point>& rim = rims[static_cast<size_t>(group)];
    const cv::Point nearest =
        *std::min_element(rim.begin(), rim.end(), [&](const cv::Point& one, const cv::Point& two) {
          return (Point2(one.x, one.y) - p).squaredNorm() < (Point2(two.x, two.y) - p).squaredNorm();
        });
    return Point2(nearest.x, nearest.y);
  }
};

std::vector<int> as_list(const std::map<int, int>& group_of, const Segmentation& map) {
  std::vector<int> list(map.regions.size() + 1, -1);
  for (const auto& [label, group] : group_of) list[static_cast<size_t>(label)] = group;
  return list;
}

Handle turned_round(const Handle& handle) { return {handle.p_to, handle.p_from, handle.is_pin}; }

/// Doors of a with the door of b between the same groups that lies nearest to where the boxes put them.
void add_doors(const std::vector<Door>& doors_a, const std::vector<Door>& doors_b, const std::vector<GroupMap>& plain,
               std::vector<std::vector<Handle>>& handles) {
  std::vector<bool> used(doors_b.size(), false);
  for (const Door& door : doors_a) {
    const Point2 guess = 0.5 * (plain[static_cast<size_t>(door.group_one)](door.middle_px) +
                                plain[static_cast<size_t>(door.group_two)](door.middle_px));
    std::optional<size_t> best;
    for (size_t k = 0; k < doors_b.size(); ++k) {
      if (used[k] || doors_b[k].group_one != door.group_one || doors_b[k].group_two != door.group_two) continue;
      if (!best || (doors_b[k].middle_px - guess).norm() < (doors_b[*best].middle_px - guess).norm()) best = k;
    }
    if (!best) continue;
    used[*best] = true;
    for (const int group : {door.group_one, door.group_two})
      handles[static_cast<size_t>(group)].push_back({door.middle_px, doors_b[*best].middle_px, false});
  }
}

}  // namespace

struct PointTransfer::Tables {
  Direction forward, backward;
};

PointTransfer::PointTransfer(const Segmentation& a, const Segmentation& b, const Matching& matching,
                             const std::vector<Pin>& pins) {
  const std::vector<RegionGroup> groups = group_pairs(matching.pairs);
  auto tables = std::make_shared<Tables>();
  Direction& forward = tables->forward;
  Direction& backward = tables->backward;
  forward.from = backward.to = a.labels.clone();
  forward.to = backward.from = b.labels.clone();
  const double along_walls = make_raster(b, kWallDirection_cells, 4).wall_direction_rad;
  const Eigen::Matrix2d frame_b = Eigen::Rotation2Dd(-along_walls).toRotationMatrix();
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const int label : groups[g].labels_a) forward.group_of_from[label] = static_cast<int>(g);
    for (const int label : groups[g].labels_b) forward.group_of_to[label] = static_cast<int>(g);
  }
  const std::vector<GroupSide> sides_a =
      make_sides(a.labels, as_list(forward.group_of_from, a), groups.size(), frame_b * matching.turn_b_a);
  const std::vector<GroupSide> sides_b = make_sides(b.labels, as_list(forward.group_of_to, b), groups.size(), frame_b);
  std::vector<GroupMap> plain;
  for (size_t g = 0; g < groups.size(); ++g) plain.emplace_back(sides_a[g], sides_b[g], std::vector<Handle>{});
  std::vector<std::vector<Handle>> handles(groups.size());
  add_doors(doors_between(a, forward.group_of_from), doors_between(b, forward.group_of_to), plain, handles);
  for (const Pin& pin : pins) {
    Point2 p_a = pin.p_a_px, p_b = pin.p_b_px;
    const auto group_a = forward.group_of_from.find(label_at(a.labels, p_a));
    const auto group_b = forward.group_of_to.find(label_at(b.labels, p_b));
    if (group_a != forward.group_of_from.end() && group_b != forward.group_of_to.end() &&
        group_a->second == group_b->second)
      handles[static_cast<size_t>(group_a->second)].push_back({p_a, p_b, true});
  }
  backward.group_of_from = forward.group_of_to;
  backward.group_of_to = forward.group_of_from;
  for (size_t g = 0; g < groups.size(); ++g) {
    std::vector<Handle> back;
    for (const Handle& handle : handles[g]) back.push_back(turned_round(handle));
    forward.maps.emplace_back(sides_a[g], sides_b[g], handles[g]);
    backward.maps.emplace_back(sides_b[g], sides_a[g], back);
    forward.rims.push_back(sides_b[g].rim);
    backward.rims.push_back(sides_a[g].rim);
    forward.confidence.push_back(groups[g].confidence);
    backward.confidence.push_back(groups[g].confidence);
  }
  tables_ = std::move(tables);
}

Transferred PointTransfer::operator()(const Point2& p_a_px) const { return tables_->forward.carry(p_a_px); }

Transferred PointTransfer::inverse(const Point2& p_b_px) const { return tables_->backward.carry(p_b_px); }

}  // namespace smokemap
