#include "slam/back_end.hpp"

#include <algorithm>

namespace smokemap {

BackEnd::BackEnd(const SlamParams& params) : params_(params), closer_(params), pairs_matcher_(params) {}

int BackEnd::add_node(PoseNode node, std::vector<SurfacePoint> surface, const PoseEdge& edge) {
  const int id = static_cast<int>(graph_.nodes.size());
  node.id = id;
  double way = 0;
  if (id > 0) {
    const PoseNode& last = graph_.nodes.back();
    node.T_map_robot = last.T_map_robot * edge.T_from_to;
    way = scans_.way_m.back() + edge.T_from_to.translation().norm();
    steps_.push_back(edge);
    steps_.back().from = id - 1;
    steps_.back().to = id;
    graph_.edges.insert(graph_.edges.begin() + static_cast<std::ptrdiff_t>(steps_.size() - 1), steps_.back());
  }
  graph_.nodes.push_back(std::move(node));
  scans_.surface.push_back(std::move(surface));
  scans_.way_m.push_back(way);
  return id;
}

bool BackEnd::optimize(const Progress& progress) {
  const int count = static_cast<int>(graph_.nodes.size());
  bool moved = false;
  for (; searched_ < count && !progress.cancelled(); ++searched_) {
    const double way = scans_.way_m[static_cast<std::size_t>(searched_)];
    if (way - searched_way_m_ < params_.loops.search_every_m) continue;
    searched_way_m_ = way;
    LoopCloser::Found found = closer_.close(graph_, scans_, searched_);
    tried_ += found.tried;
    refused_ += found.rejected;
    if (found.edges.empty()) continue;
    loops_.insert(loops_.end(), found.edges.begin(), found.edges.end());
    compose_edges();
    moved = solve(progress) || moved;  // at once: the next search starts from the corrected poses
  }
  return moved;
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

}  // namespace smokemap
