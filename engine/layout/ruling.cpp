// Idea: nobody builds walls from one edge of the paper to the other at even distances. Strokes of nearly one direction
// are gathered into lines, by where they cross the middle of the picture; lines that reach over most of it, follow each
// other evenly and do not end at walls across, as those of a building's rooms do, are the paper's.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/angle.hpp"
#include "layout/drafting.hpp"
#include "layout/median.hpp"

namespace smokemap {
namespace {

constexpr std::size_t kFewestLines = 6;
constexpr double kOneDirection = 0.1;  ///< rad: seen askew, lines of a sheet are not quite parallel
constexpr double kReaches = 0.7;       ///< of the picture's extent along them
constexpr double kEndAtWalls = 0.5;    ///< of the ends of lines: then they are walls
constexpr double kInkedLine = 0.3;     ///< of its extent, at least
constexpr double kEven = 0.15;         ///< of a distance: how much it may differ from the one before
constexpr double kHeavier = 1.5;       ///< times as thick or dark: somebody drew that

struct RulingLine {
  Segment2 axis;  ///< of the longest piece
  double at = 0;  ///< across the middle of the picture
  double low = 0, high = 0, inked = 0;
  std::vector<std::size_t> members;
};

class Ruling {
 public:
  Ruling(const std::vector<InkStroke>& strokes, cv::Size picture, double heading)
      : strokes_(strokes),
        u_(std::cos(heading), std::sin(heading)),
        n_(-u_.y(), u_.x()),
        middle_(0.5 * picture.width, 0.5 * picture.height),
        reach_(kReaches * (std::abs(u_.x()) * picture.width + std::abs(u_.y()) * picture.height)) {
    gather(heading, std::max(3.0, 0.0015 * std::max(picture.width, picture.height)));
  }

  /// Members of lines that are the paper's.
  std::vector<std::size_t> members() const {
    std::vector<const RulingLine*> lines;
    for (const auto& line : lines_)
      if (line.high - line.low > reach_ && line.inked > kInkedLine * (line.high - line.low)) lines.push_back(&line);
    std::sort(lines.begin(), lines.end(), [](const auto* a, const auto* b) { return a->at < b->at; });
    std::vector<std::size_t> found, run;
    std::size_t count = 0, met = 0;
    const auto close = [&] {
      if (count >= kFewestLines && static_cast<double>(met) < kEndAtWalls * 2 * static_cast<double>(count))
        found.insert(found.end(), run.begin(), run.end());
    };
    double step = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const double next = i > 0 ? lines[i]->at - lines[i - 1]->at : 0;
      // A line may be hidden by a header or a wall.
      const double times = step > 0 ? std::max(1.0, std::round(next / step)) : 1;
      const bool even = step > 0 && times <= 3 && std::abs(next / times - step) < kEven * step;
      if (even) {
        step = next / times, count += 1;
      } else {
        close();
        run.clear(), count = 1, met = 0, step = 0;
        if (i > 0) step = next, count = 2, met = ends_met(*lines[i - 1]), run = lines[i - 1]->members;
      }
      met += ends_met(*lines[i]);
      run.insert(run.end(), lines[i]->members.begin(), lines[i]->members.end());
    }
    close();
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  /// How many of both ends lie at a stroke across.
  std::size_t ends_met(const RulingLine& line) const {
    const auto is_met = [&](const Point2& end) {
      return std::any_of(strokes_.begin(), strokes_.end(), [&](const InkStroke& s) {
        return line_angle_between(s.axis.heading(), line.axis.heading()) > 0.5 &&
               distance(s.axis, end) < s.thickness_px + 4;
      });
    };
    return static_cast<std::size_t>(is_met(line.axis.a)) + static_cast<std::size_t>(is_met(line.axis.b));
  }

  double crossing(const Segment2& axis) const {
    const Point2 d = axis.direction();
    const double along = (middle_ - axis.a).dot(u_) / d.dot(u_);
    return (axis.a + along * d - middle_).dot(n_);
  }

  void gather(double heading, double tolerance_px) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < strokes_.size(); ++i)
      if (line_angle_between(strokes_[i].axis.heading(), heading) < kOneDirection) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return strokes_[a].length() > strokes_[b].length(); });
    for (const std::size_t i : order) {
      const auto& axis = strokes_[i].axis;
      RulingLine* home = nullptr;
      for (auto& line : lines_)
        if (std::abs(signed_line_distance(line.axis, axis.a)) < tolerance_px &&
            std::abs(signed_line_distance(line.axis, axis.b)) < tolerance_px)
          home = &line;
      double low = (axis.a - middle_).dot(u_), high = (axis.b - middle_).dot(u_);
      if (low > high) std::swap(low, high);
      if (!home) {
        lines_.push_back({axis, crossing(axis), low, high, 0, {}});
        home = &lines_.back();
      }
      home->low = std::min(home->low, low), home->high = std::max(home->high, high);
      home->inked += high - low;
      home->members.push_back(i);
      // A longer base tells better how the line runs on.
      if (home->high - home->low > 1.2 * home->axis.length()) extend(*home, axis);
    }
  }

  void extend(RulingLine& line, const Segment2& piece) {
    std::vector<Point2> ends{line.axis.a, line.axis.b, piece.a, piece.b};
    std::sort(ends.begin(), ends.end(), [&](const Point2& p, const Point2& q) { return p.dot(u_) < q.dot(u_); });
    line.axis = {ends.front(), ends.back()};
    line.at = crossing(line.axis);
  }

  const std::vector<InkStroke>& strokes_;
  Point2 u_, n_, middle_;
  double reach_;
  std::vector<RulingLine> lines_;
};

double median_field(const std::vector<InkStroke>& strokes, const std::vector<std::size_t>& members,
                    double InkStroke::*field) {
  std::vector<double> values;
  for (const std::size_t m : members) values.push_back(strokes[m].*field);
  return median_of(std::move(values));
}

/// Headings of the longest strokes, each direction once.
std::vector<double> long_headings(const std::vector<InkStroke>& strokes, double least_px) {
  std::vector<const InkStroke*> order;
  for (const auto& s : strokes)
    if (s.length() > least_px) order.push_back(&s);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->length() > b->length(); });
  std::vector<double> headings;
  for (const auto* s : order)
    if (std::none_of(headings.begin(), headings.end(),
                     [&](double h) { return line_angle_between(h, s->axis.heading()) < kOneDirection; }))
      headings.push_back(s->axis.heading());
  return headings;
}

}  // namespace

std::vector<InkStroke> without_ruling(const std::vector<InkStroke>& strokes, cv::Size picture) {
  std::vector<bool> ruled(strokes.size(), false);
  for (const double heading : long_headings(strokes, 0.1 * std::max(picture.width, picture.height))) {
    const auto members = Ruling(strokes, picture, heading).members();
    if (members.empty()) continue;
    const double thickness = median_field(strokes, members, &InkStroke::thickness_px);
    const double darkness = median_field(strokes, members, &InkStroke::darkness);
    for (const std::size_t m : members)
      ruled[m] = strokes[m].thickness_px < kHeavier * thickness && strokes[m].darkness < kHeavier * darkness;
  }
  std::vector<InkStroke> kept;
  for (std::size_t i = 0; i < strokes.size(); ++i)
    if (!ruled[i]) kept.push_back(strokes[i]);
  return kept;
}

}  // namespace smokemap
