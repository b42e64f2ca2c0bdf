#include "segmentation/straighten.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "segmentation/regions.hpp"

namespace smokemap {
namespace {

constexpr double kSlideReach = 1.2;  ///< how far the ends of a cut may slide along the walls, in widths of the contact
constexpr double kSlideCost = 0.3;   ///< widths of cut that a slide of one width must save
constexpr double kLeastSpan = 0.25;  ///< widths of the contact that a cut must span along it
constexpr size_t kMaxAttempts = 12;  ///< cuts tried for parting the two regions
constexpr size_t kMaxWallPixels = 120;  ///< of each end looked at; more are thinned out evenly
constexpr size_t kMaxTried = 4000;      ///< cuts looked at for a free line of sight, best first

struct StraightCut {
  cv::Point a, b;
  double cost = 0;
};

bool is_open(const cv::Mat& structure, const cv::Point& p) {
  return p.x >= 0 && p.y >= 0 && p.x < structure.cols && p.y < structure.rows && structure.at<unsigned char>(p) == 255;
}

/// Not-free pixels beside free ones around an end of a contact, at most `reach` away.
std::vector<cv::Point> wall_pixels_near(const cv::Mat& structure, const cv::Point& end, int reach) {
  std::vector<cv::Point> found;
  for (int y = end.y - reach; y <= end.y + reach; ++y)
    for (int x = end.x - reach; x <= end.x + reach; ++x) {
      const cv::Point p(x, y), offset = p - end;
      if (offset.dot(offset) > reach * reach || is_open(structure, p)) continue;
      const bool beside_free = is_open(structure, p + cv::Point(1, 0)) || is_open(structure, p + cv::Point(-1, 0)) ||
                               is_open(structure, p + cv::Point(0, 1)) || is_open(structure, p + cv::Point(0, -1));
      if (beside_free) found.push_back(p);
    }
  if (found.size() <= kMaxWallPixels) return found;
  std::vector<cv::Point> thinned;
  for (size_t i = 0; i < kMaxWallPixels; ++i) thinned.push_back(found[i * found.size() / kMaxWallPixels]);
  return thinned;
}

/// True if the line runs through free space, but for its ends, which lie on walls.
bool sees(const cv::Mat& structure, const cv::Point& a, const cv::Point& b) {
  const int steps = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
  for (int i = 1; i < steps; ++i) {
    const cv::Point p(a.x + static_cast<int>(std::lround(static_cast<double>(b.x - a.x) * i / steps)),
                      a.y + static_cast<int>(std::lround(static_cast<double>(b.y - a.y) * i / steps)));
    if (!is_open(structure, p)) return false;
  }
  return steps > 1;
}

/// The two pixels of a contact farthest apart.
std::pair<cv::Point, cv::Point> ends_of(const std::vector<cv::Point>& pixels) {
  const auto farthest = [&](const cv::Point& from) {
    return *std::max_element(pixels.begin(), pixels.end(), [&](const cv::Point& one, const cv::Point& two) {
      return (one - from).dot(one - from) < (two - from).dot(two - from);
    });
  };
  const cv::Point a = farthest(pixels.front());
  return {a, farthest(a)};
}

/// Cuts with free sight near a contact, cheapest first.
std::vector<StraightCut> cuts_near(const cv::Mat& structure, const Contact& contact) {
  const auto [end_a, end_b] = ends_of(contact.pixels);
  const double width = cv::norm(end_b - end_a);
  const int reach = static_cast<int>(std::ceil(std::max(3.0, kSlideReach * width)));
  const std::vector<cv::Point> walls_a = wall_pixels_near(structure, end_a, reach);
  const std::vector<cv::Point> walls_b = wall_pixels_near(structure, end_b, reach);
  std::vector<StraightCut> cuts;
  const cv::Point along = end_b - end_a;
  for (const cv::Point& a : walls_a) {
    const double slide_a = cv::norm(a - end_a);
    if (2 * slide_a > cv::norm(a - end_b) + slide_a) continue;
    for (const cv::Point& b : walls_b) {
      if ((b - a).dot(along) < kLeastSpan * width * width) continue;
      const double cost = cv::norm(b - a) + kSlideCost * (slide_a + cv::norm(b - end_b));
      if (cost < width + 4) cuts.push_back({a, b, cost});
    }
  }
  const auto cheaper = [](const StraightCut& one, const StraightCut& two) { return one.cost < two.cost; };
  if (cuts.size() > kMaxTried)
    std::nth_element(cuts.begin(), cuts.begin() + kMaxTried, cuts.end(), cheaper), cuts.resize(kMaxTried);
  std::stable_sort(cuts.begin(), cuts.end(), cheaper);
  std::vector<StraightCut> distinct;  // neighbouring cuts part or fail alike
  const double apart = std::max(2.0, 0.1 * width);
  for (const StraightCut& cut : cuts) {
    const bool is_new = std::none_of(distinct.begin(), distinct.end(), [&](const StraightCut& other) {
      return cv::norm(cut.a - other.a) + cv::norm(cut.b - other.b) < apart;
    });
    if (is_new && sees(structure, cut.a, cut.b)) distinct.push_back(cut);
    if (distinct.size() >= kMaxAttempts) break;
  }
  return distinct;
}

/// What a cut does to the two regions of a contact within a window of the labels.
struct Parting {
  cv::Rect window;
  cv::Mat pieces;                   ///< CV_32SC1: pieces of both regions left by the cut, 0 = neither or the cut itself
  std::vector<unsigned char> to_b;  ///< of each piece: the region that has more of it gets it all
  int lost_a = 0, lost_b = 0;
  bool is_parted = false;   ///< both regions keep something
  bool is_cut_off = false;  ///< what changes hands goes on outside of the window
};

Parting part_within(const cv::Rect& window, const Contact& contact, const StraightCut& cut, const cv::Mat& labels) {
  Parting parting;
  parting.window = window;
  const cv::Mat local = labels(window);
  cv::Mat both = (local == contact.label_a) | (local == contact.label_b);
  cv::line(both, cut.a - window.tl(), cut.b - window.tl(), cv::Scalar(0), 1, cv::LINE_8);
  const int count = cv::connectedComponents(both, parting.pieces, 4, CV_32S);
  std::vector<int> of_a(static_cast<size_t>(count), 0), of_b(static_cast<size_t>(count), 0);
  for (int y = 0; y < local.rows; ++y)
    for (int x = 0; x < local.cols; ++x)
      if (const auto piece = static_cast<size_t>(parting.pieces.at<int>(y, x)); piece != 0)
        ++(local.at<int>(y, x) == contact.label_a ? of_a : of_b)[piece];
  parting.to_b.assign(static_cast<size_t>(count), 0);
  int kept_a = 0, kept_b = 0;
  for (size_t piece = 1; piece < of_a.size(); ++piece) {
    const bool to_b = of_a[piece] < of_b[piece];
    parting.to_b[piece] = to_b;
    (to_b ? parting.lost_a : parting.lost_b) += std::min(of_a[piece], of_b[piece]);
    (to_b ? kept_b : kept_a) += std::max(of_a[piece], of_b[piece]);
  }
  parting.is_parted = kept_a > 0 && kept_b > 0;
  const auto changes_hands = [&](int x, int y) {
    const auto piece = static_cast<size_t>(parting.pieces.at<int>(y, x));
    return piece != 0 && (local.at<int>(y, x) == contact.label_b) != (parting.to_b[piece] != 0);
  };
  for (int y = 0; y < local.rows; ++y)
    parting.is_cut_off |=
        (window.x > 0 && changes_hands(0, y)) || (window.br().x < labels.cols && changes_hands(local.cols - 1, y));
  for (int x = 0; x < local.cols; ++x)
    parting.is_cut_off |=
        (window.y > 0 && changes_hands(x, 0)) || (window.br().y < labels.rows && changes_hands(x, local.rows - 1));
  return parting;
}

/// Gives what lies between a contact and its cut to the side of the cut on which it lies. Only a window around both is
/// looked at, a larger one where the window would end what changes hands. False, and nothing is done, where the cut
/// does not part the two regions.
bool apply_cut(const Contact& contact, const StraightCut& cut, const std::vector<int>& areas, cv::Mat& labels) {
  std::vector<cv::Point> corners = contact.pixels;
  corners.insert(corners.end(), {cut.a, cut.b});
  const cv::Rect core = cv::boundingRect(corners), whole(0, 0, labels.cols, labels.rows);
  Parting parting;
  for (int margin = std::max(core.width, core.height) + 2;; margin *= 2) {
    const cv::Point reach(margin, margin);
    parting = part_within(cv::Rect(core.tl() - reach, core.br() + reach) & whole, contact, cut, labels);
    if (!parting.is_cut_off) break;
  }
  const auto area = [&](int label) { return areas[static_cast<size_t>(label)]; };
  if (!parting.is_parted || 2 * parting.lost_a > area(contact.label_a) || 2 * parting.lost_b > area(contact.label_b))
    return false;
  cv::Mat local = labels(parting.window), straight(local.size(), CV_32SC1, cv::Scalar(0));
  for (int y = 0; y < local.rows; ++y)
    for (int x = 0; x < local.cols; ++x)
      if (const auto piece = static_cast<size_t>(parting.pieces.at<int>(y, x)); piece != 0)
        straight.at<int>(y, x) = parting.to_b[piece] ? contact.label_b : contact.label_a;
  grow_labels((local == contact.label_a) | (local == contact.label_b), straight);
  straight.copyTo(local, straight != 0);
  return true;
}

}  // namespace

cv::Mat straighten_borders(const cv::Mat& labels, const cv::Mat& structure) {
  cv::Mat straight = labels.clone();
  double last = 0;
  cv::minMaxLoc(labels, nullptr, &last);
  std::vector<int> areas(static_cast<size_t>(last) + 1, 0);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) ++areas[static_cast<size_t>(labels.at<int>(y, x))];
  for (const Contact& contact : find_contacts(labels)) {
    for (const StraightCut& cut : cuts_near(structure, contact))
      if (apply_cut(contact, cut, areas, straight)) break;
  }
  return straight;
}

}  // namespace smokemap
