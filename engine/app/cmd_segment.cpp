#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/map_picture.hpp"
#include "segmentation/maoris.hpp"
#include "segmentation/outline.hpp"
#include "segmentation/segment.hpp"
#include "topology/voronoi_graph.hpp"

namespace smokemap::app {
namespace {

struct SegmentArguments {
  std::string picture, output, regions, preview, topology;
  MapKind kind = MapKind::kRobot;
  bool maoris = false;
};

nlohmann::json pair_of(const Point2& p) { return {p.x(), p.y()}; }

nlohmann::json regions_document(const Segmentation& segmentation) {
  nlohmann::json regions = nlohmann::json::array(), borders = nlohmann::json::array();
  for (const Region& region : segmentation.regions) {
    nlohmann::json outline = nlohmann::json::array();
    for (const Point2& p : region_outline(segmentation, region.label)) outline.push_back(pair_of(p));
    regions.push_back({{"label", region.label},
                       {"kind", region.kind == RegionKind::kCorridor ? "corridor" : "room"},
                       {"area", region.area_px},
                       {"centroid", pair_of(region.centroid_px)},
                       {"anchor", pair_of(region.anchor_px)},
                       {"clearance", region.clearance_px},
                       {"confidence", region.confidence},
                       {"outline", std::move(outline)}});
  }
  for (const RegionBorder& border : segmentation.borders)
    borders.push_back(
        {{"a", border.label_a},
         {"b", border.label_b},
         {"line", {border.line_px.a.x(), border.line_px.a.y(), border.line_px.b.x(), border.line_px.b.y()}},
         {"width", border.width_px},
         {"door", border.is_door},
         {"confidence", border.confidence}});
  return {{"size", {segmentation.labels.cols, segmentation.labels.rows}}, {"regions", regions}, {"borders", borders}};
}

/// Edges with their ways simplified to half a pixel; nodes by index.
nlohmann::json topology_document(const VoronoiGraph& graph) {
  static const std::map<VoronoiNodeKind, const char*> kKindWords = {{VoronoiNodeKind::kDeadEnd, "dead end"},
                                                                    {VoronoiNodeKind::kJunction, "junction"},
                                                                    {VoronoiNodeKind::kIsolated, "isolated"},
                                                                    {VoronoiNodeKind::kLoop, "loop"}};
  nlohmann::json nodes = nlohmann::json::array(), edges = nlohmann::json::array();
  for (const VoronoiNode& node : graph.nodes)
    nodes.push_back({{"at", pair_of(node.p_px)},
                     {"clearance", node.clearance_px},
                     {"kind", kKindWords.at(node.kind)},
                     {"edges", node.edges}});
  for (const VoronoiEdge& edge : graph.edges) {
    std::vector<cv::Point> way, simple;
    for (const Point2& p : edge.path_px) way.emplace_back(cvRound(p.x()), cvRound(p.y()));
    cv::approxPolyDP(way, simple, 0.5, false);
    nlohmann::json path = nlohmann::json::array();
    for (const cv::Point& p : simple) path.push_back({p.x, p.y});
    edges.push_back({{"from", edge.from},
                     {"to", edge.to},
                     {"length", edge.length_px},
                     {"min_clearance", edge.min_clearance_px},
                     {"mean_clearance", edge.mean_clearance_px},
                     {"path", std::move(path)}});
  }
  return {{"nodes", nodes}, {"edges", edges}};
}

Result<Ok> segment_picture(const SegmentArguments& arguments) {
  const Result<cv::Mat> picture = read_map_picture(arguments.picture);
  if (!picture) return picture.error();
  const Result<cv::Mat> free_space = free_space_of_picture(*picture);
  if (!free_space) return free_space.error();
  const Result<Segmentation> segmentation =
      arguments.maoris ? segment_maoris(*free_space, maoris_params(arguments.kind)) : segment(*free_space);
  if (!segmentation) return segmentation.error();
  nlohmann::json document = regions_document(*segmentation);
  if (!arguments.topology.empty()) {
    const Result<VoronoiGraph> graph = voronoi_graph(*free_space);
    if (!graph) return graph.error();
    const Result<Ok> drawn = write_picture(arguments.topology, draw_voronoi_graph(*graph, *free_space));
    if (!drawn) return drawn;
    document["topology"] = topology_document(*graph);
  }
  if (!arguments.regions.empty()) {
    const Result<Ok> written = write_text(arguments.regions, document.dump());
    if (!written) return written;
  }
  if (!arguments.preview.empty()) {
    const Result<Ok> drawn = write_picture(arguments.preview, draw_segmentation(*segmentation, *picture));
    if (!drawn) return drawn;
  }
  return write_picture(arguments.output, segmentation->labels);
}

}  // namespace

void add_segment(CLI::App& app, Outcome& outcome) {
  auto arguments = std::make_shared<SegmentArguments>();
  auto* command = app.add_subcommand("segment", "Split the free space of a map into rooms and corridors");
  command->add_option("map", arguments->picture, "picture of a map; free space is brighter than gray 250")->required();
  command->add_option("-o,--output", arguments->output, "label image, 16 bit, 0 = no region")->required();
  command->add_option("--json", arguments->regions,
                      "regions and the borders between them, with --topology also its graph, as JSON");
  command->add_option("--preview", arguments->preview, "PNG with one colour a region");
  command->add_option("--topology", arguments->topology,
                      "PNG with the trimmed Voronoi graph; the graph itself goes into --json");
  command->add_option("--kind", arguments->kind, "what kind of map it is; only MAORIS needs to know")
      ->transform(CLI::CheckedTransformer(std::map<std::string, MapKind>{
          {"sketch", MapKind::kSketch}, {"robot", MapKind::kRobot}, {"layout", MapKind::kLayout}}));
  command->add_option("--method", arguments->maoris, "cuts (our own) or maoris (as published)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, bool>{{"cuts", false}, {"maoris", true}}));
  command->callback([arguments, &outcome] {
    const Result<Ok> done = segment_picture(*arguments);
    if (!done) outcome.no_answer(done.error());
  });
}

}  // namespace smokemap::app
