#include "acg/line_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace smokemap {
namespace {

std::size_t place_of(double offset_m) {
  return static_cast<std::size_t>(LineChain::kReach_cells + std::lround(offset_m / LineChain::kCell_m));
}

/// Lines drawn `widths` apart that are thought to be as drawn; nothing speaks yet.
LineChain chain_of(const std::vector<double>& widths) {
  LineChain chain;
  double at = 0;
  chain.drawn_m.push_back(at);
  for (const double width : widths) chain.drawn_m.push_back(at += width);
  chain.now_m = chain.drawn_m;
  chain.support.resize(chain.now_m.size());
  for (auto& support : chain.support) support.fill(0);
  return chain;
}

void speak(LineChain& chain, std::size_t line, double offset_m, float log_odds) {
  for (const double near : {-0.05, 0.0, 0.05}) chain.support[line][place_of(offset_m + near)] += log_odds;
}

TEST(ArrangeLines, NoLinesNoBeliefs) { EXPECT_TRUE(arrange_lines({}).empty()); }

TEST(ArrangeLines, KeepsLinesWithWhichTheFacesAgree) {
  LineChain chain = chain_of({3, 3, 3});
  for (std::size_t k = 0; k < 4; ++k) speak(chain, k, 0, 6);
  for (const LineBelief& belief : arrange_lines(chain)) EXPECT_LT(belief.elsewhere, 0.01);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(arrange_lines(chain)[k].together.move_m, 0, 0.051);
}

TEST(ArrangeLines, FreesAStripThatWasCaughtOneWallTooFar) {
  // Rooms of 3 m; the last two lines were taken for the walls before them, which are 3 m off.
  LineChain chain = chain_of({3, 3, 3, 3});
  chain.now_m[3] -= 3, chain.now_m[4] -= 3;
  for (const std::size_t k : {0u, 1u, 2u}) speak(chain, k, 0, 5);
  // Either place of the third line has a wall; the outer wall stands only where it is.
  speak(chain, 3, 0, 5), speak(chain, 3, 3, 5), speak(chain, 4, 3, 5);
  const auto beliefs = arrange_lines(chain);
  EXPECT_NEAR(beliefs[3].together.move_m, 3, 0.11);
  EXPECT_NEAR(beliefs[4].together.move_m, 3, 0.11);
  EXPECT_GT(beliefs[4].elsewhere, 0.95) << "where it was thought to be it surely is not";
  EXPECT_NEAR(beliefs[4].apart_m, 3, 0.15);
  EXPECT_LT(beliefs[1].elsewhere, 0.05) << "the rest is not touched";
}

TEST(ArrangeLines, SaysThatTwoPlacesAreAsGood) {
  LineChain chain = chain_of({3, 3});
  speak(chain, 0, 0, 8), speak(chain, 1, 0, 8);
  speak(chain, 2, -0.5, 6), speak(chain, 2, 0.5, 6);
  chain.now_m[2] += 0.5;  // it was taken to one of them
  for (auto& support : chain.support) {
    if (&support != &chain.support[2]) continue;
    support.fill(0);
    for (const double at : {-1.0, 0.0}) support[place_of(at)] += 6;
  }
  const auto beliefs = arrange_lines(chain);
  EXPECT_GT(beliefs[2].elsewhere, 0.25);
  EXPECT_LT(beliefs[2].elsewhere, 0.75);
}

TEST(ArrangeLines, IsTheLessSureTheFartherFromWhatWasSeen) {
  LineChain chain = chain_of({2, 2, 2, 2, 2});
  speak(chain, 0, 0, 10), speak(chain, 1, 0, 10);
  const auto beliefs = arrange_lines(chain);
  for (std::size_t k = 2; k + 1 < beliefs.size(); ++k) {
    const double here = beliefs[k].elsewhere * beliefs[k].apart_m,
                 next = beliefs[k + 1].elsewhere * beliefs[k + 1].apart_m;
    EXPECT_LT(here, next) << k;
  }
}

TEST(ArrangeLines, StretchesNeighbouringStripsAlike) {
  // The strip between two seen lines is a quarter wider than drawn: the next one, of which nothing is known, is wider
  // too, by less.
  LineChain chain = chain_of({2, 2, 6});
  speak(chain, 0, 0, 20), speak(chain, 1, 0.5, 20);
  const auto beliefs = arrange_lines(chain);
  EXPECT_GT(beliefs[2].together.move_m, 0.56);
  EXPECT_LT(beliefs[2].together.move_m, 0.94);
}

TEST(ArrangeLines, IsTheBestOfAllArrangementsByBruteForce) {
  // Three lines: the best score by hand over all pairs of places agrees with what the search gives.
  auto random = random_stream(4, 4);
  for (int round = 0; round < 5; ++round) {
    LineChain chain = chain_of({uniform(random, 1, 3), uniform(random, 1, 3)});
    for (int k = 0; k < 12; ++k)
      speak(chain, uniform_index(random, 3), uniform(random, -1.5, 1.5), static_cast<float>(uniform(random, 1, 6)));
    const auto beliefs = arrange_lines(chain);
    double best = -1e9, found = -1e9;
    const auto stretch_cost = [&](double drawn, double width, double rho, double before, double& stretch) {
      stretch = std::round((width / drawn - 1) / 0.05) * 0.05;
      if (stretch < -0.301 || stretch > 0.501) return -1e9;
      const double sigma = std::max(0.025, 0.1 * std::sqrt(1 - rho * rho));
      const double z = (std::log1p(stretch) - rho * std::log1p(before)) / sigma,
                   error = (width - drawn * (1 + stretch)) / 0.025;
      return -0.5 * (z * z + error * error);
    };
    const double w0 = chain.drawn_m[1], w1 = chain.drawn_m[2] - w0;
    for (int a = -35; a <= 35; ++a)
      for (int b = -35; b <= 35; ++b)
        for (int c = -35; c <= 35; ++c) {
          double e0 = 0, e1 = 0;
          double score = chain.support[0][place_of(0.05 * a)] + chain.support[1][place_of(0.05 * b)] +
                         chain.support[2][place_of(0.05 * c)];
          score += stretch_cost(w0, w0 + 0.05 * (b - a), 0, 0, e0);
          score += stretch_cost(w1, w1 + 0.05 * (c - b), std::exp(-0.5 * (w0 + w1) / chain.correlation_m), e0, e1);
          best = std::max(best, score);
          const auto chosen = [&](std::size_t k, int cell) {
            return std::abs(0.05 * cell - beliefs[k].together.move_m) < 0.01;
          };
          if (chosen(0, a) && chosen(1, b) && chosen(2, c)) found = score;
        }
    EXPECT_NEAR(found, best, 1.0) << "round " << round;  // the grids of stretch differ a little
  }
}

TEST(ArrangeLines, SaysTheSameTwice) {
  LineChain chain = chain_of({1, 2, 3, 1});
  speak(chain, 2, 0.7, 4), speak(chain, 4, -0.4, 3);
  const auto one = arrange_lines(chain), two = arrange_lines(chain);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].together.move_m, two[k].together.move_m);
    EXPECT_EQ(one[k].elsewhere, two[k].elsewhere);
  }
}

}  // namespace
}  // namespace smokemap
