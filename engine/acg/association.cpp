#include "acg/association.hpp"

#include <algorithm>
#include <cmath>

namespace smokemap {
namespace {

constexpr double kBeyondEnd_m = 0.15;  ///< a piece may reach this far past a wall's end
constexpr double kMinOverlap_m = 0.20;
constexpr double kEvidenceBin_m = 0.10;

struct Candidate {
  PieceLink link;
  double from = 0, to = 0;  ///< share of the piece
};

/// A wall as it lies now, prepared for many questions.
struct Target {
  Point2 a, u, n;
  double length = 0, half_thickness = 0, gate = 0;
};

/// The part of the piece beside the wall; nothing if they have nothing to do with each other.
bool candidate(const Segment2& piece_map, const Segment2& piece_robot, const Point2& robot, const Target& wall,
               double gate_angle, Candidate& out) {
  const Point2 &u = wall.u, &n = wall.n;
  const double length = wall.length, half_thickness = wall.half_thickness, gate = wall.gate;
  const double d_a = n.dot(piece_map.a - wall.a), d_b = n.dot(piece_map.b - wall.a);
  if (std::min(std::abs(d_a), std::abs(d_b)) > gate + half_thickness + 0.3) return false;
  double s_a = u.dot(piece_map.a - wall.a), s_b = u.dot(piece_map.b - wall.a);
  if (std::max(s_a, s_b) < -kBeyondEnd_m || std::min(s_a, s_b) > length + kBeyondEnd_m) return false;
  if (std::abs(s_b - s_a) < 1e-6 || std::abs(d_b - d_a) > std::tan(gate_angle) * std::abs(s_b - s_a)) return false;
  const auto share = [&](double s) { return (s - s_a) / (s_b - s_a); };
  const double t_0 = share(-kBeyondEnd_m), t_1 = share(length + kBeyondEnd_m);
  out.from = std::clamp(std::min(t_0, t_1), 0.0, 1.0);
  out.to = std::clamp(std::max(t_0, t_1), 0.0, 1.0);
  const double overlap = (out.to - out.from) * piece_map.length();
  if (overlap < std::min(kMinOverlap_m, 0.6 * length)) return false;
  out.link.part_robot = {piece_robot.a + out.from * (piece_robot.b - piece_robot.a),
                         piece_robot.a + out.to * (piece_robot.b - piece_robot.a)};
  out.link.side = n.dot(robot - wall.a) >= 0 ? 1.0 : -1.0;
  const double r_0 = out.link.side * (d_a + out.from * (d_b - d_a)) - half_thickness;
  const double r_1 = out.link.side * (d_a + out.to * (d_b - d_a)) - half_thickness;
  out.link.misfit_m = std::sqrt(0.5 * (r_0 * r_0 + r_1 * r_1));
  return std::abs(0.5 * (r_0 + r_1)) < gate && out.link.misfit_m < 1.5 * gate;
}

}  // namespace

std::vector<PieceLink> link_pieces(const std::vector<NodeView>& views, const std::vector<bool>& use_node,
                                   const PlanModel& plan, const GraphState& state, const std::vector<double>& gate_m,
                                   const AcgParams& params) {
  std::vector<Target> walls;
  for (std::size_t w = 0; w < plan.walls.size(); ++w) {
    const Segment2 s = state.segment(plan.walls[w]);
    const bool usable = plan.walls[w].usable && s.length() >= 0.05;
    walls.push_back(
        {s.a, s.direction(), s.normal(), s.length(), plan.walls[w].half_thickness_m, usable ? gate_m[w] : 0});
  }
  std::vector<PieceLink> links;
  std::vector<Candidate> found;
  for (std::size_t node = 0; node < views.size(); ++node) {
    if (!use_node[node]) continue;
    const Pose2 pose = state.pose(node);
    for (const ScanPiece& piece : views[node].pieces) {
      const Segment2 in_map{pose * piece.segment.a, pose * piece.segment.b};
      found.clear();
      for (std::size_t w = 0; w < walls.size(); ++w) {
        Candidate c;
        if (walls[w].gate <= 0) continue;
        if (!candidate(in_map, piece.segment, pose.translation(), walls[w], params.gate_angle_rad, c)) continue;
        c.link.node = node;
        c.link.wall = static_cast<int>(w);
        found.push_back(c);
      }
      std::stable_sort(found.begin(), found.end(),
                       [](const Candidate& a, const Candidate& b) { return a.link.misfit_m < b.link.misfit_m; });
      for (std::size_t i = 0; i < found.size(); ++i) {
        double shared = 0;
        for (std::size_t j = 0; j < i; ++j)
          shared += std::max(0.0, std::min(found[i].to, found[j].to) - std::max(found[i].from, found[j].from));
        if (shared < 0.3 * (found[i].to - found[i].from))
          links.push_back(found[i].link);
        else
          found[i].to = found[i].from;
      }
    }
  }
  return links;
}

double misfit_m(const PieceLink& link, const PlanModel& plan, const GraphState& state) {
  const PlanEdge& edge = plan.walls[static_cast<std::size_t>(link.wall)];
  const Segment2 wall = state.segment(edge);
  const Pose2 pose = state.pose(link.node);
  const double r_0 = link.side * signed_line_distance(wall, pose * link.part_robot.a) - edge.half_thickness_m;
  const double r_1 = link.side * signed_line_distance(wall, pose * link.part_robot.b) - edge.half_thickness_m;
  return std::sqrt(0.5 * (r_0 * r_0 + r_1 * r_1));
}

double robust_weight(double misfit_m, double c_m) {
  const double share = c_m * c_m / (c_m * c_m + misfit_m * misfit_m);
  return share * share;
}

std::vector<double> linked_length_m(const std::vector<PieceLink>& links, const PlanModel& plan, const GraphState& state,
                                    double min_weight) {
  struct Bin {
    int nodes = 0;
    std::size_t last = 0;
  };
  std::vector<std::vector<Bin>> bins(plan.walls.size());
  for (const PieceLink& link : links) {
    if (link.weight < min_weight) continue;
    const Segment2 wall = state.segment(plan.walls[static_cast<std::size_t>(link.wall)]);
    auto& row = bins[static_cast<std::size_t>(link.wall)];
    if (row.empty()) row.resize(static_cast<std::size_t>(wall.length() / kEvidenceBin_m) + 1);
    const Pose2 pose = state.pose(link.node);
    const Point2 u = wall.direction();
    const double s_0 = u.dot(pose * link.part_robot.a - wall.a), s_1 = u.dot(pose * link.part_robot.b - wall.a);
    const double last = static_cast<double>(row.size()) - 1;
    const auto from = static_cast<std::size_t>(std::clamp(std::min(s_0, s_1) / kEvidenceBin_m, 0.0, last));
    const auto to = static_cast<std::size_t>(std::clamp(std::max(s_0, s_1) / kEvidenceBin_m, 0.0, last));
    for (std::size_t i = from; i <= to; ++i)
      if (row[i].nodes == 0 || row[i].last != link.node) ++row[i].nodes, row[i].last = link.node;
  }
  std::vector<double> length(plan.walls.size(), 0);
  for (std::size_t w = 0; w < bins.size(); ++w)
    for (const Bin& bin : bins[w]) length[w] += bin.nodes >= 2 ? kEvidenceBin_m : 0.0;
  return length;
}

}  // namespace smokemap
