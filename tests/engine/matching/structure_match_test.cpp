#include "matching/structure_match.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/random.hpp"
#include "matching/structure_terms.hpp"

namespace smokemap {
namespace {

/// A tree of rooms at random places; ways on foot along its edges.
RegionGraph random_graph(int n, std::mt19937_64& random) {
  RegionGraph graph;
  graph.beside.resize(static_cast<size_t>(n));
  graph.hops = Eigen::MatrixXi::Constant(n, n, n);
  graph.walk = Eigen::MatrixXd::Constant(n, n, 1e9);
  graph.area = Eigen::VectorXd::Constant(n, 1.0 / n);
  graph.importance = graph.area;
  graph.side_px = 200;
  for (int i = 0; i < n; ++i) {
    graph.middles_px.emplace_back(uniform(random, 0, 300), uniform(random, 0, 200));
    graph.hops(i, i) = 0, graph.walk(i, i) = 0;
    if (i == 0) continue;
    const int k = static_cast<int>(uniform_index(random, static_cast<std::uint64_t>(i)));
    graph.beside[static_cast<size_t>(i)].push_back(k), graph.beside[static_cast<size_t>(k)].push_back(i);
    graph.hops(i, k) = graph.hops(k, i) = 1;
    graph.walk(i, k) = graph.walk(k, i) =
        (graph.middles_px[static_cast<size_t>(i)] - graph.middles_px[static_cast<size_t>(k)]).norm();
  }
  for (int via = 0; via < n; ++via)
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        graph.hops(i, k) = std::min(graph.hops(i, k), graph.hops(i, via) + graph.hops(via, k));
        graph.walk(i, k) = std::min(graph.walk(i, k), graph.walk(i, via) + graph.walk(via, k));
      }
  return graph;
}

StructureProblem problem_of(const RegionGraph& a, const RegionGraph& b) {
  StructureProblem problem;
  problem.a = &a, problem.b = &b;
  problem.likeness = Eigen::MatrixXd::Constant(a.size(), b.size(), 0.5);
  problem.forced = problem.forbidden = Eigen::MatrixXi::Zero(a.size(), b.size());
  return problem;
}

double best_by_trying_all(const StructureTerms& terms, std::vector<int>& partner, size_t depth) {
  if (depth == partner.size()) return terms.permits(partner) ? terms.energy(partner) : -1e9;
  double best = -1e9;
  for (int j = -1; j < terms.cols(); ++j) {
    partner[depth] = j;
    best = std::max(best, best_by_trying_all(terms, partner, depth + 1));
  }
  partner[depth] = -1;
  return best;
}

TEST(MatchStructure, IsAsGoodAsTryingEveryAssignmentOfSmallGraphs) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 25; ++trial) {
    const RegionGraph a = random_graph(2 + trial % 4, random), b = random_graph(2 + trial % 3, random);
    StructureProblem problem = problem_of(a, b);
    for (int i = 0; i < a.size(); ++i)
      for (int j = 0; j < b.size(); ++j) problem.likeness(i, j) = uniform(random, 0.05, 0.9);
    problem.many_to_one = trial % 2 == 0;
    if (trial % 5 == 0) problem.forced(0, 1) = 1;
    if (trial % 7 == 0) problem.forbidden(1, 0) = 1;
    const StructureMatch match = match_structure(problem);
    std::vector<int> partner(static_cast<size_t>(a.size()), -1);
    EXPECT_TRUE(match.exact);
    EXPECT_NEAR(match.energy, structure_energy(problem, match.partner), 1e-9);
    EXPECT_NEAR(match.energy, best_by_trying_all(StructureTerms(problem), partner, 0), 1e-9) << "trial " << trial;
  }
}

TEST(MatchStructure, IsAsGoodAsTryingEveryAssignmentOfEightRegions) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 3; ++trial) {
    const RegionGraph a = random_graph(8, random), b = random_graph(8, random);
    StructureProblem problem = problem_of(a, b);
    problem.likeness.setZero();  // three possible partners each, or trying all takes for ever
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 3; ++k)
        problem.likeness(i, static_cast<int>(uniform_index(random, 8))) = uniform(random, 0.1, 0.8);
    problem.many_to_one = trial != 1;
    const StructureMatch match = match_structure(problem);
    const StructureTerms terms(problem);
    std::vector<int> partner(8, -1);
    double best = -1e9;
    const auto try_all = [&](auto&& self, int depth) -> void {
      if (depth == 8) {
        if (terms.permits(partner)) best = std::max(best, terms.energy(partner));
        return;
      }
      for (int j = -1; j < 8; ++j)
        if (j < 0 || problem.likeness(depth, j) > 0) {
          partner[static_cast<size_t>(depth)] = j;
          self(self, depth + 1);
        }
      partner[static_cast<size_t>(depth)] = -1;
    };
    try_all(try_all, 0);
    EXPECT_TRUE(match.exact);
    EXPECT_NEAR(match.energy, best, 1e-9) << "trial " << trial;
  }
}

TEST(MatchStructure, FindsAnEightRoomGraphInItselfByStructureAlone) {
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    std::mt19937_64 random(seed);
    const RegionGraph graph = random_graph(8, random);
    const StructureMatch match = match_structure(problem_of(graph, graph));
    for (int i = 0; i < 8; ++i) {
      EXPECT_EQ(match.partner[static_cast<size_t>(i)], i);
      EXPECT_NEAR(match.support(i), 1, 1e-9);
    }
  }
}

TEST(MatchStructure, FindsATurnedAndScaledGraphWhenTheTurnIsKnown) {
  std::mt19937_64 random(3);
  const RegionGraph graph = random_graph(20, random);
  RegionGraph turned = graph;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(std::numbers::pi / 2).toRotationMatrix();
  for (Point2& p : turned.middles_px) p = 2.5 * (turn * p);
  turned.walk *= 2.5, turned.side_px *= 2.5;
  StructureProblem problem = problem_of(graph, turned);
  problem.turn_b_a = turn, problem.scale_b_a = 2.5;
  problem.likeness.diagonal().array() += 0.2;
  const StructureMatch match = match_structure(problem);
  for (int i = 0; i < graph.size(); ++i) EXPECT_EQ(match.partner[static_cast<size_t>(i)], i);
  problem.turn_b_a = -turn;
  EXPECT_LT(match_structure(problem).energy, match.energy);
}

TEST(MatchStructure, ObeysWhatPeopleSay) {
  std::mt19937_64 random(4);
  const RegionGraph graph = random_graph(6, random);
  StructureProblem problem = problem_of(graph, graph);
  problem.forced(2, 4) = 1, problem.forbidden(0, 0) = 1;
  const StructureMatch match = match_structure(problem);
  EXPECT_EQ(match.partner[2], 4);
  EXPECT_NE(match.partner[0], 0);
  problem.many_to_one = false;
  problem.forced(3, 4) = 1;  // both say so: both are bound, even where one to one is asked
  EXPECT_EQ(match_structure(problem).partner[3], 4);
}

TEST(MatchStructure, LeavesOutRegionsThatAreLikeNothing) {
  std::mt19937_64 random(5);
  const RegionGraph graph = random_graph(5, random);
  StructureProblem problem = problem_of(graph, graph);
  problem.likeness.row(3).setZero();
  EXPECT_EQ(match_structure(problem).partner[3], -1);
}

TEST(MatchStructure, GivesShareBetweenZeroAndOneToEveryAlternative) {
  std::mt19937_64 random(6);
  const RegionGraph a = random_graph(12, random), b = random_graph(15, random);
  const StructureMatch match = match_structure(problem_of(a, b));
  EXPECT_GE(match.certainty.minCoeff(), 0);
  EXPECT_LE(match.certainty.rowwise().sum().maxCoeff(), 1 + 1e-9);
  EXPECT_LE(match.certainty.colwise().sum().maxCoeff(), 1 + 1e-9);
}

}  // namespace
}  // namespace smokemap
