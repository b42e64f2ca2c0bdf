#include "acg/new_walls.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/angle.hpp"

namespace smokemap {
namespace {

constexpr double kStep_m = 0.10;
constexpr double kExplained_m = 0.25;  ///< from a wall's face
constexpr double kMinFragment_m = 0.25;
constexpr double kSameLine_m = 0.10;
constexpr double kSameTurn_rad = 0.12;
constexpr double kHole_m = 0.35;
constexpr double kHalfThickness_m = 0.06;  ///< of a wall that was seen from one side only
constexpr double kTied_m = 0.40;           ///< from a new wall's end to another wall
constexpr double kFurniture_m = 1.00;      ///< depth in front of a wall at which furniture stands
constexpr double kSurelyWall_m = 3.0;
constexpr double kSide_m =
    0.30;  ///< depth from which a thing behind the end of a face is furniture, not a wall's thickness

/// Part of a piece that nothing explains, map frame, free space on the left.
struct Fragment {
  Segment2 segment;
  std::size_t node = 0;
  bool used = false;
};

struct KnownWall {
  Segment2 segment;
  double half = 0;
};

std::vector<KnownWall> known_walls(const PlanModel* plan, const GraphState& state, const std::vector<bool>& there) {
  std::vector<KnownWall> known;
  if (plan == nullptr) return known;
  for (std::size_t w = 0; w < plan->walls.size(); ++w)
    if (there[w]) known.push_back({state.segment(plan->walls[w]), plan->walls[w].half_thickness_m});
  for (const PlanEdge& g : plan->gaps) known.push_back({state.segment(g), g.half_thickness_m});
  return known;
}

bool explained(const Point2& p, const std::vector<KnownWall>& known) {
  return std::any_of(known.begin(), known.end(),
                     [&](const KnownWall& k) { return distance(k.segment, p) < k.half + kExplained_m; });
}

void add_fragments(const Segment2& piece, std::size_t node, const std::vector<KnownWall>& all,
                   std::vector<Fragment>& out) {
  std::vector<KnownWall> known;
  const Point2 middle = piece.midpoint();
  for (const KnownWall& k : all)
    if (distance(k.segment, middle) < 0.5 * piece.length() + k.half + kExplained_m) known.push_back(k);
  const int steps = std::max(1, static_cast<int>(piece.length() / kStep_m));
  const auto at = [&](int i) -> Point2 { return piece.a + (static_cast<double>(i) / steps) * (piece.b - piece.a); };
  int from = 0;
  for (int i = 0; i <= steps + 1; ++i) {
    if (i <= steps && !explained(at(i), known)) continue;
    if ((i - 1 - from) * kStep_m >= kMinFragment_m) out.push_back({{at(from), at(i - 1)}, node, false});
    from = i + 1;
  }
}

/// Line through the ends of the fragments, weighted by length, in the direction of `like`.
Segment2 fit_line(const std::vector<const Fragment*>& parts, const Segment2& like) {
  Point2 mean = Point2::Zero();
  double weight = 0;
  for (const Fragment* f : parts) {
    mean += f->segment.length() * f->segment.midpoint();
    weight += f->segment.length();
  }
  mean /= weight;
  double xx = 0, xy = 0, yy = 0;
  for (const Fragment* f : parts)
    for (const Point2& p : {f->segment.a, f->segment.b}) {
      const Point2 d = p - mean;
      const double w = f->segment.length();
      xx += w * d.x() * d.x(), xy += w * d.x() * d.y(), yy += w * d.y() * d.y();
    }
  const double heading = 0.5 * std::atan2(2 * xy, xx - yy);
  Point2 u(std::cos(heading), std::sin(heading));
  if (u.dot(like.direction()) < 0) u = -u;
  return {mean, mean + u};
}

struct FoundLine {
  Segment2 segment;
  double evidence_m = 0;
};

/// Grows the line of the seed over all fragments on it, and cuts it where fewer than two nodes agree.
std::optional<FoundLine> grow(Fragment& seed, std::vector<Fragment>& all) {
  Segment2 line = seed.segment;
  std::vector<const Fragment*> parts;
  for (int round = 0; round < 2; ++round) {
    parts.clear();
    for (Fragment& f : all) {
      if (f.used || f.segment.direction().dot(line.direction()) < std::cos(kSameTurn_rad)) continue;
      if (std::abs(signed_line_distance(line, f.segment.a)) > kSameLine_m ||
          std::abs(signed_line_distance(line, f.segment.b)) > kSameLine_m)
        continue;
      parts.push_back(&f);
    }
    if (parts.empty()) break;
    line = fit_line(parts, seed.segment);
  }
  seed.used = true;
  if (parts.size() < 2) return std::nullopt;
  const Point2 u = line.direction();
  double low = 1e9, high = -1e9;
  for (const Fragment* f : parts)
    for (const Point2& p : {f->segment.a, f->segment.b})
      low = std::min(low, u.dot(p - line.a)), high = std::max(high, u.dot(p - line.a));
  const auto bins = static_cast<std::size_t>((high - low) / kStep_m) + 1;
  std::vector<int> nodes(bins, 0);
  std::vector<std::size_t> last(bins, static_cast<std::size_t>(-1));
  const auto bin_of = [&](const Point2& p) {
    return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, (u.dot(p - line.a) - low) / kStep_m)));
  };
  for (const Fragment* f : parts)
    for (std::size_t i = bin_of(f->segment.a); i <= bin_of(f->segment.b); ++i)
      if (last[i] != f->node) ++nodes[i], last[i] = f->node;
  // The run of bins that holds the middle of the seed.
  const auto middle = static_cast<int>(bin_of(seed.segment.midpoint()));
  const int count = static_cast<int>(bins), hole = static_cast<int>(kHole_m / kStep_m);
  const auto reach = [&](int step) {
    int end = middle, empty = 0;
    for (int i = middle; i >= 0 && i < count && empty <= hole; i += step) {
      if (nodes[static_cast<std::size_t>(i)] >= 2)
        end = i, empty = 0;
      else
        ++empty;
    }
    return end;
  };
  const int from = reach(-1), to = reach(1);
  FoundLine found;
  found.segment = {line.a + (low + from * kStep_m) * u, line.a + (low + (to + 1) * kStep_m) * u};
  for (int i = from; i <= to; ++i) found.evidence_m += nodes[static_cast<std::size_t>(i)] >= 2 ? kStep_m : 0;
  for (Fragment& f : all) {
    if (f.used || f.segment.direction().dot(u) < std::cos(kSameTurn_rad)) continue;
    if (std::abs(signed_line_distance(line, f.segment.midpoint())) > kSameLine_m) continue;
    const double t = along(found.segment, f.segment.midpoint());
    if (t > -0.05 && t < 1.05) f.used = true;
  }
  return found;
}

/// Two faces of one wall become its centre line; a lone face is moved half a thickness away from where it was seen.
std::vector<FoundLine> center_lines(const std::vector<FoundLine>& faces) {
  std::vector<FoundLine> out;
  std::vector<bool> used(faces.size(), false);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (used[i]) continue;
    FoundLine wall = faces[i];
    const Point2 n = wall.segment.normal(), u = wall.segment.direction();
    double shift = kHalfThickness_m;
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      if (used[j] || faces[j].segment.direction().dot(u) > -std::cos(kSameTurn_rad)) continue;
      const double behind = -n.dot(faces[j].segment.midpoint() - wall.segment.a);
      const double s_0 = u.dot(faces[j].segment.b - wall.segment.a), s_1 = u.dot(faces[j].segment.a - wall.segment.a);
      if (behind < 0.02 || behind > 0.40 || s_1 < 0.2 || s_0 > wall.segment.length() - 0.2) continue;
      used[j] = true;
      shift = behind / 2;
      const double from = std::min(0.0, s_0), to = std::max(wall.segment.length(), s_1);
      wall.segment = {wall.segment.a + from * u, wall.segment.a + to * u};
      wall.evidence_m = std::min(wall.segment.length(), wall.evidence_m + faces[j].evidence_m);
    }
    wall.segment.a -= shift * n;
    wall.segment.b -= shift * n;
    out.push_back(wall);
  }
  return out;
}

/// A box shows its side behind the end of its front: something square to the face begins there and leads away from
/// where the face was seen.
bool turns_away(const Segment2& face, const Point2& end, const std::vector<Fragment>& fragments) {
  const Point2 u = face.direction(), n = face.normal();
  return std::any_of(fragments.begin(), fragments.end(), [&](const Fragment& f) {
    if (std::abs(f.segment.direction().dot(u)) > std::sin(0.3)) return false;
    const double behind_a = -n.dot(f.segment.a - end), behind_b = -n.dot(f.segment.b - end);
    return std::abs(u.dot(f.segment.midpoint() - end)) < 0.2 && std::min(behind_a, behind_b) > -0.15 &&
           std::min(behind_a, behind_b) < 0.3 && std::max(behind_a, behind_b) > kSide_m;
  });
}

/// Walls hang together: how a candidate's ends meet others, and whether it is only the front of something before a
/// wall.
bool built_like_a_wall(const FoundLine& line, const std::vector<FoundLine>& others, const std::vector<KnownWall>& known,
                       const std::vector<Fragment>& fragments) {
  const Segment2& s = line.segment;
  int tied = 0;
  for (const Point2& end : {s.a, s.b}) {
    if (turns_away(s, end, fragments)) return false;
    bool meets = std::any_of(known.begin(), known.end(),
                             [&](const KnownWall& k) { return distance(k.segment, end) < k.half + kTied_m; });
    for (const FoundLine& o : others)
      meets = meets || (&o != &line && o.segment.length() > 1.0 && distance(o.segment, end) < kTied_m);
    tied += meets;
  }
  bool before_a_wall = false;
  for (const KnownWall& k : known) {
    if (line_angle_between(k.segment.heading(), s.heading()) > kSameTurn_rad) continue;
    const double t = along(k.segment, s.midpoint());
    if (t > 0 && t < 1 && std::abs(signed_line_distance(k.segment, s.midpoint())) < kFurniture_m) before_a_wall = true;
  }
  if (before_a_wall) return tied == 2 && s.length() > 2.0;
  return tied == 2 || (tied == 1 && s.length() > 1.5) || s.length() > kSurelyWall_m;
}

}  // namespace

std::vector<NewWall> find_new_walls(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                    const PlanModel* plan, const GraphState& state, const std::vector<bool>& there,
                                    const AcgParams& params) {
  const std::vector<KnownWall> known = known_walls(plan, state, there);
  std::vector<Fragment> fragments;
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    const Pose2 pose = state.pose(node);
    for (const ScanPiece& p : views[node].pieces)
      add_fragments({pose * p.segment.a, pose * p.segment.b}, node, known, fragments);
  }
  std::stable_sort(fragments.begin(), fragments.end(),
                   [](const Fragment& a, const Fragment& b) { return a.segment.length() > b.segment.length(); });
  std::vector<FoundLine> faces;
  for (Fragment& seed : fragments) {
    if (seed.used) continue;
    const auto line = grow(seed, fragments);
    if (line && line->segment.length() >= params.new_wall_min_m) faces.push_back(*line);
  }
  const std::vector<FoundLine> lines = center_lines(faces);
  std::vector<NewWall> out;
  for (const FoundLine& line : lines) {
    if (line.segment.length() < params.new_wall_min_m || !built_like_a_wall(line, lines, known, fragments)) continue;
    out.push_back(
        {line.segment, line.evidence_m, std::clamp(line.evidence_m / (line.segment.length() + 0.5), 0.1, 0.95)});
  }
  return out;
}

}  // namespace smokemap
