#include "sketch/skeleton.hpp"

#include <algorithm>
#include <array>
#include <opencv2/ximgproc.hpp>

namespace smokemap {
namespace {

constexpr std::array<std::array<int, 2>, 8> kAround{
    {{0, -1}, {1, 0}, {0, 1}, {-1, 0}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};

class SkeletonWalker {
 public:
  explicit SkeletonWalker(cv::Mat thin)
      : thin_(std::move(thin)),
        node_(cv::Mat::zeros(thin_.size(), CV_8UC1)),
        done_(cv::Mat::zeros(thin_.size(), CV_8UC1)) {
    for (int y = 0; y < thin_.rows; ++y)
      for (int x = 0; x < thin_.cols; ++x)
        if (on({x, y}) && degree({x, y}) != 2) node_.at<uchar>(y, x) = 1;
  }

  std::vector<SkeletonBranch> walk() {
    for (int y = 0; y < thin_.rows; ++y)
      for (int x = 0; x < thin_.cols; ++x)
        if (node_.at<uchar>(y, x)) leave_node({x, y});
    for (int y = 0; y < thin_.rows; ++y)
      for (int x = 0; x < thin_.cols; ++x)
        if (on({x, y}) && !node_.at<uchar>(y, x) && !done_.at<uchar>(y, x)) loop({x, y});
    return std::move(branches_);
  }

 private:
  bool on(cv::Point p) const {
    return p.x >= 0 && p.y >= 0 && p.x < thin_.cols && p.y < thin_.rows && thin_.at<uchar>(p);
  }
  /// Neighbours, diagonal ones only where no straight neighbour joins them already.
  std::vector<cv::Point> neighbours(cv::Point p) const {
    std::vector<cv::Point> out;
    for (const auto& d : kAround) {
      const cv::Point q(p.x + d[0], p.y + d[1]);
      if (!on(q)) continue;
      if (d[0] != 0 && d[1] != 0 && (on({p.x + d[0], p.y}) || on({p.x, p.y + d[1]}))) continue;
      out.push_back(q);
    }
    return out;
  }
  int degree(cv::Point p) const { return static_cast<int>(neighbours(p).size()); }

  void leave_node(cv::Point start) {
    for (const auto& first : neighbours(start)) {
      if (node_.at<uchar>(first)) {
        if (start.y < first.y || (start.y == first.y && start.x < first.x)) store({start, first});
        continue;
      }
      if (!done_.at<uchar>(first)) follow(start, first);
    }
  }
  void follow(cv::Point start, cv::Point next) {
    std::vector<cv::Point> path{start};
    cv::Point before = start;
    while (true) {
      path.push_back(next);
      if (node_.at<uchar>(next)) break;
      done_.at<uchar>(next) = 1;
      cv::Point onward(-1, -1);
      for (const auto& q : neighbours(next))
        if (q != before && !done_.at<uchar>(q)) onward = q;
      for (const auto& q : neighbours(next))
        if (q != before && node_.at<uchar>(q)) onward = q;
      if (onward.x < 0) break;
      before = next;
      next = onward;
    }
    store(std::move(path));
  }
  void loop(cv::Point start) {
    std::vector<cv::Point> path{start};
    done_.at<uchar>(start) = 1;
    for (bool going = true; going;) {
      going = false;
      for (const auto& q : neighbours(path.back())) {
        if (done_.at<uchar>(q) || node_.at<uchar>(q)) continue;
        path.push_back(q);
        done_.at<uchar>(q) = 1;
        going = true;
        break;
      }
    }
    path.push_back(start);
    store(std::move(path));
  }
  void store(std::vector<cv::Point> path) {
    SkeletonBranch branch;
    branch.free_a = degree(path.front()) <= 1;
    branch.free_b = degree(path.back()) <= 1;
    branch.points = std::move(path);
    branches_.push_back(std::move(branch));
  }

  cv::Mat thin_, node_, done_;
  std::vector<SkeletonBranch> branches_;
};

}  // namespace

std::vector<SkeletonBranch> trace_skeleton(const cv::Mat& mask, double min_branch_px) {
  cv::Mat thin;
  cv::ximgproc::thinning(mask, thin, cv::ximgproc::THINNING_GUOHALL);
  auto branches = SkeletonWalker(thin).walk();
  std::erase_if(branches, [&](const SkeletonBranch& b) {
    return (b.free_a != b.free_b) && static_cast<double>(b.points.size()) < min_branch_px;
  });
  return branches;
}

}  // namespace smokemap
