#include "acg/graph_impl.hpp"

namespace smokemap {
namespace {

constexpr double kSigmaPair_m = 0.1;

}  // namespace

std::vector<PointPair> AutoCompleteGraph::Impl::anchor_pairs() const {
  std::vector<PointPair> pairs;
  const PixelFrame frame{layout.height_px, plan->metres_per_pixel};
  for (const auto& [id, a] : anchors) pairs.push_back({a.p_map, frame.to_metres(a.p_px), kSigmaPair_m});
  return pairs;
}

std::vector<bool> AutoCompleteGraph::Impl::outlying_anchors(const Learnt& l) const {
  std::optional<PointPair> witness;
  if (start && !l.state.poses.empty())
    witness = PointPair{l.state.pose(0).translation(), start->T_layout_robot.translation(), start->sigma_m};
  return outlying_pairs(anchor_pairs(), witness);
}

std::vector<AnchorLink> AutoCompleteGraph::Impl::anchor_links(const Learnt& l) const {
  std::vector<AnchorLink> links;
  for (const PointPair& pair : trusted_pairs(anchor_pairs(), outlying_anchors(l)))
    if (const auto link = anchor_link(*plan, pair.p_b, pair.p_a)) links.push_back(*link);
  return links;
}

std::vector<MergedAnchor> AutoCompleteGraph::Impl::read_anchors(const Learnt& l) const {
  std::vector<MergedAnchor> out;
  const std::vector<PointPair> pairs = anchor_pairs();
  const std::vector<bool> outlying = outlying_anchors(l);
  std::size_t i = 0;
  for (const auto& [id, anchor] : anchors) {
    const auto link = anchor_link(*plan, pairs[i].p_b, pairs[i].p_a);
    out.push_back({id, link ? residual_m(*link, l.state) : 0, outlying[i]});
    ++i;
  }
  return out;
}

}  // namespace smokemap
