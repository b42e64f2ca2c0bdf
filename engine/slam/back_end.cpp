#include "slam/back_end.hpp"

#include <algorithm>

namespace smokemap {
namespace {

constexpr double kRelocateEvery_m = 1.5;
constexpr double kUnknownStep_m = 10.0, kUnknownStep_rad = 3.0;  ///< sigma of the step into a piece that was carried

std::size_t at_node(int i) { return static_cast<std::size_t>(i); }

}  // namespace

BackEnd::BackEnd(const SlamParams& params)
    : params_(params), closer_(params), probation_(params.loops), pairs_matcher_(params) {}

bool BackEnd::add(NewNode node, const Progress& progress) {
  const bool new_piece = node.new_piece && !graph_.nodes.empty();
  append(std::move(node));
  const int id = static_cast<int>(graph_.nodes.size()) - 1;
  if (new_piece) {
    piece_begin_ = id;
    relocation_way_m_ = scans_.way_m(id);
  }
  if (piece_begin_ >= 0 && relocate(id)) return solve(progress) || true;
  if (!search_due(id)) return false;
  LoopCloser::Found found = closer_.close(graph_, scans_, id, std::max(0, piece_begin_));
  tried_ += found.tried;
  refused_ += found.rejected;
  if (found.edges.empty()) return false;
  const std::vector<PoseEdge> believed = probation_.admit(graph_, scans_, found.edges);
  if (believed.empty()) return false;
  for (const PoseEdge& edge : believed)
    if (edge.from < piece_begin_) piece_begin_ = -1;
  loops_.insert(loops_.end(), believed.begin(), believed.end());
  compose_edges();
  // At once, so that the next search starts from the corrected poses; but along a way driven again one loop after
  // another says the same, and on long runs solving for each would be most of the work.
  const bool news = std::any_of(believed.begin(), believed.end(), [this](const PoseEdge& edge) {
    return edge_error_sigmas(edge, graph_.nodes[at_node(edge.from)].T_map_robot,
                             graph_.nodes[at_node(edge.to)].T_map_robot) > params_.graph.agrees_within;
  });
  return news && solve(progress);
}

void BackEnd::append(NewNode added) {
  const int id = static_cast<int>(graph_.nodes.size());
  added.node.id = id;
  double way = 0;
  if (id > 0) {
    const PoseNode& last = graph_.nodes.back();
    added.node.T_map_robot = last.T_map_robot * added.edge.T_from_to;
    way = scans_.way_m(id - 1) + added.edge.T_from_to.translation().norm();
    steps_.push_back(added.edge);
    steps_.back().from = id - 1;
    steps_.back().to = id;
    graph_.edges.insert(graph_.edges.begin() + static_cast<std::ptrdiff_t>(steps_.size() - 1), steps_.back());
  }
  graph_.nodes.push_back(std::move(added.node));
  scans_.add(added.surface, way, added.by_radar);
}

bool BackEnd::search_due(int node) {
  const double way = scans_.way_m(node);
  if (way - searched_way_m_ < params_.loops.search_every_m) return false;
  searched_way_m_ = way;
  return true;
}

/// A robot that was carried, or came out of a place without any structure, is looked for in the whole map.
bool BackEnd::relocate(int node) {
  const double way = scans_.way_m(node);
  if (node - piece_begin_ + 1 < params_.loops.joint_nodes || way - relocation_way_m_ < kRelocateEvery_m) return false;
  relocation_way_m_ = way;
  ++tried_;
  const auto found = closer_.find_anywhere(graph_, scans_, node, piece_begin_);
  if (!found) return false;
  tie_piece(*found);
  ++relocated_;
  return true;
}

/// Moves the whole piece to where it was found; the step into it is given up when it says otherwise.
void BackEnd::tie_piece(const PoseEdge& found) {
  const Pose2 T_new_old = graph_.nodes[at_node(found.from)].T_map_robot * found.T_from_to *
                          graph_.nodes[at_node(found.to)].T_map_robot.inverse();
  for (int i = piece_begin_; i < static_cast<int>(graph_.nodes.size()); ++i)
    graph_.nodes[at_node(i)].T_map_robot = T_new_old * graph_.nodes[at_node(i)].T_map_robot;
  PoseEdge& step = steps_[at_node(piece_begin_ - 1)];
  if (edge_error_sigmas(step, graph_.nodes[at_node(step.from)].T_map_robot,
                        graph_.nodes[at_node(step.to)].T_map_robot) > params_.loops.within_sigmas) {
    step.sqrt_information = Eigen::Vector3d(1 / kUnknownStep_m, 1 / kUnknownStep_m, 1 / kUnknownStep_rad).asDiagonal();
    step.state = LinkState::kRejected;
  }
  loops_.push_back(found);
  piece_begin_ = -1;
  compose_edges();
}

void BackEnd::polish(const Progress& progress) {
  for (int round = 0; round < params_.graph.polish_rounds && !progress.cancelled(); ++round) {
    progress.tell(static_cast<double>(round) / params_.graph.polish_rounds, "polishing");
    pairs_ = pairs_matcher_.match(graph_, scans_, 1, progress);
    compose_edges();
    if (!solve(progress)) return;
  }
}

bool BackEnd::solve(const Progress& progress) {
  const auto summary = solve_pose_graph(graph_, params_.graph, progress);
  if (!summary) return false;
  outvoted_ = summary->rejected;
  const auto loops_begin = graph_.edges.begin() + static_cast<std::ptrdiff_t>(steps_.size());
  std::copy(loops_begin, loops_begin + static_cast<std::ptrdiff_t>(loops_.size()), loops_.begin());
  return true;
}

void BackEnd::compose_edges() {
  graph_.edges = steps_;
  graph_.edges.insert(graph_.edges.end(), loops_.begin(), loops_.end());
  graph_.edges.insert(graph_.edges.end(), pairs_.begin(), pairs_.end());
}

GraphUpdate BackEnd::update(bool moved) const {
  GraphUpdate update;
  for (const PoseNode& node : graph_.nodes) update.T_map_nodes.push_back(node.T_map_robot);
  update.steps = steps_;
  update.links.assign(graph_.edges.begin() + static_cast<std::ptrdiff_t>(steps_.size()), graph_.edges.end());
  update.tried = tried_;
  update.closed = static_cast<int>(loops_.size()) - outvoted_;
  update.rejected = refused_ + outvoted_ + probation_.waiting();
  update.relocated = relocated_;
  update.moved = moved;
  return update;
}

}  // namespace smokemap
