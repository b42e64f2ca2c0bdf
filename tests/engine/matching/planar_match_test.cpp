#include "matching/planar_match.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/random.hpp"

namespace smokemap {
namespace {

/// Levenshtein distance by its definition.
int distance_by_definition(const Eigen::MatrixXi& alike, Eigen::Index x, Eigen::Index y) {
  if (x == 0 || y == 0) return static_cast<int>(x + y);
  return std::min({distance_by_definition(alike, x - 1, y - 1) + (alike(x - 1, y - 1) ? 0 : 1),
                   distance_by_definition(alike, x - 1, y) + 1, distance_by_definition(alike, x, y - 1) + 1});
}

/// A wheel: a hub and its spokes, one of which has a tail, so that it can be told which is which.
PlanarGraph wheel(int spokes, int first) {
  PlanarGraph graph;
  graph.around.resize(static_cast<size_t>(spokes) + 2);
  for (int k = 0; k < spokes; ++k) {
    graph.around[0].push_back(1 + (k + first) % spokes);
    graph.around[static_cast<size_t>(k) + 1].push_back(0);
  }
  graph.around[1].push_back(spokes + 1);
  graph.around.back().push_back(1);
  return graph;
}

Eigen::MatrixXi alike_by_degree(const PlanarGraph& a, const PlanarGraph& b) {
  Eigen::MatrixXi alike(a.size(), b.size());
  for (int v = 0; v < a.size(); ++v)
    for (int w = 0; w < b.size(); ++w)
      alike(v, w) = a.around[static_cast<size_t>(v)].size() == b.around[static_cast<size_t>(w)].size();
  return alike;
}

TEST(EditScript, CostsWhatTheDefinitionSaysAndPairsRiseOnBothSides) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::MatrixXi alike(static_cast<Eigen::Index>(uniform_index(random, 6)),
                          static_cast<Eigen::Index>(uniform_index(random, 6)));
    for (Eigen::Index x = 0; x < alike.rows(); ++x)
      for (Eigen::Index y = 0; y < alike.cols(); ++y) alike(x, y) = uniform01(random) < 0.4;
    const auto [cost, pairs] = edit_script(alike);
    EXPECT_EQ(cost, distance_by_definition(alike, alike.rows(), alike.cols()));
    int substituted = 0;
    for (size_t k = 0; k < pairs.size(); ++k) {
      substituted += !alike(pairs[k].first, pairs[k].second);
      if (k > 0) {
        EXPECT_LT(pairs[k - 1].first, pairs[k].first);
        EXPECT_LT(pairs[k - 1].second, pairs[k].second);
      }
    }
    const int against = static_cast<int>(pairs.size());
    EXPECT_EQ(cost, substituted + static_cast<int>(alike.rows()) - against + static_cast<int>(alike.cols()) - against);
  }
}

TEST(MatchPlanar, FindsAGraphInItselfHoweverItsRingsAreTurned) {
  for (int first = 0; first < 5; ++first) {
    const PlanarGraph a = wheel(5, 0), b = wheel(5, first);
    const PlanarMatch match = match_planar(a, b, alike_by_degree(a, b));
    EXPECT_EQ(match.edit_distance, 0);
    ASSERT_EQ(match.pairs.size(), 7u);
    EXPECT_EQ(match.pairs[0], std::pair(0, 0));  // the hub
    EXPECT_EQ(match.pairs[1], std::pair(1, 1));  // the spoke with the tail
  }
}

TEST(MatchPlanar, LeavesOutWhatTheOtherGraphDoesNotHave) {
  const PlanarGraph a = wheel(4, 0), b = wheel(6, 0);
  Eigen::MatrixXi alike = alike_by_degree(a, b);
  alike(0, 0) = 1;  // hubs
  const PlanarMatch match = match_planar(a, b, alike);
  EXPECT_EQ(match.pairs.size(), 6u);
  EXPECT_EQ(match.edit_distance, 4);  // two spokes: two vertices and their two edges
}

TEST(MatchPlanar, SaysNothingWithoutLikeVertices) {
  const PlanarGraph a = wheel(3, 0);
  const PlanarMatch match = match_planar(a, a, Eigen::MatrixXi::Zero(a.size(), a.size()));
  EXPECT_TRUE(match.pairs.empty());
  EXPECT_EQ(match.edit_distance, 2 * (a.size() + a.edges()));
  EXPECT_TRUE(match_planar({}, a, Eigen::MatrixXi(0, a.size())).pairs.empty());
}

}  // namespace
}  // namespace smokemap
