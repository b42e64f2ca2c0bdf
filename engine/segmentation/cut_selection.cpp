// A door is a place that is narrower than the space behind it on both sides, measured in the direction of its wall: at
// the mouth of a corridor one side is as wide as the opening, and across a corridor both are. Chosen one after another,
// the clearest first, a closed door is a wall for those that follow. A line across a corridor may look like a door
// while the doors beside it are open; once they are closed it does not, and is taken back.
#include "segmentation/cut_selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <utility>

#include "segmentation/thickness.hpp"

namespace smokemap {
namespace {

constexpr double kClearDoor = 0.35;      ///< of the space on both sides: surely a door
constexpr double kLeastDoorShare = 0.2;  ///< of all narrow places, for a map to be one that shows doors
constexpr size_t kLeastDoors = 3;
constexpr double kWideDoor = 4;          ///< usual doors; a wider opening must be the narrower compared with its rooms
constexpr double kLeastWideShare = 0.4;  ///< but no narrower than this
constexpr int kRounds = 3;
constexpr double kReach = 5;  ///< lengths of a cut within which others change its cost

class CutChooser {
 public:
  CutChooser(const std::vector<Cut>& candidates, const cv::Mat& structure, double least_area,
             const SegmentationParams& params)
      : candidates_(candidates),
        params_(params),
        structure_(structure),
        mask_(structure.clone()),
        clearance_(clearance_image(structure)),
        seen_(structure.size(), CV_32SC1, cv::Scalar(0)),
        least_area_(least_area) {}

  CutChoice choose() {
    add(false);
    find_doors();
    for (int round = 0; take_back() && round < kRounds; ++round) add(false);
    take_back();
    find_doors();
    clearance_ = clearance_image(mask_);
    add(true);
    take_back();
    return {std::move(chosen_), has_doors_};
  }

 private:
  double door_cost(const Cut& cut) const {
    const CutSides sides = look_beside(mask_, clearance_, cut);
    const double narrower = std::min(sides.extent_px[0], sides.extent_px[1]);
    if (narrower <= 0) return std::numeric_limits<double>::infinity();
    double allowed = params_.door_ratio + params_.door_support * cut.support;
    if (door_width_ > 0 && cut.length_px > kWideDoor * door_width_)
      allowed *= std::max(kLeastWideShare, kWideDoor * door_width_ / cut.length_px);
    return cut.length_px / narrower / allowed;
  }

  double mouth_cost(const Cut& cut) const {
    const CutSides sides = look_beside(mask_, clearance_, cut);
    if (std::min(sides.clearance_px[0], sides.clearance_px[1]) <= 0) return std::numeric_limits<double>::infinity();
    const double wider = std::max(sides.clearance_px[0], sides.clearance_px[1]);
    const BoundaryStyle& style = has_doors_ ? params_.with_doors : params_.without_doors;
    return 0.5 * cut.length_px / wider / (style.mouth_ratio + style.mouth_support * cut.support);
  }

  double cost(const Cut& cut, bool as_mouth) const { return as_mouth ? mouth_cost(cut) : door_cost(cut); }

  /// Cheapest first. What is chosen makes the rest no cheaper, so an outdated entry only goes back into the queue.
  void add(bool as_mouth) {
    using Entry = std::pair<double, size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (size_t i = 0; i < candidates_.size(); ++i)
      if (const double now = cost(candidates_[i], as_mouth); now < 1) queue.push({now, i});
    while (!queue.empty()) {
      const auto [known, i] = queue.top();
      queue.pop();
      const Cut& cut = candidates_[i];
      if (!is_clear(cut)) continue;
      const double now = cost(cut, as_mouth);
      if (now >= 1) continue;
      if (now > known + 1e-9) {
        queue.push({now, i});
        continue;
      }
      if (cuts_off_a_niche(cut)) continue;
      draw_cut(cut, mask_);
      chosen_.push_back({cut, as_mouth, now});
    }
  }

  /// Takes back what no longer looks like a boundary among the others, the worst first. What these stood in the way of
  /// may be added then.
  bool take_back() {
    const size_t before = chosen_.size();
    for (ChosenCut& chosen : chosen_) chosen.cost = cost(chosen.cut, chosen.is_mouth);
    while (!chosen_.empty()) {
      const auto worst =
          std::max_element(chosen_.begin(), chosen_.end(),
                           [](const ChosenCut& one, const ChosenCut& two) { return one.cost < two.cost; });
      if (worst->cost < 1) break;
      const Cut gone = worst->cut;
      chosen_.erase(worst);
      erase(gone);
      const cv::Point2d middle = 0.5 * cv::Point2d(gone.a + gone.b);
      for (ChosenCut& chosen : chosen_) {
        const cv::Point2d own = 0.5 * cv::Point2d(chosen.cut.a + chosen.cut.b);
        if (cv::norm(own - middle) <= kReach * chosen.cut.length_px + gone.length_px)
          chosen.cost = cost(chosen.cut, chosen.is_mouth);
      }
    }
    return chosen_.size() < before;
  }

  void erase(const Cut& gone) {
    cv::LineIterator pixel(mask_, gone.a, gone.b, 8);
    for (int i = 0; i < pixel.count; ++i, ++pixel) **pixel = structure_.at<unsigned char>(pixel.pos());
    const cv::Rect box(gone.a, gone.b);
    for (const ChosenCut& chosen : chosen_) {
      const cv::Rect other(chosen.cut.a, chosen.cut.b);
      const bool apart = other.x > box.x + box.width + 1 || box.x > other.x + other.width + 1 ||
                         other.y > box.y + box.height + 1 || box.y > other.y + other.height + 1;
      if (!apart) draw_cut(chosen.cut, mask_);
    }
  }

  void find_doors() {
    std::vector<double> widths;
    for (const ChosenCut& chosen : chosen_) {
      const CutSides sides = look_beside(mask_, clearance_, chosen.cut);
      if (chosen.cut.length_px < kClearDoor * std::min(sides.extent_px[0], sides.extent_px[1]))
        widths.push_back(chosen.cut.length_px);
    }
    has_doors_ = widths.size() >= kLeastDoors &&
                 static_cast<double>(widths.size()) > kLeastDoorShare * static_cast<double>(chosen_.size());
    door_width_ = 0;
    if (!has_doors_) return;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    door_width_ = *middle;
  }

  /// No cut chosen before crosses it.
  bool is_clear(const Cut& cut) const {
    cv::LineIterator pixel(mask_, cut.a, cut.b, 8);
    for (int i = 0; i < pixel.count; ++i, ++pixel)
      if (i > 0 && i + 1 < pixel.count && **pixel != 255) return false;
    return true;
  }

  /// What lies behind it on one side is too shallow, or too small, for a room.
  bool cuts_off_a_niche(const Cut& cut) {
    std::vector<std::pair<cv::Point, unsigned char>> covered;
    cv::LineIterator pixel(mask_, cut.a, cut.b, 8);
    for (int i = 0; i < pixel.count; ++i, ++pixel) {
      covered.emplace_back(pixel.pos(), **pixel);
      **pixel = 0;
    }
    const double least = std::max(params_.niche_depth * cut.length_px * cut.length_px, least_area_);
    const cv::Point2d along = cv::Point2d(cut.b - cut.a) * (1 / cut.length_px), across(-along.y, along.x);
    const bool is_niche = !has_room(cut, across, least) || !has_room(cut, -across, least);
    for (const auto& [p, value] : covered) mask_.at<unsigned char>(p) = value;
    return is_niche;
  }

  bool has_room(const Cut& cut, const cv::Point2d& away, double least) {
    const cv::Point2d middle = 0.5 * cv::Point2d(cut.a + cut.b);
    for (double way = 1; way <= 3; way += 0.5) {
      const cv::Point2d at = middle + way * away;
      const cv::Point seed(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)));
      if (mask_.at<unsigned char>(seed) == 255) return fills(seed, least);
    }
    return false;
  }

  /// True if at least `least` pixels can be reached from `seed`; looks at no more.
  bool fills(const cv::Point& seed, double least) {
    ++stamp_;
    stack_.assign(1, seed);
    seen_.at<int>(seed) = stamp_;
    double area = 0;
    while (!stack_.empty()) {
      const cv::Point p = stack_.back();
      stack_.pop_back();
      if (++area >= least) return true;
      for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(0, -1)}) {
        const cv::Point n = p + step;
        if (mask_.at<unsigned char>(n) != 255 || seen_.at<int>(n) == stamp_) continue;
        seen_.at<int>(n) = stamp_;
        stack_.push_back(n);
      }
    }
    return false;
  }

  const std::vector<Cut>& candidates_;
  const SegmentationParams& params_;
  const cv::Mat& structure_;
  cv::Mat mask_;       ///< structure with the chosen cuts as walls
  cv::Mat clearance_;  ///< doors may be closed in it
  cv::Mat seen_;       ///< stamp of the last fill that came there
  int stamp_ = 0;
  double least_area_;
  std::vector<cv::Point> stack_;
  std::vector<ChosenCut> chosen_;
  bool has_doors_ = false;
  double door_width_ = 0;  ///< median of the clear ones; 0 = unknown
};

}  // namespace

CutChoice choose_cuts(const std::vector<Cut>& candidates, const cv::Mat& structure, double least_area_px,
                      const SegmentationParams& params) {
  return CutChooser(candidates, structure, least_area_px, params).choose();
}

void draw_cut(const Cut& cut, cv::Mat& mask) { cv::line(mask, cut.a, cut.b, cv::Scalar(0), 1, cv::LINE_8); }

}  // namespace smokemap
